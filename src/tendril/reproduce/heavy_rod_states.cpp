#include "tendril/reproduce/heavy_rod_states.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "tendril/geometry/axes.hpp"
#include "tendril/geometry/clearances.hpp"

namespace tendril::reproduce::heavy {
namespace {

using collocation::BoundaryValueProblem;
using collocation::Closure;

constexpr int kUnknowns = 10;           // t, M, F, ℓ
constexpr int kStates = kUnknowns + 3;  // and r
constexpr int kInputs = 2 * kUnknowns;  // values and slopes

struct HeavyRod {
  std::vector<int> order = std::vector<int>(kUnknowns, 1);
  int quadratures = 3;
  double weight = 0.0;

  template <class T>
  void operator()(const T&, const T* u, const T&, T* out) const {
    const auto value = [&](int i) -> const T& { return u[2 * i]; };
    const auto slope = [&](int i) -> const T& { return u[2 * i + 1]; };
    const T& l = value(9);
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      out[i] = slope(i) - l * (value(3 + j) * value(k) - value(3 + k) * value(j));          // t' = ℓ M x t
      out[3 + i] = slope(3 + i) + l * (value(j) * value(6 + k) - value(k) * value(6 + j));  // M' = -ℓ t x F
      out[6 + i] = slope(6 + i);                                                            // F' = ℓ w e_z
      out[10 + i] = l * value(i);                                                           // r' = ℓ t
    }
    out[8] = out[8] - l * weight;
    out[9] = slope(9);
  }
};

// Inputs of the Eulerian formulation at one section; D1 = e_z, D2 = -e_y, D3 = e_x.
void eulerian_inputs(const Section& c, const segmentation::ScaledProblem& problem, double S, double s, double* u) {
  using formulation::FreeRod;
  const auto in_frame = [](const Vec& v) { return numerics::V3<double>{v.z(), -v.y(), v.x()}; };
  const Vec t1 = c.M.cross(c.t);                             // dt/ds
  const Vec t2 = c.M.cross(t1) - c.t.cross(c.F).cross(c.t);  // d²t/ds²
  const auto r = in_frame(c.r), g = in_frame(c.t), g1 = in_frame(t1), g2 = in_frame(t2), F = in_frame(c.F);
  const double T = g[2], T1 = g1[2], T2 = g2[2], M3 = c.M.dot(c.t);
  std::fill_n(u, FreeRod::inputs, 0.0);
  for (const std::size_t i : {0u, 1u}) {  // d/dS = (1/T) d/ds
    double* d = u + 4 * i;
    d[0] = r[i];
    d[1] = g[i] / T;
    d[2] = (g1[i] - g[i] * T1 / T) / (T * T);
    d[3] = (g2[i] - (3 * g1[i] * T1 + g[i] * T2) / T + 3 * g[i] * T1 * T1 / (T * T)) / (T * T * T);
  }
  const auto lifted = formulation::lift<double>(problem.section(S), 0.0, 0.0);
  const auto k = FreeRod::kinematics<double>(lifted, u[0], u[1], u[2], u[4], u[5], u[6]);
  const double F1 = numerics::dot(F, k.k1), F2 = numerics::dot(F, k.k2), F3 = numerics::dot(F, k.t);
  u[8] = (1 + problem.material.nu) * M3 * s;  // the twist as if ω3 were 0: it decouples
  u[9] = (1 + problem.material.nu) * M3 / T;
  u[11] = F1;
  u[12] = -k.p * F3 + k.c * F2 - numerics::dot(lifted.sigma, k.k1) / T;  // (II.2.48-50)
  u[13] = F2;
  u[14] = -k.c * F1 - k.h * F3 - numerics::dot(lifted.sigma, k.k2) / T;
  u[15] = F3;
  u[16] = k.h * F2 + k.p * F1 - numerics::dot(lifted.sigma, k.t) / T;
}

}  // namespace

BoundaryValueProblem rod_problem(double weight, Vary vary, double torque) {
  HeavyRod rod;
  rod.weight = weight;
  const auto conditions =
      collocation::make_conditions<2 * kStates>(kStates, [vary, torque](const auto* ends, const auto& p, auto* r) {
        const auto *a = ends, *b = ends + kStates;
        r[0] = a[0] - 1.0;  // clamped along e_x at the origin
        r[1] = a[1];
        r[2] = a[2];
        for (int i = 0; i < 3; ++i) r[3 + i] = a[10 + i];
        r[6] = b[10] - 1.0;  // through a sleeve along e_x at r = e_x
        r[7] = b[11];
        r[8] = b[12];
        r[9] = b[1];
        r[10] = b[2];
        r[11] = b[6];  // F3 = F·e_x there
        r[12] = b[3];  // M3 = M·e_x
        if (vary == Vary::torque) {
          r[12] = r[12] - p;
        } else {
          r[11] = r[11] - p;
          r[12] = r[12] - torque;
        }
      });
  BoundaryValueProblem problem({std::make_shared<collocation::DualSystem<HeavyRod, kInputs>>(rod)}, conditions, 7);
  problem.initialise(
      [&](int, double x, double* u, double* r) {
        std::fill_n(u, kInputs, 0.0);
        u[0] = 1.0;
        u[16] = weight * (x - 0.5);
        u[17] = weight;
        u[18] = 1.0;
        r[0] = x;
        r[1] = r[2] = 0.0;
      },
      8);
  problem.set_parameter_scale(1.0);
  return problem;
}

Section section_at(const BoundaryValueProblem& rod, double x) {
  double u[kInputs], r[3];
  rod.evaluate(0, x, u, r);
  return {{r[0], r[1], r[2]}, {u[0], u[2], u[4]}, {u[6], u[8], u[10]}, {u[12], u[14], u[16]}};
}

double length_of(const BoundaryValueProblem& rod) { return rod.end_value(0, true, 9); }

double least_advance(const BoundaryValueProblem& rod) {
  constexpr int kParts = 400;
  std::array<double, kParts + 1> value{};
  for (int i = 0; i <= kParts; ++i) value[i] = section_at(rod, static_cast<double>(i) / kParts).t.x();
  const auto least = static_cast<int>(std::min_element(value.begin(), value.end()) - value.begin());
  if (least == 0 || least == kParts) return value[least];
  // The minimum between the samples, by golden section: it must vary smoothly from state to state.
  double a = (least - 1.0) / kParts, b = (least + 1.0) / kParts;
  constexpr double golden = 0.6180339887498949;
  for (int i = 0; i < 40; ++i) {
    const double c = b - golden * (b - a), d = a + golden * (b - a);
    if (section_at(rod, c).t.x() < section_at(rod, d).t.x()) {
      b = d;
    } else {
      a = c;
    }
  }
  return section_at(rod, (a + b) / 2).t.x();
}

double largest_deflection(const BoundaryValueProblem& rod) {
  double largest = 0.0;
  for (int i = 0; i <= 400; ++i) {
    const Vec r = section_at(rod, i / 400.0).r;
    largest = std::max(largest, std::hypot(r.y(), r.z()));
  }
  return largest;
}

double stiffness_of_feeding(const BoundaryValueProblem& rod, double weight) {
  BoundaryValueProblem same = rod_problem(weight, Vary::end_force, rod.parameter());
  same.initialise([&](int, double x, double* u, double* r) { rod.evaluate(0, x, u, r); }, rod.pieces());
  same.set_parameter_scale(1.0);
  collocation::BvpOptions options;
  options.tolerance = 1e-8;  // a slope is wanted, to a few digits
  std::vector<double> tangent;
  // The length is held: under its end force the rod is singular at every fold.
  const double length = length_of(rod);
  const auto held = Closure::where(collocation::make_conditions<2 * kStates>(
      1, [length](const auto* ends, const auto&, auto* r) { r[0] = ends[9] - length; }));
  if (!same.solve(held, options).converged || !same.tangent(same.column_of_state(0, 0, 9), tangent))
    throw std::runtime_error("the slope of the end force over the length was not found");
  return tangent[same.column_of_p()];
}

segmentation::Problem eulerian_problem(double weight, double torque) {
  segmentation::Problem p;
  p.tube.axis = geometry::make_straight(1.0, Vec::UnitX(), Vec::Zero(), Vec(Vec::UnitZ()));
  p.tube.clearance = geometry::make_constant(3.0);
  p.rod = {1.0, 0.75, {}};
  p.load.force = Vec(0, 0, -weight);
  p.end.kind = segmentation::End::Kind::sleeve;
  p.end_position = 1.0;
  p.twist_value = segmentation::Scalar(torque, 1.0);
  return p;
}

segmentation::Chain eulerian_state(const BoundaryValueProblem& rod, double weight, double tolerance) {
  const double torque = rod.parameter();
  const auto mechanics = std::make_shared<segmentation::Mechanics>(eulerian_problem(weight, torque), torque);
  segmentation::Chain chain(mechanics, 7);
  chain.set_parameter(torque);
  chain.build({{0}, {}}, 40, [&](double S, double* u, double* s) {
    double a = 0.0, b = 1.0;  // r_x grows along the rod: bisection
    for (int i = 0; i < 60; ++i) (section_at(rod, (a + b) / 2).r.x() < S ? a : b) = (a + b) / 2;
    const Section c = section_at(rod, (a + b) / 2);
    s[0] = length_of(rod) * (a + b) / 2;
    eulerian_inputs(c, mechanics->problem, S, s[0], u);
  });
  const auto solved = chain.solve_adaptive({segmentation::Closure::Kind::parameter, 0, torque}, {}, tolerance);
  if (!solved.converged)
    throw std::runtime_error("the Eulerian state at M3 = " + std::to_string(torque) + ", length " +
                             std::to_string(length_of(rod)) + " was not found: " + solved.reason);
  return chain;
}

}  // namespace tendril::reproduce::heavy
