#include "tendril/formulation/near_wall.hpp"

#include <complex>

namespace tendril::formulation {

namespace {

std::array<double, 4> clearance(const Section& s) { return {s.Q[0], s.Q[1], s.Q[2], s.Q[3]}; }

}  // namespace

void wall_to_free(const Section& s, double* u) {
  double d1[4], d2[4];
  NearWall::eccentricity<4, double>(clearance(s), u + NearWall::angle, u + NearWall::offset, d1, d2);
  for (int j = 0; j < 4; ++j) {
    u[FreeRod::first[0] + j] = d1[j];
    u[FreeRod::first[1] + j] = d2[j];
  }
}

void free_to_wall(const Section& s, double near, double* u) {
  const double rho = std::hypot(u[0], u[4]), c = u[0] / rho, sn = u[4] / rho;
  double along[4], across[4];
  for (int j = 0; j < 4; ++j) {
    along[j] = u[j] * c + u[4 + j] * sn;
    across[j] = u[4 + j] * c - u[j] * sn;
  }
  double b[4], r[4];  // NearWall::parts, solved one derivative after the other
  b[0] = std::atan2(sn, c);
  b[0] += 2.0 * M_PI * std::round((near - b[0]) / (2.0 * M_PI));
  r[0] = rho;
  r[1] = along[1];
  b[1] = across[1] / rho;
  r[2] = along[2] + rho * b[1] * b[1];
  b[2] = (across[2] - 2.0 * r[1] * b[1]) / rho;
  r[3] = along[3] + 3.0 * r[1] * b[1] * b[1] + 3.0 * rho * b[1] * b[2];
  b[3] = (across[3] - 3.0 * r[2] * b[1] - 3.0 * r[1] * b[2] + rho * b[1] * b[1] * b[1]) / rho;
  for (int j = 0; j < 4; ++j) {
    u[NearWall::angle + j] = b[j];
    u[NearWall::offset + j] = r[j] - s.Q[j];
  }
}

void wall_columns(const Section& s, const double* u, int rows, double* jac) {
  using C = std::complex<double>;
  constexpr int columns = FreeRod::inputs + 2;
  const double* b = u + NearWall::angle;
  std::array<double, 4> rho = clearance(s);
  for (int j = 0; j < 4; ++j) rho[j] += u[NearWall::offset + j];
  const auto p = NearWall::parts<4, double>(rho, b);
  const C e(std::cos(b[0]), std::sin(b[0])), i(0.0, 1.0);
  // d(δ1 + i δ2)^(j) / d(β^(q)) and / d(n^(q)), the latter also / d(Q^(q))
  C by_angle[4][4] = {}, by_offset[4][4] = {};
  for (int j = 0; j < 4; ++j) by_angle[j][0] = i * C(p.along[j], p.across[j]) * e;
  by_angle[1][1] = i * rho[0] * e;
  by_angle[2][1] = C(-2.0 * rho[0] * b[1], 2.0 * rho[1]) * e;
  by_angle[2][2] = i * rho[0] * e;
  by_angle[3][1] = C(-6.0 * rho[1] * b[1] - 3.0 * rho[0] * b[2], 3.0 * rho[2] - 3.0 * rho[0] * b[1] * b[1]) * e;
  by_angle[3][2] = C(-3.0 * rho[0] * b[1], 3.0 * rho[1]) * e;
  by_angle[3][3] = i * rho[0] * e;
  for (int j = 0; j < 4; ++j) by_offset[j][j] = e;
  by_offset[1][0] = i * b[1] * e;
  by_offset[2][0] = C(-b[1] * b[1], b[2]) * e;
  by_offset[2][1] = 2.0 * i * b[1] * e;
  by_offset[3][0] = C(-3.0 * b[1] * b[2], b[3] - b[1] * b[1] * b[1]) * e;
  by_offset[3][1] = C(-3.0 * b[1] * b[1], 3.0 * b[2]) * e;
  by_offset[3][2] = 3.0 * i * b[1] * e;
  for (int row = 0; row < rows; ++row) {
    double* a = jac + row * columns;
    double angle[4] = {}, offset[4] = {};
    for (int q = 0; q < 4; ++q)
      for (int j = q; j < 4; ++j) {
        angle[q] += a[j] * by_angle[j][q].real() + a[4 + j] * by_angle[j][q].imag();
        offset[q] += a[j] * by_offset[j][q].real() + a[4 + j] * by_offset[j][q].imag();
      }
    for (int q = 0; q < 4; ++q) {
      a[NearWall::angle + q] = angle[q];
      a[NearWall::offset + q] = offset[q];
      a[FreeRod::inputs] += offset[q] * s.Q[q + 1];
      a[FreeRod::inputs + 1] += offset[q] * s.Q_rate[q];
    }
  }
}

}  // namespace tendril::formulation
