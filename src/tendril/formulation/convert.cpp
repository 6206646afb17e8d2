#include "tendril/formulation/convert.hpp"

#include <cmath>
#include <complex>

namespace tendril::formulation {

void line_to_free(const Material& m, const Section& s, const double* line, double* f) {
  line_to_free(m, s, LineContact::wall(m, s, line), line, f);
}

void line_to_free(const Material& m, const Section& s, const LineContact::Wall& wall, const double* line, double* f) {
  using C = std::complex<double>;
  const C i(0.0, 1.0);
  const double b = line[0], b1 = line[1], b2 = line[2], b3 = line[3];
  const C e(std::cos(b), std::sin(b));
  // δ1 + i δ2 = Q exp(iβ) and its derivatives, A_n exp(iβ)
  const C a0 = s.Q[0], a1 = s.Q[1] + i * b1 * a0;
  const C a1p = s.Q[2] + i * (b2 * s.Q[0] + b1 * s.Q[1]);
  const C a2 = a1p + i * b1 * a1;
  const C a1pp = s.Q[3] + i * (b3 * s.Q[0] + 2.0 * b2 * s.Q[1] + b1 * s.Q[2]);
  const C a2p = a1pp + i * (b2 * a1 + b1 * a1p);
  const C a3 = a2p + i * b1 * a2;
  const C d[4] = {a0 * e, a1 * e, a2 * e, a3 * e};
  for (int j = 0; j < 4; ++j) {
    f[j] = d[j].real();
    f[4 + j] = d[j].imag();
  }
  const auto l = lift<double>(s, 0.0, 0.0);
  const auto k = FreeRod::kinematics<double>(l, f[0], f[1], f[2], f[4], f[5], f[6]);
  const auto n = touch_basis<double>(k, e.real(), e.imag(), s.Q[1]);
  f[11] = wall.Fn * n.n1 + line[7] * n.n2;  // F = F_n N + F_g (N x d3), N x d3 = n2 k1 - n1 k2
  f[13] = wall.Fn * n.n2 - line[7] * n.n1;
  f[15] = line[9];
  f[16] = line[10];
  const double J1 = FreeRod::stretch(m, f[15]) * k.J1bar;
  f[8] = line[4] - darboux_angle<double>(n, b);
  f[9] = (1.0 + m.nu) * wall.M3 / J1 - k.c;
  f[10] = line[6];
  f[12] = f[14] = 0.0;
}

void free_to_line(const Material& m, const Section& s, const double* f, double near, double* line) {
  const double x = f[0], y = f[4], q2 = x * x + y * y;
  double b = std::atan2(y, x);
  b += 2.0 * M_PI * std::round((near - b) / (2.0 * M_PI));
  const double cb = std::cos(b), sb = std::sin(b);
  line[0] = b;
  line[1] = (x * f[5] - y * f[1]) / q2;
  line[2] = (x * f[6] - y * f[2]) / q2 - 2.0 * (x * f[1] + y * f[5]) / q2 * line[1];
  line[3] = 0.0;
  const auto l = lift<double>(s, 0.0, 0.0);
  const auto k = FreeRod::kinematics<double>(l, f[0], f[1], f[2], f[4], f[5], f[6]);
  const auto n = touch_basis<double>(k, cb, sb, s.Q[1]);
  line[4] = f[8] + darboux_angle<double>(n, b);
  const double M3 = FreeRod::twisting_moment<double>(m, k, f[15], f[9]);
  const auto c = LineContact::curve<double>(l, lift_clearance<double>(s, 0.0, 0.0), b, line[1], line[2]);
  const double alpha = FreeRod::stretch(m, f[15]), J1 = alpha * c.J1bar;
  line[5] = ((1.0 + m.nu) * M3 - alpha * c.tg) / J1;
  line[6] = f[10];
  line[7] = f[11] * n.n2 - f[13] * n.n1;
  line[8] = 0.0;
  line[9] = f[15];
  line[10] = f[16];
}

}  // namespace tendril::formulation
