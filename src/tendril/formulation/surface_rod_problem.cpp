#include "tendril/formulation/surface_rod_problem.hpp"

#include <algorithm>

namespace tendril::formulation {

namespace {

struct Equations {
  SurfaceRod rod;
  bool scaled = false;
  std::vector<int> order = std::vector<int>(surface_rod_end, 1);
  int quadratures = 0;

  template <class T>
  void operator()(const T&, const T* u, const T& p, T* out) const {
    SurfaceRodState<T> y, dy;
    for (int i = 0; i < surface_rod_states; ++i) y[i] = u[2 * i];
    const T& length = u[2 * ilength];
    T F_n;
    if (!surface_rod_slope(rod, y, dy, F_n, scaled ? p : T(1.0)))
      for (T& slope : dy) slope = T(HUGE_VAL);  // outside the domain: Newton shortens its step
    for (int i = 0; i < surface_rod_states; ++i) out[i] = u[2 * i + 1] - length * dy[i];
    out[ilength] = u[2 * ilength + 1];
  }
};

}  // namespace

collocation::BoundaryValueProblem surface_rod_problem(const SurfaceRod& rod, collocation::Conditions conditions,
                                                      bool load_scaled_by_parameter) {
  Equations equations;
  equations.rod = rod;
  equations.scaled = load_scaled_by_parameter;
  using Bound = collocation::DualSystem<Equations, 2 * surface_rod_end>;
  collocation::BoundaryValueProblem problem({std::make_shared<Bound>(std::move(equations))}, std::move(conditions));
  if (load_scaled_by_parameter) problem.set_parameter(1.0);
  return problem;
}

collocation::Conditions clamped_conditions(const ClampedSurfaceRod& problem) {
  return collocation::make_conditions<2 * surface_rod_end>(surface_rod_end,
                                                           [c = problem](const auto* ends, const auto&, auto* r) {
                                                             const auto* right = ends + surface_rod_end;
                                                             for (int i = 0; i < 3; ++i) {
                                                               r[i] = ends[i] - c.left[i];
                                                               r[3 + i] = right[i] - c.right[i];
                                                             }
                                                             r[6] = right[iM_3] - c.M_3;
                                                             r[7] = 1.0 * ends[ipsi];
                                                             r[8] = ends[ilength] - c.length;
                                                           });
}

void guess_from(collocation::BoundaryValueProblem& problem, const SurfaceRod& rod,
                const std::vector<SurfaceRodState<double>>& states, double length, int pieces) {
  const int parts = static_cast<int>(states.size()) - 1;
  problem.initialise(
      [&](int, double x, double* inputs, double*) {
        const int i = std::clamp(static_cast<int>(x * parts), 0, parts - 1);
        const double t = x * parts - i;
        SurfaceRodState<double> y, dy{};
        for (int c = 0; c < surface_rod_states; ++c) y[c] = (1.0 - t) * states[i][c] + t * states[i + 1][c];
        double F_n;
        surface_rod_slope(rod, y, dy, F_n);
        for (int c = 0; c < surface_rod_states; ++c) {
          inputs[2 * c] = y[c];
          inputs[2 * c + 1] = length * dy[c];
        }
        inputs[2 * ilength] = length;
        inputs[2 * ilength + 1] = 0.0;
      },
      pieces);
}

SurfaceRodState<double> state_at(const collocation::BoundaryValueProblem& problem, double x) {
  double inputs[2 * surface_rod_end];
  problem.evaluate(0, x, inputs, nullptr);
  SurfaceRodState<double> y;
  for (int c = 0; c < surface_rod_states; ++c) y[c] = inputs[2 * c];
  return y;
}

double length_of(const collocation::BoundaryValueProblem& problem) { return problem.end_value(0, false, ilength); }

std::vector<SurfaceRodSection> sections_of(const collocation::BoundaryValueProblem& problem, const SurfaceRod& rod,
                                           int count) {
  const double length = length_of(problem);
  std::vector<SurfaceRodSection> sections;
  for (int i = 0; i <= count; ++i) {
    const double x = static_cast<double>(i) / count;
    sections.push_back(surface_rod_section(rod, x * length, state_at(problem, x)));
  }
  return sections;
}

}  // namespace tendril::formulation
