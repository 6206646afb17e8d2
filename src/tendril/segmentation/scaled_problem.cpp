#include "tendril/segmentation/scaled_problem.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

// Everything inlined into one function, compiled for wider vector units too where the loader can choose.
#if defined(__x86_64__) && defined(__gnu_linux__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__)
#define TENDRIL_FLATTEN_CLONES __attribute__((flatten, target_clones("arch=haswell", "default")))
#else
#define TENDRIL_FLATTEN_CLONES
#endif

namespace tendril::segmentation {
namespace {

using formulation::FreeRod;
using formulation::Lifted;
using formulation::LineContact;
using formulation::Material;
using formulation::Section;
using numerics::Dual;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

Scalar scaled(const Scalar& s, double factor) { return {s.value * factor, s.rate * factor}; }

// The value of component `phi` has no influence; leaving it out saves one derivative everywhere.
constexpr int free_seeds = FreeRod::inputs - 1 + 2, line_seeds = LineContact::inputs - 1 + 2;

template <int N>
void scatter(const Dual<N>* r, int equations, int inputs, int skip, double* out, double* jac) {
  for (int e = 0; e < equations; ++e) {
    out[e] = r[e].v;
    double* row = jac + e * (inputs + 2);
    int q = 0;
    for (int j = 0; j < inputs; ++j) row[j] = j == skip ? 0.0 : r[e].d[q++];
    row[inputs] = r[e].d[q];
    row[inputs + 1] = r[e].d[q + 1];
  }
}

template <int N>
void seed(const double* u, int inputs, int skip, Dual<N>* x) {
  int q = 0;
  for (int j = 0; j < inputs; ++j) x[j] = j == skip ? Dual<N>(u[j]) : Dual<N>::seed(u[j], q++);
}

TENDRIL_FLATTEN_CLONES void free_jacobian(const Material& m, const Section& s, const double* u, double* out,
                                          double* jac) {
  // The shape depends on the eccentricity and the place only: half as many derivatives for most of the arithmetic.
  constexpr int shape_inputs = 8, shape_seeds = shape_inputs + 2;
  using N = Dual<shape_seeds>;
  N v[shape_inputs];
  for (int j = 0; j < shape_inputs; ++j) v[j] = N::seed(u[j], j);
  const auto narrow =
      FreeRod::shape<N>(formulation::lift<N>(s, N::seed(0.0, shape_seeds - 2), N::seed(0.0, shape_seeds - 1)), v);
  using T = Dual<free_seeds>;
  auto widen = [](const N& n) {
    T t(n.v);
    for (int j = 0; j < shape_inputs; ++j) t.d[j] = n.d[j];
    t.d[free_seeds - 2] = n.d[shape_seeds - 2];
    t.d[free_seeds - 1] = n.d[shape_seeds - 1];
    return t;
  };
  const FreeRod::Shape<T> shape{widen(narrow.J),  widen(narrow.Jp), widen(narrow.p),  widen(narrow.h),
                                widen(narrow.pp), widen(narrow.hp), widen(narrow.c),  widen(narrow.cp),
                                widen(narrow.s1), widen(narrow.s2), widen(narrow.s3), widen(narrow.m1),
                                widen(narrow.m2), widen(narrow.m3)};
  T x[FreeRod::inputs], r[FreeRod::components + 1];
  const int skip = FreeRod::first[FreeRod::phi];
  seed(u, FreeRod::inputs, skip, x);
  FreeRod::balance<T>(m, shape, x, r, r + FreeRod::components);
  scatter(r, FreeRod::components + 1, FreeRod::inputs, skip, out, jac);
}

TENDRIL_FLATTEN_CLONES void line_jacobian(const Material& m, const Section& s, const double* u, double* out,
                                          double* jac) {
  using T = Dual<line_seeds>;
  T x[LineContact::inputs], r[LineContact::components + 1];
  const int skip = LineContact::first[LineContact::phi];
  seed(u, LineContact::inputs, skip, x);
  const T dS = T::seed(0.0, line_seeds - 2), dp = T::seed(0.0, line_seeds - 1);
  LineContact::residual<T>(m, formulation::lift<T>(s, dS, dp), formulation::lift_clearance<T>(s, dS, dp), x, r,
                           r + LineContact::components);
  scatter(r, LineContact::components + 1, LineContact::inputs, skip, out, jac);
}

/// The formulation holds while d3·D3 > 0, C3 > 0 and the stretch is positive.
bool valid_free(const Material& m, const Section& s, const double* u) {
  const double c3 = 1.0 - u[0] * s.U[0][1] + u[4] * s.U[0][0];
  return c3 > 0.0 && 1.0 + m.eta2 * u[15] > 0.0;
}

}  // namespace

ScaledProblem::ScaledProblem(const Problem& problem, double parameter) : source(problem), p0(parameter), p(parameter) {
  const Problem& p = source;
  L = p.tube.length();
  B = p.rod.bending_stiffness;
  material.eta2 = p.rod.axial_stiffness ? B / (*p.rod.axial_stiffness * L * L) : 0.0;
  material.nu = B / p.rod.torsional_stiffness - 1.0;
  sign = p.tube.sign();
  auto end_of = [&](const End& e) {
    ScaledEnd s;
    s.kind = e.kind;
    for (int i = 0; i < 2; ++i) {
      s.eccentricity[i] = scaled(e.eccentricity[i], 1.0 / L);
      s.slope[i] = e.slope[i];
    }
    s.roll = e.roll;
    return s;
  };
  start = end_of(p.start);
  end = end_of(p.end);
  end_position = p.end_position.value > 0.0 ? scaled(p.end_position, 1.0 / L) : Scalar{1.0};
  axial = scaled(p.axial_value, p.axial == AxialControl::rod_length ? 1.0 / L : 1.0 / force_unit());
  twist = scaled(p.twist_value, p.twist == TwistControl::torque ? 1.0 / moment_unit() : 1.0);
  for (double k : p.tube.axis->knots()) knots.push_back(k / L);
  for (double k : p.tube.clearance->knots()) knots.push_back(k / L);
  std::sort(knots.begin(), knots.end());
  std::vector<double> kept;
  for (double k : knots)
    if (k > 1e-9 && k < 1.0 - 1e-9 && (kept.empty() || k - kept.back() > 1e-9)) kept.push_back(k);
  knots = kept;
  weightless = p.load.force.isZero() && p.load.couple.isZero();
  bool straight = true;
  for (int i = 0; i <= 200; ++i) {
    const Section s = section(end_position.value * i / 200.0);
    clearance_max = std::max(clearance_max, s.Q[0]);
    for (double u : s.U[0]) straight = straight && std::abs(u) < 1e-13;
    for (int c = 0; c < 2; ++c) straight = straight && std::abs(s.sigma[c]) < 1e-13 && std::abs(s.mu[c]) < 1e-13;
  }
  axisymmetric = straight;
  for (const ScaledEnd* e : {&start, &end})
    for (int i = 0; i < 2; ++i)
      axisymmetric = axisymmetric && e->eccentricity[i].value == 0.0 && e->slope[i].value == 0.0;
}

Section ScaledProblem::section(double S) const {
  Section s;
  s.S = S;
  const auto a = source.tube.axis->at(S * L);
  const auto q = source.tube.clearance->at(S * L);
  double f = L;
  for (int j = 0; j < 4; ++j, f *= L)
    for (int i = 0; i < 3; ++i) s.U[j][i] = a.U[j][i] * f;
  f = 1.0 / L;
  for (int j = 0; j < 5; ++j, f *= L) {
    s.Q[j] = now(source.clearance_scale) * q[j] * f;
    s.Q_rate[j] = source.clearance_scale.rate * q[j] * f;
  }
  const double force = L * L * L / B, couple = L * L / B;
  const Eigen::Vector3d sf = a.frame.transpose() * source.load.force * force;
  const Eigen::Vector3d mf = a.frame.transpose() * source.load.couple * couple;
  for (int i = 0; i < 3; ++i) {
    s.R[i] = a.position[i] / L;
    for (int d = 0; d < 3; ++d) s.D[d][i] = a.frame(i, d);
    s.sigma[i] = now(source.body_force_scale) * sf[i];
    s.sigma_rate[i] = source.body_force_scale.rate * sf[i];
    s.mu[i] = now(source.body_couple_scale) * mf[i];
    s.mu_rate[i] = source.body_couple_scale.rate * mf[i];
  }
  return s;
}

FreeSystem::FreeSystem(const ScaledProblem* problem) : problem_(problem) {
  order.assign(FreeRod::order.begin(), FreeRod::order.end());
  first.assign(FreeRod::first.begin(), FreeRod::first.end());
  quadratures = FreeRod::quadratures;
  inputs = FreeRod::inputs;
}

void FreeSystem::residual(double S, const double* u, double* out) const {
  const Section s = problem_->section(S);
  if (!valid_free(problem_->material, s, u)) {
    std::fill(out, out + FreeRod::components + 1, nan);
    return;
  }
  FreeRod::residual<double>(problem_->material, formulation::lift<double>(s, 0.0, 0.0), u, out,
                            out + FreeRod::components);
}

void FreeSystem::jacobian(double S, const double* u, double* out, double* jac) const {
  const Section s = problem_->section(S);
  free_jacobian(problem_->material, s, u, out, jac);
  if (!valid_free(problem_->material, s, u)) std::fill(out, out + FreeRod::components + 1, nan);
}

LineSystem::LineSystem(const ScaledProblem* problem) : problem_(problem) {
  order.assign(LineContact::order.begin(), LineContact::order.end());
  first.assign(LineContact::first.begin(), LineContact::first.end());
  quadratures = LineContact::quadratures;
  inputs = LineContact::inputs;
}

void LineSystem::residual(double S, const double* u, double* out) const {
  const Section s = problem_->section(S);
  if (!(1.0 + problem_->material.eta2 * u[9] > 0.0)) {
    std::fill(out, out + LineContact::components + 1, nan);
    return;
  }
  LineContact::residual<double>(problem_->material, formulation::lift<double>(s, 0.0, 0.0),
                                formulation::lift_clearance<double>(s, 0.0, 0.0), u, out,
                                out + LineContact::components);
}

void LineSystem::jacobian(double S, const double* u, double* out, double* jac) const {
  const Section s = problem_->section(S);
  line_jacobian(problem_->material, s, u, out, jac);
  if (!(1.0 + problem_->material.eta2 * u[9] > 0.0)) std::fill(out, out + LineContact::components + 1, nan);
}

}  // namespace tendril::segmentation
