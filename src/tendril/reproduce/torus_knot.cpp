#include "tendril/reproduce/torus_knot.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "tendril/closed_form/torus.hpp"
#include "tendril/formulation/line_contact.hpp"
#include "tendril/geometry/error.hpp"

namespace tendril::reproduce::torus {
namespace {

using formulation::LineContact;

constexpr double pi = std::numbers::pi;
// components β ψ F_g F3 λ μ; states β β' β'' ψ ψ' F_g F3 λ μ s, derivatives by x
constexpr int inputs = LineContact::inputs + 4, states = 10;
enum State { beta, beta_x, beta_xx, psi, psi_x, Fg, F3, lambda, mu, length };

template <class T>
formulation::Lifted<T> section_of_torus() {
  formulation::Lifted<T> l;
  for (auto& u : l.U) u = {T(0.0), T(0.0), T(0.0)};
  l.U[0][1] = T(-1.0);
  l.sigma = l.mu = {T(0.0), T(0.0), T(0.0)};
  return l;
}

template <class T>
std::array<T, 4> radius(double epsilon) {
  return {T(epsilon), T(0.0), T(0.0), T(0.0)};
}

/// Derivatives by x to derivatives by ξ = X x.
template <class T>
void by_azimuth(const T* u, const T& X, T* v) {
  const T w = 1.0 / X;
  v[0] = u[0], v[1] = u[1] * w, v[2] = u[2] * w * w, v[3] = u[3] * w * w * w;
  v[4] = u[4], v[5] = u[5] * w, v[6] = u[6] * w * w;
  v[7] = u[7], v[8] = u[8] * w;
  v[9] = u[9], v[10] = u[10] * w;
}

struct Equations {
  Family family;
  std::vector<int> order{3, 2, 1, 1, 1, 1};
  int quadratures = 1;

  template <class T>
  void operator()(const T&, const T* u, const T& p, T* out) const {
    const T X = family.vary == Family::Vary::turn ? 2.0 * pi * p : T(2.0 * pi * family.held);
    T v[LineContact::inputs];
    by_azimuth(u, X, v);
    auto l = section_of_torus<T>();
    l.sigma[2] = u[11];  // λ along D3 = e_θ
    LineContact::residual<T>(family.rod.material, l, radius<T>(family.rod.epsilon), v, out, out + 6);
    out[3] = out[3] + u[13];  // μ along d3
    out[4] = u[12];
    out[5] = u[14];
    out[6] = out[6] * X;
  }
};

template <class T>
T twisting_moment(const Family& f, const T& X, const T* z) {
  const T w = 1.0 / X;
  const auto c = LineContact::curve<T>(section_of_torus<T>(), radius<T>(f.rod.epsilon), z[beta], z[beta_x] * w,
                                       z[beta_xx] * w * w);
  return LineContact::twisting_moment<T>(f.rod.material, c, z[F3], z[psi_x] * w);
}

collocation::Conditions conditions(const Family& family) {
  return collocation::make_conditions<2 * states>(states, [family](const auto* z, const auto& p, auto* r) {
    using T = std::decay_t<decltype(z[0])>;
    const bool turning = family.vary == Family::Vary::turn;
    const T X = turning ? T(2.0 * pi * p) : T(2.0 * pi * family.held);
    const T load = turning ? T(family.held) : T(p + p * p * p);
    const T* a = z;
    const T* b = z + states;
    r[0] = a[beta];  // phase: ξ = 0 on the outer equator
    r[1] = b[beta] - 2.0 * pi * family.windings;
    r[2] = b[beta_x] - a[beta_x];
    r[3] = b[beta_xx] - a[beta_xx];
    r[4] = b[Fg] - a[Fg];
    r[5] = b[F3] - a[F3];
    r[6] = a[F3] - load;
    r[7] = a[psi] + T(0.0);
    r[8] = twisting_moment<T>(family, X, b) - family.rod.M3;
    r[9] = a[length] + T(0.0);
  });
}

V3<double> turned(double angle, const V3<double>& v) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * v[0] - s * v[1], s * v[0] + c * v[1], v[2]};
}

double distance(const V3<double>& a, const V3<double>& b) {
  return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}

}  // namespace

double force_parameter(double force) {
  // the real root of the depressed cubic, by its hyperbolic form
  return 2.0 / std::sqrt(3.0) * std::sinh(std::asinh(1.5 * std::sqrt(3.0) * force) / 3.0);
}

BoundaryValueProblem make_problem(const Family& family, double p, int pieces,
                                  const BoundaryValueProblem::Sampler& sampler) {
  if (!(family.turn(p) > 0.0))
    throw geometry::GeometryError(geometry::Issue{
        "revolutions", 0.0, family.turn(p), 0.0,
        "A curve without a revolution about the torus' axis has d3·D3 = 0: it does not run along the tube, and β is no "
        "function of S.",
        "Meridians are known in closed form (closed_form/torus.hpp); the Lagrangian form represents any curve."});
  BoundaryValueProblem problem({std::make_shared<collocation::DualSystem<Equations, inputs>>(Equations{family})},
                               conditions(family));
  problem.initialise(sampler, pieces);
  problem.set_scale(0, std::vector<double>(states, 1.0));
  problem.set_parameter(p);
  return problem;
}

BoundaryValueProblem::Sampler villarceau_sampler(const Rod& rod) {
  return [rod](int, double x, double* u, double* s) {
    const double X = 2.0 * pi;
    const auto v = closed_form::villarceau(rod.epsilon, closed_form::Hand::right, X * x, rod.M3);
    const double e = rod.epsilon / std::sqrt(1.0 - rod.epsilon * rod.epsilon);
    const double sb = std::sin(v.beta), cb = std::cos(v.beta), b1 = v.beta_prime;
    const double b2 = -e * sb * b1, b3 = -e * (cb * b1 * b1 + sb * b2);
    std::fill(u, u + inputs, 0.0);
    u[0] = v.beta, u[1] = X * b1, u[2] = X * X * b2, u[3] = X * X * X * b3;
    u[5] = X * ((1.0 + rod.material.nu) * rod.M3 - v.state.tau_g) / v.J_bar_1;  // ψ' of M3; ψ itself follows
    u[7] = v.state.F_g;
    u[8] = X * rod.M3 * -std::sin(X * x);
    s[0] = X * x;
  };
}

BoundaryValueProblem::Sampler series_sampler(const Rod& rod, double turn, double H, const std::vector<double>& c) {
  return [=](int, double x, double* u, double* s) {
    const double X = 2.0 * pi * turn, wave = 2.0 * pi;  // by x
    std::fill(u, u + inputs, 0.0);
    u[0] = wave * x;
    u[1] = wave;
    for (std::size_t i = 0; i < c.size(); ++i) {
      const double w = (i + 1) * wave, sine = c[i] * std::sin(w * x), cosine = c[i] * std::cos(w * x);
      u[0] += sine, u[1] += w * cosine, u[2] -= w * w * sine, u[3] -= w * w * w * cosine;
    }
    double v[LineContact::inputs];
    by_azimuth(u, X, v);
    const auto l = section_of_torus<double>();
    const auto k = LineContact::curve_jet<double>(l.U, radius<double>(rod.epsilon), v[0], v[1], v[2], v[3]);
    u[5] = -X * k.tg.v / k.J1bar.v;
    u[7] = k.kn.v * k.tg.v - k.J1bar.v * k.kg.d;  // (III.2.34)
    u[9] = H - 0.5 * (k.kn.v * k.kn.v + k.kg.v * k.kg.v);
    u[10] = -X * (k.kn.v * k.kn.d + k.kg.v * k.kg.d);
    s[0] = X * x;
  };
}

BoundaryValueProblem::Sampler repeated(const BoundaryValueProblem& problem, int times) {
  return [problem, times](int, double x, double* u, double* s) {
    const int i = std::min(static_cast<int>(x * times), times - 1);
    problem.evaluate(0, x * times - i, u, s);
    const int first[] = {0, 4, 7, 9, 11, 13, inputs};
    for (int c = 0; c < 6; ++c) {
      double factor = 1.0;
      for (int j = first[c]; j < first[c + 1]; ++j, factor *= times) u[j] *= factor;
    }
    u[0] += i * problem.end_value(0, true, 0);
    u[4] += i * problem.end_value(0, true, 1);
    s[0] += i * problem.ends()[states + length];
  };
}

Point point_at(const Family& family, const BoundaryValueProblem& problem, double x) {
  const double X = 2.0 * pi * family.turn(problem.parameter()), eps = family.rod.epsilon;
  const auto& material = family.rod.material;
  double u[inputs], v[LineContact::inputs], s = 0.0;
  problem.evaluate(0, x, u, &s);
  by_azimuth(u, X, v);
  formulation::Section section;
  section.U[0] = {0.0, -1.0, 0.0};
  section.Q[0] = eps;
  const auto wall = LineContact::wall(material, section, v);
  Point q;
  q.xi = X * x;
  q.beta = v[0];
  q.slope = v[1];
  q.s = s;
  q.Fg = v[7];
  q.F3 = v[9];
  q.Fn = wall.Fn;
  q.M3 = wall.M3;
  q.rho = wall.rho;
  q.kn = wall.curve.kn;
  q.kg = wall.curve.kg;
  q.tg = wall.curve.tg;
  q.alpha = 1.0 + material.eta2 * q.F3;
  // From here on only the place r(ξ) = (1 + ε cosβ) e_r - ε sinβ e_z and its derivatives, in (e_r, e_θ, e_z).
  const double cb = std::cos(v[0]), sb = std::sin(v[0]), C3 = 1.0 + eps * cb, b1 = v[1], b2 = v[2];
  const V3<double> r1{-eps * sb * b1, C3, -eps * cb * b1};
  const V3<double> r2{-eps * (cb * b1 * b1 + sb * b2) - C3, -2.0 * eps * sb * b1, eps * (sb * b1 * b1 - cb * b2)};
  const double speed = std::sqrt(numerics::dot(r1, r1)), stretch = numerics::dot(r1, r2) / (speed * speed);
  using numerics::operator*;
  using numerics::operator+;
  using numerics::operator-;
  const V3<double> t = (1.0 / speed) * r1, N{cb, 0.0, -sb}, g = numerics::cross(N, t);
  const V3<double> turning = (q.alpha / (speed * speed)) * (r2 - stretch * r1);  // dd3/ds
  const V3<double> F = q.Fg * g + q.Fn * N + q.F3 * t;
  const V3<double> M = numerics::cross(t, turning) + q.M3 * t;
  const V3<double> r{C3, 0.0, -eps * sb};
  q.along = t[1];
  q.axial_moment = M[2] + r[0] * F[1] - r[1] * F[0];
  q.H = 0.5 * numerics::dot(turning, turning) + q.F3 + 0.5 * material.eta2 * q.F3 * q.F3;
  q.r = turned(q.xi, r);
  q.d3 = turned(q.xi, t);
  q.N = turned(q.xi, N);
  q.F = turned(q.xi, F);
  q.M = turned(q.xi, M);
  return q;
}

std::vector<Point> points(const Family& family, const BoundaryValueProblem& problem, int count) {
  std::vector<Point> out;
  for (int i = 0; i <= count; ++i) out.push_back(point_at(family, problem, static_cast<double>(i) / count));
  return out;
}

Faults faults(const Family& family, const BoundaryValueProblem& problem) {
  using numerics::operator*;
  using numerics::operator+;
  using numerics::operator-;
  Faults f{};
  f.phase = std::abs(problem.end_value(0, false, 4));
  f.drag = std::abs(problem.end_value(0, false, 5));
  const double X = 2.0 * pi * family.turn(problem.parameter());
  const auto& mesh = problem.segment(0);
  const auto& gauss = numerics::gauss_table(numerics::max_points);
  double H[2] = {HUGE_VAL, -HUGE_VAL}, axial[2] = {HUGE_VAL, -HUGE_VAL};
  Point left = point_at(family, problem, 0.0);
  const Point first = left;
  V3<double> force{}, moment{};
  for (int i = 0; i < mesh.pieces(); ++i)
    for (int half = 0; half < 2; ++half) {
      const double a = mesh.place(i, 0.0, 1.0), b = mesh.place(i + 1, 0.0, 1.0), h = 0.5 * (b - a);
      const double x0 = a + half * h;
      for (int g = 0; g < gauss.k; ++g) {
        const Point q = point_at(family, problem, x0 + h * gauss.c[g]);
        const double C3 = 1.0 + family.rod.epsilon * std::cos(q.beta);
        const double ds = X * h * gauss.b[g] * C3 / (q.along * q.alpha);  // ds = C3 dξ/(α cosϑ)
        force = force + (q.rho * ds) * q.N;
        moment = moment + (q.alpha * ds) * numerics::cross(q.d3, q.F);
        f.M3 = std::max(f.M3, std::abs(q.M3 - family.rod.M3));
        H[0] = std::min(H[0], q.H), H[1] = std::max(H[1], q.H);
        axial[0] = std::min(axial[0], q.axial_moment), axial[1] = std::max(axial[1], q.axial_moment);
      }
      const Point right = point_at(family, problem, x0 + h);
      f.force = std::max(f.force, distance(right.F + force, first.F));
      f.moment = std::max(f.moment, distance(right.M + moment, first.M));
      left = right;
    }
  f.H = H[1] - H[0];
  f.axial_moment = axial[1] - axial[0];
  f.closure = std::max(
      {distance(left.F, turned(X, first.F)), distance(left.M, turned(X, first.M)), std::abs(left.rho - first.rho)});
  return f;
}

}  // namespace tendril::reproduce::torus
