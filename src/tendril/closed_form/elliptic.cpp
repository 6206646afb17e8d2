#include "tendril/closed_form/elliptic.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "tendril/closed_form/domain.hpp"

namespace tendril::closed_form {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

// Carlson's duplication (DLMF 19.36): the truncated series is in error by the sixth power of the spread of the
// arguments, so a spread of 1e-3 leaves 1e-18.
constexpr double duplication_spread = 1e-3;

double carlson_rc(double x, double y) {  // x >= 0, y > 0
  if (x < y) return std::atan2(std::sqrt(y - x), std::sqrt(x)) / std::sqrt(y - x);
  if (x > y) return std::atanh(std::sqrt((x - y) / x)) / std::sqrt(x - y);
  return 1.0 / std::sqrt(x);
}

double carlson_rj(double x, double y, double z, double p) {  // at most one of x, y, z zero; p > 0
  double sum = 0.0, factor = 1.0;
  double mean = 0.2 * (x + y + z + 2.0 * p);
  double spread =
      std::max(std::max(std::abs(mean - x), std::abs(mean - y)), std::max(std::abs(mean - z), std::abs(mean - p)));
  while (spread > duplication_spread * mean) {
    const double rx = std::sqrt(x), ry = std::sqrt(y), rz = std::sqrt(z);
    const double lambda = rx * ry + ry * rz + rz * rx;
    const double alpha = p * (rx + ry + rz) + rx * ry * rz;
    sum += factor * carlson_rc(alpha * alpha, p * (p + lambda) * (p + lambda));
    factor *= 0.25;
    x = 0.25 * (x + lambda);
    y = 0.25 * (y + lambda);
    z = 0.25 * (z + lambda);
    p = 0.25 * (p + lambda);
    mean = 0.25 * (mean + lambda);
    spread *= 0.25;
  }
  const double X = 1.0 - x / mean, Y = 1.0 - y / mean, Z = 1.0 - z / mean, P = -(X + Y + Z) / 2.0;
  const double e2 = X * Y + Y * Z + Z * X - 3.0 * P * P;
  const double e3 = X * Y * Z + 2.0 * e2 * P + 4.0 * P * P * P;
  const double e4 = (2.0 * X * Y * Z + e2 * P + 3.0 * P * P * P) * P;
  const double e5 = X * Y * Z * P * P;
  const double series = 1.0 - 3.0 * e2 / 14.0 + e3 / 6.0 + 9.0 * e2 * e2 / 88.0 - 3.0 * e4 / 22.0 -
                        9.0 * e2 * e3 / 52.0 + 3.0 * e5 / 26.0;  // DLMF 19.36.2
  return 3.0 * sum + factor * series / (mean * std::sqrt(mean));
}

}  // namespace

double complete_k(double m) {
  require(m >= 0.0 && m < 1.0, "parameter m of K", m, "in [0, 1)");
  double a = 1.0, g = std::sqrt(1.0 - m);
  while (std::abs(a - g) > 2.0 * epsilon * a) {
    const double next = 0.5 * (a + g);
    g = std::sqrt(a * g);
    a = next;
  }
  return std::numbers::pi / (a + g);
}

double complete_e(double m) {
  require(m >= 0.0 && m <= 1.0, "parameter m of E", m, "in [0, 1]");
  if (m == 1.0) return 1.0;
  double a = 1.0, g = std::sqrt(1.0 - m), sum = 0.5 * m, power = 0.5;
  while (std::abs(a - g) > 2.0 * epsilon * a) {
    const double next = 0.5 * (a + g), c = 0.5 * (a - g);
    g = std::sqrt(a * g);
    a = next;
    power *= 2.0;
    sum += power * c * c;  // DLMF 19.8.6
  }
  return (1.0 - sum) * std::numbers::pi / (a + g);
}

double complete_pi(double n, double m) {
  require(n < 1.0, "characteristic n of Pi", n, "below 1");
  const double K = complete_k(m);
  if (n >= -0.5) return K + n / 3.0 * carlson_rj(0.0, 1.0 - m, 1.0, 1.0 - n);  // DLMF 19.25.2
  // The two terms cancel for large negative n: change to N = (m - n)/(1 - n) in (m, 1), DLMF 19.7.9.
  const double complement = (1.0 - m) / (1.0 - n), N = (m - n) / (1.0 - n);  // 1 - N, N
  const double pi_N = K + N / 3.0 * carlson_rj(0.0, 1.0 - m, 1.0, complement);
  return (m * K - n * complement * pi_N) / (m - n);
}

Jacobi jacobi(double u, double m) {
  require(m >= 0.0 && m <= 1.0, "parameter m of sn, cn, dn", m, "in [0, 1]");
  require(std::isfinite(u), "argument u of sn, cn, dn", u, "finite");
  if (m == 1.0) {
    const double sech = 1.0 / std::cosh(u);
    return {std::tanh(u), sech, sech};
  }
  // Descending Landen chain (DLMF 22.20.1-4). Sixteen levels are more than any m < 1 in double precision needs.
  std::array<double, 17> a{}, c{};
  a[0] = 1.0;
  c[0] = std::sqrt(m);
  double g = std::sqrt(1.0 - m);
  int levels = 0;
  while (std::abs(c[levels]) > epsilon * a[levels] && levels < 16) {
    a[levels + 1] = 0.5 * (a[levels] + g);
    c[levels + 1] = 0.5 * (a[levels] - g);
    g = std::sqrt(a[levels] * g);
    ++levels;
  }
  double phi = std::ldexp(a[levels] * u, levels);
  for (int i = levels; i > 0; --i) phi = 0.5 * (phi + std::asin(c[i] / a[i] * std::sin(phi)));
  const double sn = std::sin(phi), cn = std::cos(phi);
  return {sn, cn, std::sqrt((1.0 - m) + m * cn * cn)};  // dn² without cancellation near m = 1
}

}  // namespace tendril::closed_form
