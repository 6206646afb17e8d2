// Methods named in the thesis (IV.1) and its future work (V.3), each beside the default on the same states: nested
// procedures with sensitivities and with Broyden's update, residual line search, meshes by k and N, adaptive knots, and
// the solution as B-splines. L = B = 1.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <stdexcept>

#include "tendril/collocation/b_splines.hpp"
#include "tendril/continuation/study.hpp"
#include "tendril/reproduce/helical_conduit_detail.hpp"
#include "tendril/reproduce/methods_detail.hpp"
#include "tendril/reproduce/systems.hpp"
#include "tendril/segmentation/nested.hpp"
#include "tendril/segmentation/pattern_checks.hpp"

namespace tendril::reproduce {
namespace {

using namespace methods;
using conduit::Conduit;
using drawing::Curve;
using drawing::Panel;
using segmentation::Chain;
using segmentation::Mechanics;

constexpr double kTight = 1e-11;      // meshes of the solutions that are compared
constexpr double kAgreement = 1e-10;  // of two methods on such meshes

double rod_length(const Chain& c) {
  const auto& s = c.segment(c.segments() - 1);
  return s.state(s.pieces())[s.states() - 1];
}

/// A state of the helical conduit from nothing, at T = load |T0|.
Chain conduit_state(const Conduit& conduit, double clearance, double load) {
  const double T = load * conduit.unit;
  continuation::StudyOptions options;
  options.solve.tolerance = 1e-9;
  const continuation::Result r = continuation::solve(conduit.problem(clearance, T), options);
  Chain chain;
  if (r.status != continuation::Status::converged ||
      !chain.restore(r.steps.at(0).state, std::make_shared<Mechanics>(conduit.problem(clearance, T), T)))
    throw std::runtime_error("the state of the helical conduit was not found: " + r.message);
  return chain;
}

// ---- nested procedures, Broyden's update, line search ----

struct Count {
  std::string method;
  int newton = 0, factorisations = 0, propagations = 0, jacobians = 0;
};

void compare_solvers(Outcome& out, const Conduit& conduit, Data& table, const std::string& name, double clearance,
                     double before, double load) {
  const double target = load * conduit.unit;
  const Chain start = conduit_state(conduit, clearance, before);
  Chain whole = start, searched = start;
  const auto note = [&](double method, const Count& c) {
    const double row[] = {
        clearance,          before, load, method, double(c.newton), double(c.factorisations), double(c.propagations),
        double(c.jacobians)};
    for (std::size_t i = 0; i < table.value.size(); ++i) table.value[i].push_back(row[i]);
  };
  const auto s = whole.solve_adaptive(at(target), tight_newton(), kTight);
  if (!s.converged) throw std::runtime_error("the chain was not solved: " + s.reason);
  note(0, {"", s.iterations, s.factorisations, 0, 0});
  const auto same = [&](const std::string& what, const Chain& c) {
    out.rows.push_back({name + ", " + what + ": ℓ/L", rod_length(c), rod_length(whole), kAgreement * rod_length(whole),
                        "Newton over the chain"});
    double computed = 0, expected = 0;
    for (int k = 0; k + 1 < c.segments(); ++k) {
      computed += segmentation::reaction(c, k);
      expected += segmentation::reaction(whole, k);
    }
    // A reaction is a difference of forces that come from third derivatives.
    out.rows.push_back({name + ", " + what + ": concentrated reactions [B/L²]", computed, expected,
                        100 * kAgreement * std::abs(expected), "Newton over the chain"});
  };
  auto line_search = tight_newton();
  line_search.residual_line_search = true;
  const auto l = searched.solve_adaptive(at(target), line_search, kTight);
  if (!l.converged) throw std::runtime_error("the residual line search found no state: " + l.reason);
  note(1, {"", l.iterations, l.factorisations, 0, 0});
  same("residual line search (Algs. IV.2-3)", searched);
  for (const bool broyden : {false, true}) {
    segmentation::SequenceOptions options;
    options.newton = tight_newton();
    options.newton.tolerance = 1e-12;
    options.accuracy = kTight;
    options.broyden = broyden;
    Chain nested = start;
    const auto q = segmentation::solve_sequence(nested, target, options);
    if (!q.converged) throw std::runtime_error("SolveSequence found no state: " + q.reason);
    note(broyden ? 3 : 2, {"", q.iterations, q.factorisations, q.propagations, q.jacobians});
    same(broyden ? "SolveSequence with Broyden's update" : "SolveSequence (Algs. IV.4-5)", nested);
    char text[200];
    std::snprintf(text, sizeof text,
                  "%s, SolveSequence%s: %d propagations, %d Jacobians, %d factorisations; one Newton over the chain: "
                  "%d factorisations.",
                  name.c_str(), broyden ? " with Broyden's update" : "", q.propagations, q.jacobians, q.factorisations,
                  s.factorisations);
    out.notes.push_back(text);
  }
}

// ---- B-splines ----

void splines(Outcome& out, const Conduit& conduit) {
  // A line contact at its sides: free, line, free.
  Chain chain = conduit_state(conduit, 1.0 / 40, -10);
  double misfit = 0, largest = 0;
  int dimension = 0, expected = 0;
  Data file{"b_splines",
            {"segment", "component", "order", "knot S [L]", "control point"},
            std::vector<std::vector<double>>(5)};
  Panel drawn = panel_of("δ_1 of the first free part with its control points", "S [L]", "δ_1 [L]");
  for (int j = 0; j < chain.segments(); ++j) {
    const auto& segment = chain.segment(j);
    const double a = chain.S(j), b = chain.S(j + 1);
    const auto list = collocation::b_splines(segment, a, b);
    const int k = segment.points_per_piece(), N = segment.pieces();
    expected += chain.is_line(j) ? 4 * k * N + 7 : 6 * k * N + 11;
    std::vector<double> u(segment.system().inputs), q(segment.system().quadratures);
    for (std::size_t c = 0; c < list.size(); ++c) {
      dimension += static_cast<int>(list[c].control.size());
      const auto [low, high] = list[c].bounds();
      const double size = std::max({std::abs(low), std::abs(high), 1e-300});
      for (int i = 0; i <= 400; ++i) {
        const double S = a + (b - a) * i / 400;
        segment.evaluate(S, a, b, u.data(), q.data());
        misfit = std::max(misfit, std::abs(list[c].value(S) - u[segment.system().first[c]]) / size);
      }
      for (std::size_t i = 0; i < list[c].knots.size(); ++i) {
        const double row[] = {double(j), double(c), double(list[c].order), list[c].knots[i],
                              i < list[c].control.size() ? list[c].control[i] : NAN};
        for (std::size_t f = 0; f < 5; ++f) file.value[f].push_back(row[f]);
      }
    }
    if (chain.is_line(j)) continue;
    const double high = collocation::squared_norm_bounds(segment, 0, 1, a, b, 1e-14).second;
    largest = std::max(largest, std::sqrt(high));
    if (j != 0) continue;
    Curve curve, control;
    curve.label = "solution";
    control.label = "control points";
    control.line = drawing::Line::dotted;
    control.mark = drawing::Mark::circle;
    control.mark_size = 5;
    const auto& spline = list[0];
    for (int i = 0; i <= 400; ++i) {
      curve.x.push_back(a + (b - a) * i / 400);
      curve.y.push_back(spline.value(curve.x.back()));
    }
    for (std::size_t i = 0; i < spline.control.size(); ++i) {
      double greville = 0;
      for (int m = 1; m < spline.order; ++m)
        greville += spline.knots[i + static_cast<std::size_t>(m)] / (spline.order - 1);
      control.x.push_back(greville);
      control.y.push_back(spline.control[i]);
    }
    drawn.curves = {curve, control};
  }
  out.rows.push_back(
      {"B-splines: largest difference from the solution, relative", misfit, 0.0, 1e-11, "exact conversion, rounding"});
  out.rows.push_back({"B-splines: control points of free | line | free", double(dimension), double(expected), 0.0,
                      "6kN+11 and 4kN+7 (IV.1.5-6)"});
  // The free parts touch the wall at the ends of the line only: their largest |δ| is the clearance itself.
  out.rows.push_back(
      {"B-splines: bound of |δ|/ε over the free parts", largest * 40, 1.0, 1e-8, "no penetration between nodes"});
  out.data.push_back(file);
  Picture picture{
      "b_splines",
      "The solution as a B-spline of order k + 3 with two continuous derivatives: rod in the helical conduit, "
      "ε/L = 1/40, T = -10 |T0|, from the clamp to the contact.",
      {}};
  picture.figure.columns = 1;
  picture.figure.panel_width = 640;
  picture.figure.panels = {drawn};
  out.pictures.push_back(picture);
}

Outcome compute(const Progress& progress) {
  Outcome out;
  const Conduit conduit;
  Data table{"solvers",
             {"epsilon [L]", "T/|T0| from", "T/|T0| to",
              "method (0 chain, 1 chain with residual line search, 2 SolveSequence, 3 with Broyden)",
              "Newton iterations", "factorisations", "propagations", "Jacobians"},
             std::vector<std::vector<double>>(8)};
  const auto go_on = [&](double fraction, const char* what) {
    if (progress && !progress(fraction, what)) throw Interrupted{};
  };
  go_on(0.0, "nested procedures");
  compare_solvers(out, conduit, table, "point contact", 1.0 / 20, -1.8, -2.2);
  go_on(0.1, "nested procedures");
  compare_solvers(out, conduit, table, "line contact", 1.0 / 40, -4.0, -5.0);
  out.data.push_back(table);
  go_on(0.2, "meshes");
  meshes(out, progress);
  go_on(0.92, "B-splines");
  splines(out, conduit);
  out.notes.push_back(
      "Jacobians are exact (dual numbers) everywhere. Finite differences, the thesis' way, serve the tests only: they "
      "check the "
      "linearisation of the equations, of the collocation pieces and of the chain.");
  go_on(1.0, "done");
  return out;
}

}  // namespace

System methods_system() {
  return {
      "methods",
      "Methods of the thesis and its outlook",
      "IV.1, V.3",
      "Nested procedures, Broyden's update, residual line search, Gauss points and adaptive knots, and the solution as "
      "B-splines, on the same states as the default.",
      compute,
      0.3};
}

}  // namespace tendril::reproduce
