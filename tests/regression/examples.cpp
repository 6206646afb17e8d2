// Every case under examples/ through io and the solver: contact pattern, certificate, balance of the whole rod from
// world vectors, the independent integration (support/cosserat.hpp), and for each a number found by other means.

#include <gtest/gtest.h>

#include <filesystem>

#include "support/cosserat.hpp"
#include "support/problems.hpp"
#include "tendril/continuation/study.hpp"
#include "tendril/io/case.hpp"

namespace tendril::test {
namespace {

using continuation::Contact;
using continuation::Result;
using continuation::Status;
using continuation::Step;

const std::string examples = std::string(TENDRIL_SOURCE_DIR) + "/examples/";

struct Solved {
  io::Case text;
  Result result;
  Problem at(const Step& s) const { return io::build_problem(text, s.parameter.value_or(0)); }
};

Solved run(const std::string& name, const std::vector<std::string>& overrides = {}) {
  Solved s{io::read_case(examples + name + ".toml", overrides), {}};
  continuation::StudyOptions options;
  options.solve = io::solve_options(s.text);
  if (s.text.path)
    s.result =
        continuation::follow([&](double p) { return io::build_problem(s.text, p); }, io::study_path(s.text), options);
  else
    s.result = continuation::solve(io::build_problem(s.text), options);
  return s;
}

/// "P", "L" per contact.
std::string pattern(const Step& s) {
  std::string out;
  for (const Contact& c : s.contacts) out += c.line ? 'L' : 'P';
  return out;
}

// The solver is asked for 1e-8 between nodes; ten times that for what is made of derivatives or sums of them.
constexpr double derived = 1e-7;

/// Certificate, balance of world vectors, and the independent integration, for every step.
void expect_sound(const Solved& solved, const std::vector<std::string>& patterns, double moment = 1e-300) {
  const Result& r = solved.result;
  ASSERT_EQ(r.status, Status::converged) << r.message;
  ASSERT_EQ(r.steps.size(), patterns.size());
  for (std::size_t i = 0; i < patterns.size(); ++i) {
    const Step& s = r.steps[i];
    SCOPED_TRACE("step " + std::to_string(i));
    EXPECT_EQ(pattern(s), patterns[i]);
    EXPECT_EQ(s.stability, "stable") << s.branch;
    const auto& c = s.certificate;
    EXPECT_LE(c.error, 1e-8);
    EXPECT_LE(c.balance, 1e-8);
    EXPECT_LE(c.continuity, 1e-8);
    EXPECT_LE(c.invariant_spread, derived);
    EXPECT_GE(c.gap_min, -derived);
    EXPECT_GE(c.reaction_min, -derived);
    EXPECT_LE(c.phase_multiplier, derived);

    const Problem p = solved.at(s);
    const SolvedRod rod(p, s);
    EXPECT_LT(free_segments_against_integration(rod, p.tube.length(), 8).largest(), derived);
    EXPECT_LT(line_contacts_against_balance(rod, 24, 1e-300, moment).largest(), derived);
    // F(end) - F(start) + weight + wall = 0
    const Section a = rod.at(0), b = rod.at(rod.place(rod.segments()));
    Vector3d sum = b.F - a.F + s.rod_length * rod.rod().load();
    for (const rod::SectionPiece& piece : p.law.pieces) {  // weight of a varying rod, constant or linear in a piece
      const double from = std::max(a.s, piece.from), to = std::min(b.s, piece.to);
      if (to > from)
        sum += (to - from) * piece.at<double>(0.5 * (from + to)).weight * p.body_force_scale.value *
               p.load.weight_direction;
    }
    double most = std::max(a.F.norm(), b.F.norm());
    for (const Contact& k : s.contacts) {
      // a resting tip's force is the force at the end already
      if (k.line || k.start < p.end_position.value * (1 - 1e-12)) sum += k.force_vector;
      most = std::max(most, k.force);
      EXPECT_GE(k.force, k.force_vector.norm() * (1 - 1e-12));
      if (!k.line) continue;
      // the wall pushes everywhere; a tensile stretch is measured by the force it would carry (where the curvature of a
      // surveyed hole jumps, the pressure may dip over millimetres)
      double tensile = 0;
      constexpr int samples = 20000;
      const int j = rod.segment_at(0.5 * (k.start + k.end));
      for (int q = 0; q < samples; ++q)
        tensile += std::max(0.0, -rod.pressure(j, k.start + (k.end - k.start) * (q + 0.5) / samples));
      EXPECT_LT(tensile * (k.end - k.start) / samples, derived * most);
    }
    EXPECT_LT(sum.norm(), derived * most);
  }
}

TEST(Examples, NoneIsLeftOut) {
  std::vector<std::string> found;
  for (const auto& file : std::filesystem::directory_iterator(examples))
    if (file.path().extension() == ".toml") found.push_back(file.path().stem());
  std::sort(found.begin(), found.end());
  const std::vector<std::string> tested{
      "buckled_fixed_length", "drillstring_sections", "guidewire_tapered", "guidewire_vessel", "helix_inner_20",
      "helix_inner_40",       "helix_outer_20",       "helix_outer_40",    "outside_winding",  "s_bend",
      "varying_clearance",    "well_forge",           "well_forge_long"};
  EXPECT_EQ(found, tested);
}

/// Numbers from the independent computation quoted in the examples' own pages.
void expect_event(const Result& r, std::size_t i, const std::string& kind, double load, double length) {
  ASSERT_GT(r.events.size(), i);
  EXPECT_EQ(r.events[i].kind, kind);
  EXPECT_NEAR(r.events[i].parameter / conduit::T0 / -load, 1, derived);
  EXPECT_NEAR(r.events[i].rod_length, length, 1e-8);
}

TEST(Examples, HelixInner20) {
  const Solved s = run("helix_inner_20");
  ASSERT_NO_FATAL_FAILURE(expect_sound(s, {"P", "P", "P", "P", "L", "L", "L", "L"}));
  expect_event(s.result, 0, "contact_appears", -0.281948695, 0.948599452);
  expect_event(s.result, 1, "point_to_line", 3.327296290, 0.871643590);
}

TEST(Examples, HelixInner40) {
  const Solved s = run("helix_inner_40");
  ASSERT_NO_FATAL_FAILURE(expect_sound(s, {"P", "P", "L", "L", "L", "L", "L", "L"}));
  expect_event(s.result, 0, "contact_appears", -0.720354515, 0.984149288);
  expect_event(s.result, 1, "point_to_line", 0.614146894, 0.952369152);
}

TEST(Examples, HelixOuter20) {
  const Solved s = run("helix_outer_20");
  ASSERT_NO_FATAL_FAILURE(expect_sound(s, {"", "P", "L", "L", "L", "LL"}));
  expect_event(s.result, 0, "contact_appears", -1.290510413, 1.085193598);
  expect_event(s.result, 1, "point_to_line", -2.640046467, 1.127716284);
  ASSERT_EQ(s.result.events.size(), 3u);
  EXPECT_EQ(s.result.events[2].kind, "line_splits");
  EXPECT_NEAR(s.result.events[2].parameter / conduit::T0 / 24.3653829, 1, 1e-6);
}

TEST(Examples, HelixOuter40) {
  const Solved s = run("helix_outer_40");
  ASSERT_NO_FATAL_FAILURE(expect_sound(s, {"P", "P", "L", "L", "L", "L", "L"}));
  expect_event(s.result, 0, "contact_appears", -1.178887788, 1.051427956);
  expect_event(s.result, 1, "point_to_line", -2.006721010, 1.075190813);
}

TEST(Examples, BuckledFixedLength) {
  // against the elastica: straight_tube.cpp
  const Solved s = run("buckled_fixed_length");
  ASSERT_NO_FATAL_FAILURE(expect_sound(s, {"P"}));
  EXPECT_NEAR(s.result.steps[0].rod_length, 1.0063, 1e-9);
  EXPECT_NEAR(s.result.steps[0].contacts[0].start, 0.5, derived);
  // its page: "about 1.6 times Euler's"
  EXPECT_NEAR(s.result.steps[0].axial_force_end / (-4 * pi * pi), 1.6, 0.05);
}

TEST(Examples, VaryingClearance) {
  // a beam between clamps sags by w/384; held in the middle at h it pushes with 192 (w/384 - h). The axial force is
  // held at zero, so theory of small slopes errs by about the squared slope times the load's share, well under 1 %.
  const Solved s = run("varying_clearance");
  ASSERT_NO_FATAL_FAILURE(expect_sound(s, {"P", "P"}));
  ASSERT_EQ(s.result.events.size(), 1u);
  EXPECT_EQ(s.result.events[0].kind, "contact_appears");
  EXPECT_NEAR(s.result.events[0].parameter * 5 / (384 * 0.02), 1, 0.01);
  EXPECT_NEAR(s.result.events[0].S, 0.5, 1e-6);
  for (const Step& step : s.result.steps) {
    const double w = 5 * *step.parameter;
    EXPECT_NEAR(step.contacts[0].force / (192 * (w / 384 - 0.02)), 1, 0.01);
    EXPECT_GT(-step.contacts[0].force_vector.x(), 0.999 * step.contacts[0].force);  // straight up
  }
}

TEST(Examples, OutsideWinding) {
  const Solved s = run("outside_winding");
  ASSERT_NO_FATAL_FAILURE(expect_sound(s, {"L"}));
  const Contact& line = s.result.steps[0].contacts[0];
  // the arc looks the same from both ends after half a turn about its middle radius
  EXPECT_NEAR(line.start + line.end, 1, derived);
  EXPECT_NEAR(*line.force_start / *line.force_end, 1, derived);
  // counted along the rod the polar angle makes one turn
  const Problem p = s.at(s.result.steps[0]);
  const SolvedRod rod(p, s.result.steps[0]);
  double turned = 0;
  Vector3d last;
  for (int i = 0; i <= 400; ++i) {
    const double S = i / 400.0;
    const auto axis = p.tube.axis->at(S);
    const Vector3d e = axis.frame.transpose() * (rod.at(S).r - axis.position);
    if (i > 0) turned += std::remainder(std::atan2(e.y(), e.x()) - std::atan2(last.y(), last.x()), 2 * pi);
    last = e;
  }
  EXPECT_NEAR(turned, 2 * pi, 1e-9);
}

TEST(Examples, SBend) {
  const Solved s = run("s_bend");
  ASSERT_NO_FATAL_FAILURE(expect_sound(s, {"L"}));
  // the step x = f(z), weight along y: turning the picture by half a turn about the y direction through the middle
  // exchanges the ends, so everything is symmetric
  const Contact& line = s.result.steps[0].contacts[0];
  EXPECT_NEAR((line.start + line.end) / s.at(s.result.steps[0]).tube.length(), 1, derived);
  EXPECT_LT(line.force_vector.y() * s.at(s.result.steps[0]).load.force.y(), 0);  // the wall carries weight
  EXPECT_LT(line.force_vector.norm(), 2 * 20 * s.result.steps[0].rod_length);
}

TEST(Examples, GuidewireVessel) {
  const Solved s = run("guidewire_vessel");
  ASSERT_NO_FATAL_FAILURE(expect_sound(s, {"P"}));
  EXPECT_NEAR(s.result.steps[0].axial_force_end, -1, 1e-9);
  // frictionless and without weight: H is one number, so the push behind both ends is the same
  const Problem p = s.at(s.result.steps[0]);
  const SolvedRod rod(p, s.result.steps[0]);
  const Section a = rod.at(0), b = rod.at(rod.place(rod.segments()));
  const auto H = [&](const Section& x) {
    const Vector3d d3 = x.d.col(2);
    return (x.M - x.M.dot(d3) * d3).squaredNorm() / (2 * p.rod.bending_stiffness) + x.F.dot(d3);
  };
  EXPECT_NEAR(H(a), H(b), derived * std::abs(H(b)));
  EXPECT_NEAR(-H(b), s.result.steps[0].push, derived);
}

TEST(Examples, GuidewireTapered) {
  const Solved s = run("guidewire_tapered");
  ASSERT_NO_FATAL_FAILURE(expect_sound(s, {"PPP"}));
  const Step& step = s.result.steps[0];
  const Problem p = s.at(step);
  const SolvedRod rod(p, step);
  // H is one number along the uniform shaft; along the taper dH/ds = -½ B_s ω² (the trapezoidal rule errs by the
  // square of its step)
  const auto H = [&](const Section& x, const Vector3d& towards) {
    const Vector3d d3 = x.d.col(2), bending = x.M - x.M.dot(d3) * d3;
    return bending.squaredNorm() / (2 * rod.rod().properties(x.s, x.s + towards.x()).B) + x.F.dot(d3);
  };
  const Vector3d on(1, 0, 0);
  const Section start = rod.at(0);
  double S = 0;
  for (; rod.at(S).s < -0.04; S += 0.001) EXPECT_NEAR(H(rod.at(S), on), H(start, on), 1e-7 * std::abs(H(start, on)));
  double fallen = 0, last_rate = 0, last_s = 0;
  bool begun = false;
  for (int i = 0; i <= 20000; ++i) {
    const Section x = rod.at(S + (0.15 - S) * i / 20000 - (i == 20000 ? 1e-12 : 0));
    const Vector3d d3 = x.d.col(2), bending = x.M - x.M.dot(d3) * d3;
    const auto q = rod.rod().properties(x.s, x.s);
    const double rate = -0.5 * q.Bs * bending.squaredNorm() / (q.B * q.B);
    if (begun) fallen += 0.5 * (rate + last_rate) * (x.s - last_s);
    begun = true;
    last_rate = rate;
    last_s = x.s;
  }
  const Section tip = rod.at(0.15 - 1e-12);
  EXPECT_NEAR((H(tip, -on) - H(rod.at(S), on)) / fallen, 1, 1e-4);
  EXPECT_LT(tip.M.norm(), 1e-8);
}

TEST(Examples, DrillstringSections) {
  const Solved s = run("drillstring_sections");
  // along the straight wall nothing bends: moments are weighed by the force times the clearance, here least at the bit
  const Step& held = s.result.steps.at(0);
  ASSERT_NO_FATAL_FAILURE(expect_sound(s, {"L"}, std::abs(held.axial_force_end) * s.at(held).tube.clearance->at(0)[0]));
  const Contact& line = s.result.steps[0].contacts[0];
  EXPECT_NEAR(line.pressure_max / (1160 * 0.5), 1, 1e-6);
  EXPECT_NEAR(line.pressure_mid / (620 * 0.5), 1, 1e-6);
  // beam theory without axial force: q l^4 = 72 EI h; 35 kN of thrust shorten the span by about a percent
  const Problem p = s.at(s.result.steps[0]);
  const double EI = p.law.at(-1.0).B, h = p.tube.clearance->at(0)[0];
  EXPECT_NEAR((150 - line.end) / std::pow(72 * EI * h / 580, 0.25), 0.99, 0.01);
}

TEST(Examples, WellForge) {
  const Solved s = run("well_forge");
  ASSERT_NO_FATAL_FAILURE(expect_sound(s, {"LLLLLL"}));
  const Step& step = s.result.steps[0];
  const Problem p = s.at(step);
  // Down is +z: along the hole weight adds to the tension upwards. Energy H + σ·r is one number along the rod, so to
  // the small bending at the ends F3(0) - F3(L) = w times the depth between them.
  const double depth = p.tube.axis->at(p.tube.length()).position.z() - p.tube.axis->at(0).position.z();
  EXPECT_NEAR((step.axial_force_start - step.axial_force_end) / (250 * depth), 1, 1e-3);
  // what presses on the low side is the weight's part across the hole, to the hole's own small bends
  double across = 0;
  for (int i = 0; i < 300; ++i)
    across += p.tube.axis->at(p.tube.length() * (i + 0.5) / 300).frame.col(2).head(2).norm() * 250;
  double wall = 0;
  for (const Contact& c : step.contacts) wall += c.force;
  EXPECT_NEAR(wall / across, 1, 0.1);
  for (const Contact& c : step.contacts) EXPECT_LT(c.force_vector.z(), 0);  // upwards
}

/// In the longest line of well_forge the pressure would fall to -0.36 N/m at a knot of the survey and rise by 167 N/m²
/// on both sides of it. A beam under p = -a + k|x| leaves the wall over 8/3 of 2a/k, 11.4 mm of 300 m: the gap is
/// 1e-17 m, less than the last digit of the eccentricity.
TEST(Examples, WellForgeOpensWhereAMillimetrePulls) {
  const std::string file = std::string(TENDRIL_SOURCE_DIR) + "/examples/well_forge.toml";
  double span = 0;
  for (const double tolerance : {1e-8, 3e-9, 1e-9, 3e-10, 1e-10}) {
    SCOPED_TRACE("tolerance " + std::to_string(1e10 * tolerance) + "e-10");
    const Problem p = io::build_problem(io::read_case(file, {}));
    continuation::StudyOptions o;
    o.solve.tolerance = tolerance;
    const auto r = continuation::solve(p, o);
    ASSERT_EQ(r.status, Status::converged) << r.message;
    const Step& s = r.steps[0];
    ASSERT_EQ(s.contacts.size(), 6u);
    EXPECT_GT(s.certificate.reaction_min, 0) << "nothing pulls";
    EXPECT_GE(s.certificate.gap_min, -1e-15) << "of the clearance: rounding of the eccentricity";
    EXPECT_LE(s.certificate.continuity, 1e-11);
    EXPECT_LE(s.certificate.balance, 1e-11);
    for (const Contact& c : s.contacts) EXPECT_GT(c.pressure_min, 0);
    const double now = s.contacts[4].start - s.contacts[3].end;
    EXPECT_NEAR(now, 8.0 / 3.0 * 0.00429, 1e-4) << "the beam's, its data to 1 %";
    // the curvatures it rests on are 1e-8 of the whole: what the fields may err by, at most, over that
    if (span > 0) {
      EXPECT_NEAR(now / span, 1, 1e-2);
    }
    span = now;
  }
}

TEST(Examples, WellForgeLong) {
  const Solved s = run("well_forge_long");
  ASSERT_EQ(s.result.status, Status::converged) << s.result.message;
  ASSERT_NO_FATAL_FAILURE(expect_sound(s, {"PPPPPPPPPPPPPPPPPLLLLLLLLLLLLLLL"}));
  const Step& step = s.result.steps[0];
  const Problem p = s.at(step);
  // as above: the tension at the top is the weight of the depth, the wall carries the weight's part across the hole
  const double depth = p.tube.axis->at(p.tube.length()).position.z() - p.tube.axis->at(0).position.z();
  EXPECT_NEAR((step.axial_force_start - step.axial_force_end) / (250 * depth), 1, 1e-3);
  Vector3d wall = Vector3d::Zero();
  for (const Contact& c : step.contacts) wall += c.force_vector;
  double across = 0;
  for (int i = 0; i < 900; ++i) {
    const Vector3d t = p.tube.axis->at(p.tube.length() * (i + 0.5) / 900).frame.col(2);
    across += 250 * (1 - t.z() * t.z());
  }
  EXPECT_NEAR(-wall.z() / across, 1, 0.1);
}

/// A real vessel, where its data lie beside the checkout (not redistributed with it).
TEST(Vessel, AortaIntoLeftIliac) {
  const std::string file =
      std::string(TENDRIL_SOURCE_DIR) + "/../shared/data/vessels/simvascular_demo_aorta_left_iliac.csv";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no vessel data beside the checkout: " << file;
  const std::string text = R"(schema = 1
title = "Guidewire, aorta to left iliac artery"
units = "si"
[rod]
bending_stiffness = "895 N mm^2"
poisson_ratio = 0.3
diameter = "0.889 mm"
[tube]
side = "inside"
[tube.axis]
kind = "points"
smoothing = "0.3 mm"          # the centreline as exported has kinks: K r up to 5.8
file = ")" + file + R"("
[start]
kind = "clamped"
[end]
kind = "sleeve"
position = "150 mm"
axial_force = -1.0
torque = 0.0
)";
  Solved s{io::parse_case(text, "vessel.toml", io::Format::toml), {}};
  s.result = continuation::solve(io::build_problem(s.text), {});
  ASSERT_EQ(s.result.status, Status::converged) << s.result.message;
  ASSERT_NO_FATAL_FAILURE(expect_sound(s, {pattern(s.result.steps[0])}));
  const Step& step = s.result.steps[0];
  EXPECT_GE(step.contacts.size(), 1u);
  // the axis of this stretch is 150 mm long; the wire cuts or rounds its bends within the clearance of about 10 mm
  EXPECT_NEAR(step.rod_length, 0.150, 0.010);
  EXPECT_NEAR(step.axial_force_end, -1, 1e-9);
}

}  // namespace
}  // namespace tendril::test
