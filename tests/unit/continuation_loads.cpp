// Loads and collars from the case file to the solved rod: against closed forms of the beam where the deflections are
// small, and against the independent integration of the Cosserat rod (support/cosserat.hpp) from one end to the other,
// with the loads and the reported reactions as pushes on the way.

#include <gtest/gtest.h>

#include <cmath>

#include "support/cosserat.hpp"
#include "tendril/io/case.hpp"
#include "tendril/io/diagnostics.hpp"

namespace {

using namespace tendril;
using Eigen::Vector3d;

struct Run {
  io::Case c;
  continuation::Result result;
  const continuation::Step& step() const { return result.steps.back(); }
};

Run run(const std::string& text) {
  Run out{io::parse_case(text, "test.toml", io::Format::toml), {}};
  continuation::StudyOptions options;
  options.fields = true;
  options.field_points = 201;
  out.result = io::run(out.c, options);
  EXPECT_EQ(out.result.status, continuation::Status::converged) << out.result.message;
  for (const auto& s : out.result.steps) {
    EXPECT_LT(s.certificate.balance, 1e-9);
    EXPECT_LT(s.certificate.continuity, 1e-9);
    EXPECT_LT(s.certificate.equilibrium, 1e-6);
    EXPECT_GT(s.certificate.gap_min, -1e-9);
  }
  return out;
}

/// Clamped on the axis at S = 0, a sleeve on it at the far end.
std::string held(const std::string& clearance, const std::string& axis, double axial_force, double torque,
                 const std::string& more) {
  return "schema = 1\n[rod]\nbending_stiffness = 1.0\ntorsional_stiffness = 0.75\n[tube]\nclearance = " + clearance +
         "\n[tube.axis]\n" + axis +
         "\n[start]\nkind = \"clamped\"\n[end]\nkind = \"sleeve\"\naxial_force = " + io::shortest(axial_force) +
         "\ntorque = " + io::shortest(torque) + "\n" + more;
}

std::string straight(double clearance, double axial_force, const std::string& more) {
  return held(io::shortest(clearance), "kind = \"straight\"\nlength = 1.0", axial_force, 0.0, more);
}

constexpr const char* arc_axis = "kind = \"arc\"\nradius = 1.0\nlength = 1.5";

/// Extensible, in an arc whose clearance changes.
std::string arc(double axial_force, const std::string& more) {
  std::string text = held("[[0.0, 0.03], [0.8, 0.04], [1.5, 0.03]]", arc_axis, axial_force, 0.5, more);
  return text.replace(text.find("[tube]"), 0, "axial_stiffness = 4000.0\n");
}

/// Largest deflection of the rod integrated from its start under loads and reactions, against the solved state.
double off_the_integration(const Run& r, std::vector<test::CosseratRod::Push> pushes,
                           std::function<void(const Vector3d&, Vector3d&, Vector3d&)> field = {}) {
  const auto problem = io::build_problem(r.c);
  const test::SolvedRod solved(problem, r.step());
  test::CosseratRod rod = solved.rod();
  for (const auto& c : r.step().contacts) {
    EXPECT_FALSE(c.line);
    pushes.push_back({c.s_start, c.force_vector, Vector3d::Zero()});
  }
  rod.pushes = std::move(pushes);
  rod.field = std::move(field);
  const double L = problem.tube.length();
  auto start = solved.at(0.0);
  test::Difference worst;
  double F = 1.0, M = 1.0;
  for (int i = 1; i <= 10; ++i) F = std::max(F, solved.at(L * i / 10).F.norm());
  for (int i = 1; i <= 10; ++i) {
    const auto there = solved.at(L * i / 10.0 - 1e-9);
    worst.take(rod.continued(start, there.s), there, L, F, M);
  }
  return worst.largest();
}

// Midspan force on a beam clamped at both ends: P/192EI. The deflection is 1e-4 of the length: the next term of the
// series in it is of the order of its square.
TEST(PointLoad, BendsAClampedBeamAsTheClosedForm) {
  const auto r = run(straight(0.05, 0.0, "[[load.point]]\nposition = 0.5\nforce = [0.0192, 0.0, 0.0]\n"));
  const auto& f = r.step().fields;
  double most = 0.0;
  for (const double d : f.delta1) most = std::max(most, d);
  EXPECT_NEAR(most, 1e-4, 1e-4 * 1e-6);
  // a couple there turns the section by C L/16EI
  const auto t = run(straight(0.05, 0.0, "[[load.point]]\nposition = 0.5\ncouple = [0.0, 0.0016, 0.0]\n"));
  const test::SolvedRod solved(io::build_problem(t.c), t.step());
  EXPECT_NEAR(solved.at(0.5).d(0, 2), 1e-4, 1e-4 * 1e-6);
}

// Force and couple askew, on the rod and on the axis, in a curved tube; the jump shows in the fields on both sides.
TEST(PointLoad, AgreesWithTheIntegratedRod) {
  const auto r = run(arc(-1.0, R"([[load.point]]
at = 0.6
force = [0.4, 0.6, -0.2]
couple = [0.04, -0.02, 0.06]
)"));
  EXPECT_TRUE(r.step().contacts.empty());
  EXPECT_LT(off_the_integration(r, {{0.6, {0.4, 0.6, -0.2}, {0.04, -0.02, 0.06}}}), 1e-8);
  const auto& f = r.step().fields;
  double jump = 0.0;
  for (std::size_t i = 1; i < f.S.size(); ++i)
    if (f.S[i] - f.S[i - 1] < 1e-7)
      jump = std::max(jump, std::hypot(f.F1[i] - f.F1[i - 1], f.F2[i] - f.F2[i - 1], f.F3[i] - f.F3[i - 1]));
  EXPECT_NEAR(jump, std::sqrt(0.56), 1e-6);

  // the same place from the other end, and where it lies on the axis: the same state
  const double l = r.step().rod_length;
  const auto e = run(arc(-1.0, "[[load.point]]\nmeasured_from = \"end\"\nat = " + io::shortest(l - 0.6) +
                                   "\nforce = [0.4, 0.6, -0.2]\ncouple = [0.04, -0.02, 0.06]\n"));
  EXPECT_NEAR(e.step().rod_length, l, 1e-9);
}

// A rod pressed against the wall by a point load beside its contact, and the same dead load fixed on the axis.
TEST(PointLoad, PressesTheRodAgainstTheWall) {
  const auto r = run(straight(0.05, 20.0, "[[load.point]]\nat = 0.41\nforce = [40.0, 0.0, 0.0]\n"));
  ASSERT_EQ(r.step().contacts.size(), 1u);
  EXPECT_EQ(r.step().stability, "stable");
  EXPECT_LT(off_the_integration(r, {{0.41, {40, 0, 0}, {0, 0, 0}}}), 1e-8);
}

// A line contact goes on below a load that presses it: the wall bears the load at its place, all of it, for the
// inextensible rod's shape there is the wall's. A load that pulls harder than the wall pressed opens the line.
TEST(PointLoad, OnALineContactIsBorneByTheWall) {
  const auto base = [](const std::string& load) { return held("0.02", arc_axis, 100.0, 0.0, load); };
  const auto free = run(base(""));
  // towards the centre of the arc at S = 0.75, where a rod in symmetric tension touches
  const double a = 0.75, P = 15.0;
  const auto load = [&](double f) {
    return "[[load.point]]\nposition = 0.75\nforce = [" + io::shortest(f * std::cos(a)) + ", 0.0, " +
           io::shortest(-f * std::sin(a)) + "]\n";
  };
  const auto pressed = run(base(load(P)));
  ASSERT_EQ(free.step().contacts.size(), 1u);
  ASSERT_EQ(pressed.step().contacts.size(), 1u);
  EXPECT_TRUE(pressed.step().contacts[0].line);
  EXPECT_NEAR(pressed.step().contacts[0].start, free.step().contacts[0].start, 1e-8);
  EXPECT_NEAR(pressed.step().contacts[0].force, free.step().contacts[0].force + P, 1e-6 * P);
  const auto pulled = run(base(load(-P)));
  EXPECT_EQ(pulled.step().contacts.size(), 2u);
}

// A table whose rows are all the same is the constant load.
TEST(LoadField, OfEqualRowsIsTheConstantLoad) {
  const auto constant = run(arc(-8.0, "[load]\nbody_force = [2.0, 3.0, -1.0]\nbody_couple = [0.1, 0.2, 0.0]\n"));
  const auto table = run(arc(-8.0, R"([load]
body_force = [[0.0, 2.0, 3.0, -1.0], [0.55, 2.0, 3.0, -1.0], [1.5, 2.0, 3.0, -1.0]]
body_couple = [[0.0, 0.1, 0.2, 0.0], [1.5, 0.1, 0.2, 0.0]]
)"));
  EXPECT_NEAR(table.step().rod_length, constant.step().rod_length, 1e-10);
  EXPECT_NEAR(table.step().axial_force_start, constant.step().axial_force_start, 1e-8);
  EXPECT_EQ(table.step().stability, "unknown");
}

// Kinks between the ends; on the straight tube S is z, which the integration knows of its own.
TEST(LoadField, AgreesWithTheIntegratedRod) {
  const auto r = run(straight(0.05, 3.0, R"([load]
body_force = [[0.0, 0, 0, 0], [0.3, 20, 8, 0], [0.6, 0, 0, 5]]
body_couple = [[0.2, 0, 0, 0], [0.5, 0.4, 0.2, 0.3], [0.8, 0, 0, 0]]
)"));
  const auto between = [](double z, double a, const Vector3d& A, double b, const Vector3d& B) -> Vector3d {
    return A + (z - a) / (b - a) * (B - A);
  };
  const Vector3d zero(0, 0, 0), f1(20, 8, 0), f2(0, 0, 5), m(0.4, 0.2, 0.3);
  const auto field = [&](const Vector3d& r, Vector3d& f, Vector3d& c) {
    const double z = r[2];
    f = z < 0.3 ? between(z, 0, zero, 0.3, f1) : z < 0.6 ? between(z, 0.3, f1, 0.6, f2) : f2;
    c = z < 0.2 || z > 0.8 ? zero : z < 0.5 ? between(z, 0.2, zero, 0.5, m) : between(z, 0.5, m, 0.8, zero);
  };
  const test::SolvedRod solved(io::build_problem(r.c), r.step());
  std::vector<test::CosseratRod::Push> kinks;  // nothing acts there, but the integration stops
  for (const double S : {0.2, 0.3, 0.5, 0.6, 0.8})
    kinks.push_back({solved.at(S).s, Vector3d::Zero(), Vector3d::Zero()});
  EXPECT_LT(off_the_integration(r, kinks, field), 1e-8);
}

// On a line contact the pressure follows the field: weight that grows along a straight, level tube.
TEST(LoadField, LoadsALineContact) {
  const auto r = run(R"(schema = 1
[rod]
bending_stiffness = 1e-4
torsional_stiffness = 1e-4
[tube]
clearance = 0.01
[tube.axis]
kind = "straight"
length = 1.0
[start]
kind = "clamped"
[end]
kind = "sleeve"
axial_force = 0.0
torque = 0.0
[load]
body_force = [[0.0, 1.0, 0.0, 0.0], [1.0, 3.0, 0.0, 0.0]]
)");
  ASSERT_EQ(r.step().contacts.size(), 1u);
  const auto& c = r.step().contacts[0];
  EXPECT_NEAR(c.pressure_mid, 1.0 + (c.start + c.end), 1e-9);  // 1 + 2 S in the middle
  EXPECT_NEAR(c.force_distributed, (c.end - c.start) * (1.0 + c.start + c.end), 1e-9);
}

// A clamped beam propped at a: the prop bears what brings the deflection q a²(L-a)²/24EI back to its own clearance,
// R = (δ - Q)/(a³(L-a)³/3EIL³). Deflections of 1e-4: the next term is of the order of their square.
TEST(Collar, IsAPropOfTheClampedBeam) {
  const double a = 0.4, q = 0.1, Q = 0.5e-4;
  const auto r = run(straight(
      0.05, 0.0,
      "[load]\nbody_force = [0.1, 0.0, 0.0]\n[[rod.collar]]\nat = 0.4\nheight = " + io::shortest(0.05 - Q) + "\n"));
  const double free = q * a * a * 0.36 / 24, R = (free - Q) / (a * a * a * 0.216 / 3);
  ASSERT_EQ(r.step().contacts.size(), 1u);
  const auto& c = r.step().contacts[0];
  EXPECT_TRUE(c.collar);
  EXPECT_EQ(c.s_start, a);
  EXPECT_NEAR(c.force, R, 1e-6 * R);
  EXPECT_NEAR(c.force_vector[0], -R, 1e-6 * R);
  EXPECT_EQ(r.step().stability, "stable");
}

// The collar meets the wall when the beam's deflection there is its clearance, and leaves it on the way back; on a path
// both are events.
TEST(Collar, AppearsAndLeavesOnAPath) {
  const double Q = 0.5e-4, meets = 24 * Q / (0.16 * 0.36) / 0.1;
  const auto r = run(
      straight(0.05, 0.0,
               "[load]\nbody_force = [0.1, 0.0, 0.0]\n[[rod.collar]]\nat = 0.4\nheight = " + io::shortest(0.05 - Q) +
                   "\n[path]\nparameter = \"load.body_force.scale\"\n"
                   "values = [0.1, 2.0, 0.1, -2.0]\n"));
  std::vector<std::string> kinds;
  for (const auto& e : r.result.events) kinds.push_back(e.kind);
  const std::vector<std::string> expected{"contact_leaves", "contact_appears", "contact_leaves", "contact_appears"};
  ASSERT_EQ(kinds, expected);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(r.result.events[i].parameter, (i == 3 ? -1 : 1) * meets, 1e-6 * meets);
    EXPECT_NEAR(r.result.events[i].S, 0.4, 1e-6);
  }
  EXPECT_EQ(r.step().contacts.size(), 1u);
  EXPECT_GT(r.step().contacts[0].force_vector[0], 0.0);  // the other wall
}

// Three collars in a curved tube whose clearance changes, found from nothing: end to end the integrated rod with the
// reported reactions, which have a part along the rod where it stands at an angle to the wall.
TEST(Collar, AgreesWithTheIntegratedRodInATaperingArc) {
  std::string collars;
  for (const char* at : {"0.4", "0.8", "1.1"})
    collars += std::string("[[rod.collar]]\nat = ") + at + "\nheight = 0.01\n";
  const auto r = run(arc(-30.0, collars + "[load]\nbody_force = [0.0, 5.0, 0.0]\n"));
  ASSERT_EQ(r.step().contacts.size(), 3u);
  const test::SolvedRod solved(io::build_problem(r.c), r.step());
  for (const auto& c : r.step().contacts) {
    EXPECT_TRUE(c.collar);
    const auto x = solved.at(c.start);
    EXPECT_NEAR(x.eccentricity, x.clearance - 0.01, 1e-12);
    const double along = c.force_vector.normalized().dot(x.d.col(2));
    EXPECT_LT(std::abs(c.force_vector.normalized().dot(x.normal) + 1.0), 1e-3);
    EXPECT_LT(std::abs(along), 0.1);
    EXPECT_GT(c.force, 0.0);
  }
  EXPECT_LT(off_the_integration(r, {}), 1e-8);
  EXPECT_EQ(r.step().stability, "stable");

  // counted from the far end: the same rod
  const double l = r.step().rod_length;
  collars.clear();
  for (const double at : {0.4, 0.8, 1.1})
    collars += "[[rod.collar]]\nmeasured_from = \"end\"\nheight = 0.01\nat = " + io::shortest(l - at) + "\n";
  const auto e = run(arc(-30.0, collars + "[load]\nbody_force = [0.0, 5.0, 0.0]\n"));
  EXPECT_NEAR(e.step().rod_length, l, 1e-9);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(e.step().contacts[i].force, r.step().contacts[i].force, 1e-6);
}

// The rod itself may touch between its collars; the wall's contacts come in order, and the state starts again from its
// stored form.
TEST(Collar, AndRodTouchTogether) {
  std::string collars;
  for (const char* at : {"0.4", "0.8", "1.1"})
    collars += std::string("[[rod.collar]]\nat = ") + at + "\nheight = 0.01\n";
  const auto r = run(arc(-10.0, collars + "[load]\nbody_force = [0.0, 5.0, 0.0]\n"
                                          "[path]\nparameter = \"end.axial_force\"\nvalues = [-30.0, -60.0]\n"));
  ASSERT_EQ(r.step().contacts.size(), 4u);
  EXPECT_TRUE(r.step().contacts[0].collar);
  EXPECT_FALSE(r.step().contacts[1].collar);
  const auto problem = io::build_problem(r.c, -60.0);
  const test::SolvedRod solved(problem, r.step());
  EXPECT_NEAR(solved.at(r.step().contacts[2].start).eccentricity,
              problem.tube.clearance->at(r.step().contacts[2].start)[0] - 0.01, 1e-12);
}

// A rod that hangs in a fluid is the lighter rod.
TEST(Buoyancy, MultipliesTheWeight) {
  const std::string load = "[load]\ngravity = [1.0, 0.0, 0.0]\n";
  const auto with = [&](const std::string& rod, const std::string& more) {
    std::string text = straight(0.05, 1.0, load + more);
    text.insert(text.find("[rod]\n") + 6, rod);
    return run(text);
  };
  const auto air = with("weight_per_length = 7.0\n", "");
  const auto mud = with("weight_per_length = 8.0\ndensity = 8.0\n", "fluid_density = 1.0\n");
  EXPECT_DOUBLE_EQ(io::buoyancy_factor(mud.c), 0.875);
  EXPECT_NEAR(mud.step().rod_length, air.step().rod_length, 1e-12);
}

}  // namespace
