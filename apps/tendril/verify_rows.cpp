// The rows of `tendril verify`: what the library computes against a number known without it. A row's tolerance is the
// printed digits plus the accuracy asked of the solver, nothing else. Here: those that need no solver.
#include "verify_rows.hpp"

#include <cmath>
#include <numbers>

#include "tendril/closed_form/columns.hpp"
#include "tendril/closed_form/helical_conduit.hpp"
#include "tendril/closed_form/helix.hpp"
#include "tendril/closed_form/sphere.hpp"
#include "verify.hpp"

namespace tendril::app {
namespace {

namespace cf = closed_form;
constexpr double pi = std::numbers::pi;

/// Half a unit of the last printed decimal, and a hair for the rounding of the printed number's own source.
double printed(int decimals) { return 0.6 * std::pow(10.0, -decimals); }

void helix_rows(std::vector<VerifyRow>& rows) {
  const std::string group = "free helix, angle pi/5";
  struct Print {
    double squared_ratio, delta_M, delta2_T, m;
  };
  const Print prints[] = {{0.0, 1.06331351, 0.34549150, 1.80901699},
                          {0.25, 1.14319682, 0.37144716, 1.87573933},
                          {1.0, 1.47581686, 0.47952197, 2.13121967}};
  for (const Print& p : prints) {
    const cf::Helix helix{0.3, pi / 5};
    const cf::SurfaceState s = cf::free_homoclinic_helix(helix, std::sqrt(p.squared_ratio) * helix.radius);
    const double pull = cf::axial_resultants(helix, s).force;
    const std::string at = ", (eta/delta)^2 = " + std::to_string(p.squared_ratio).substr(0, 4);
    rows.push_back({group + ": delta M" + at, helix.radius * s.M_3, p.delta_M, printed(8)});
    rows.push_back({group + ": delta^2 T" + at, helix.radius * helix.radius * pull, p.delta2_T, printed(8)});
    rows.push_back({group + ": M/sqrt(T)" + at, s.M_3 / std::sqrt(pull), p.m, printed(8)});
  }
  const std::string conduit_group = "axis of the helical conduit";
  const cf::HelicalConduit conduit{pi / 4, 1.0 / (pi * std::sqrt(2.0))};
  rows.push_back({conduit_group + ": T0, M = -1", cf::axis_tension(conduit, -1.0, 0.05), -7.0690329710, printed(10)});
  rows.push_back({conduit_group + ": T0, M = +1", cf::axis_tension(conduit, +1.0, 0.05), -2.6802939305, printed(10)});
}

void sphere_rows(std::vector<VerifyRow>& rows) {
  const std::string group = "sphere, longitude per period";
  const double prints[][3] = {{0.5, 1.7, -0.4676295431},  {-1.3, 0.9, -3.4163806611}, {0.3, 2.5, -1.3529506680},
                              {-3.0, 1.2, -3.2711595151}, {2.0, 1.8, 8.0902861942},   {1.0, 1.2, 9.1275693616},
                              {6.0, 3.0, 0.6548962780},   {4.0, 2.2, 7.0524629525}};
  for (const auto& p : prints) {
    const cf::SphereElastica rod(p[0], p[1]);
    const std::string name = std::string(rod.wavelike() ? "Lambda" : "Delta theta") +
                             ", sigma = " + std::to_string(p[0]).substr(0, 4) +
                             ", kappa_m = " + std::to_string(p[1]).substr(0, 3);
    rows.push_back({group + ": " + name, rod.longitude_per_period(), p[2], printed(10)});
  }
}

void column_rows(std::vector<VerifyRow>& rows) {
  const std::string group = "buckling loads";
  constexpr double rounding = 1e-12;
  rows.push_back({group + ": Euler, clamped, P L^2/B", cf::euler_load_clamped(1, 1, 1), 4 * pi * pi, rounding});
  rows.push_back({group + ": Euler, clamped, second mode", cf::euler_load_clamped(2, 1, 1), 80.762914225, printed(8)});
  rows.push_back(
      {group + ": Greenhill, clamped, M L/B", cf::greenhill_torque_clamped(0, 1, 1), 8.986818916, printed(8)});
  rows.push_back({group + ": Greenhill, hinged, M L/B", cf::greenhill_torque_hinged(0, 1, 1), 2 * pi, rounding});
  const std::string planar = "two walls, small clearance, thrust/Euler";
  constexpr double h = 1e-5, second_order = 1e-8;  // the corrections are a few tens of (h/D)²
  const double euler = 4 * pi * pi;
  rows.push_back({planar + ": first contact", cf::first_contact_at_span(h, 1, 1).thrust / euler, 1, second_order});
  rows.push_back({planar + ": point to line", cf::point_to_line_at_span(h, 1, 1).thrust / euler, 4, 4 * second_order});
  rows.push_back(
      {planar + ": flat part buckles", cf::flat_part_buckles_at_span(h, 1, 1).thrust / euler, 9, 9 * second_order});
}

}  // namespace

void append_closed_form_rows(std::vector<VerifyRow>& rows) {
  helix_rows(rows);
  sphere_rows(rows);
  column_rows(rows);
}

std::vector<VerifyRow> verify_rows() {
  std::vector<VerifyRow> rows;
  append_closed_form_rows(rows);
  append_solver_rows(rows);
  return rows;
}

}  // namespace tendril::app
