#include "tendril/continuation/lagrangian_conditions.hpp"

#include <algorithm>
#include <cmath>

namespace tendril::continuation {

using collocation::Conditions;
using formulation::LagrangianFree;
using formulation::LagrangianLine;
using formulation::Quaternion;
using formulation::WallPoint;
using numerics::cross;
using numerics::dot;
using numerics::operator+;
using numerics::operator-;
using numerics::operator*;

namespace {

constexpr int most = LagrangianFree::components;  // states of one end
using D = numerics::Dual<2 * most + 1>;           // right end of one segment, left end of the next, p

template <class T>
V3<T> vector(const T* z) {
  return {z[0], z[1], z[2]};
}
template <class T>
V3<T> lift(const V3<double>& a) {
  return {T(a[0]), T(a[1]), T(a[2])};
}

struct FreeEnd {
  V3<D> r, F, M, d3;
  explicit FreeEnd(const D* z)
      : r(vector(z)),
        F(vector(z + 7)),
        M(vector(z + 10)),
        d3(formulation::director3(Quaternion<D>{z[3], z[4], z[5], z[6]})) {}
};

struct LineEnd {
  V3<D> M, d3;
  WallPoint<D> wall;
  LineEnd(const LagrangianProblem& p, const D* z)
      : M(vector(z + 6)),
        d3(formulation::director3(Quaternion<D>{z[2], z[3], z[4], z[5]})),
        wall(p.rod.tube(z[0].v), z[0], z[1]) {}
};

/// Place, direction or its moments, turn or torque, (II.1.16-17); the axial condition where it belongs.
int end_rows(const LagrangianProblem& p, const D* z, bool start, const D& axial, D* r) {
  const LagrangianEnd& held = start ? p.start : p.end;
  const Quaternion<D> q{z[3], z[4], z[5], z[6]};
  const FreeEnd e(z);
  const V3<D> d1 = formulation::director1(q);
  int n = 0;
  for (int i = 0; i < 3; ++i) r[n++] = e.r[i] - held.position[i];
  if (held.tangent) {
    const V3<double>& t = *held.tangent;
    const V3<double> other = std::abs(t[0]) < 0.6 ? V3<double>{1, 0, 0} : V3<double>{0, 1, 0};
    const V3<double> a = cross(t, other), b = cross(t, a);
    r[n++] = dot(lift<D>(a), e.d3);
    r[n++] = dot(lift<D>(b), e.d3);
  } else {
    r[n++] = dot(e.M, d1);
    r[n++] = dot(e.M, cross(e.d3, d1));
  }
  if (held.roll) {  // sin of the angle's error
    const V3<D> D1 = lift<D>(held.D1), D2 = lift<D>(held.D2), sum = lift<D>(held.D3) + e.d3;
    const D f = 1.0 / (1.0 + dot(lift<D>(held.D3), e.d3));
    const D c = dot(d1, D1 - (dot(D1, e.d3) * f) * sum), s = dot(d1, D2 - (dot(D2, e.d3) * f) * sum);
    r[n++] = s * std::cos(*held.roll) - c * std::sin(*held.roll);
  } else {
    r[n++] = dot(e.M, e.d3) - held.torque;
  }
  if (start) r[n++] = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3] - 1.0;  // conserved from here on
  if (start == p.axial_at_start) {
    const D F3 = dot(e.F, e.d3), M3 = dot(e.M, e.d3);
    if (p.push)
      r[n++] = axial + 0.5 * (dot(e.M, e.M) - M3 * M3) + F3 + (0.5 * p.rod.material.eta2) * (F3 * F3);
    else
      r[n++] = F3 - axial;
  }
  return n;
}

/// Continuity of everything but F·N, the rod on the wall and tangent to it.
int point(const LagrangianProblem& p, const D* right, const D* left, double place, D* r) {
  using std::sqrt;
  const FreeEnd a(right), b(left);
  int n = 0;
  for (int i = 0; i < 7; ++i) r[n++] = left[i] - right[i];    // r, directors
  for (int i = 10; i < 13; ++i) r[n++] = left[i] - right[i];  // M
  const D S = formulation::closest_place(p.rod.tube, a.r, place);
  const formulation::TubeJet tube = p.rod.tube(S.v);
  const D dS = S - tube.S;
  const V3<D> off = a.r - formulation::taylor<D>(tube.R, dS, 0);
  const D x = dot(off, formulation::taylor<D>(tube.D1, dS, 0)), y = dot(off, formulation::taylor<D>(tube.D2, dS, 0));
  const WallPoint<D> wall(tube, S, atan2(y, x));
  const V3<D> jump = b.F - a.F;
  r[n++] = sqrt(x * x + y * y) - formulation::taylor<D>(tube.Q, dS, 0);
  r[n++] = dot(a.d3, wall.N);
  r[n++] = dot(jump, a.d3);
  r[n++] = dot(jump, cross(wall.N, a.d3));
  return n;
}

int touch_down(const LagrangianProblem& p, const D* right, const D* left, D* r) {  // free | line
  const FreeEnd a(right);
  const LineEnd b(p, left);
  int n = 0;
  for (int i = 0; i < 3; ++i) r[n++] = b.wall.X[i] - a.r[i];
  for (int i = 0; i < 4; ++i) r[n++] = left[2 + i] - right[3 + i];
  for (int i = 0; i < 3; ++i) r[n++] = b.M[i] - a.M[i];
  r[n++] = left[9] - dot(a.F, a.d3);
  r[n++] = left[10] - dot(a.F, cross(b.wall.N, a.d3));
  // invariants of the line contact: tangency, and its derivative
  r[n++] = dot(b.d3, b.wall.N);
  const D alpha = 1.0 + p.rod.material.eta2 * left[9];
  r[n++] = dot(b.M, cross(b.d3, b.wall.N)) - alpha * b.wall.normal_curvature(b.wall.rates(b.d3));
  return n;
}

int lift_off(const LagrangianProblem& p, const D* right, const D* left, D* r) {  // line | free
  const LineEnd a(p, right);
  const FreeEnd b(left);
  int n = 0;
  for (int i = 0; i < 3; ++i) r[n++] = b.r[i] - a.wall.X[i];
  for (int i = 0; i < 4; ++i) r[n++] = left[3 + i] - right[2 + i];
  for (int i = 0; i < 3; ++i) r[n++] = b.M[i] - a.M[i];
  r[n++] = dot(b.F, b.d3) - right[9];
  r[n++] = dot(b.F, cross(a.wall.N, b.d3)) - right[10];
  return n;
}

}  // namespace

Conditions lagrangian_conditions(std::shared_ptr<const LagrangianProblem> problem, const LagrangianPattern& pattern,
                                 const std::vector<double>& places) {
  const int n = static_cast<int>(pattern.size());
  std::vector<int> size;
  int ends = 0;
  for (bool line : pattern) {
    size.push_back(line ? LagrangianLine::components : LagrangianFree::components);
    ends += 2 * size.back();
  }
  auto evaluate = [=](const double* e, double p, double* r, double* jac) {
    D z[2 * most], out[most];
    int row = 0, at = 0;
    // block of conditions on `count` consecutive entries of the ends, from `first`
    auto block = [&](int first, int count, auto&& conditions) {
      for (int i = 0; i < count; ++i) z[i] = D::seed(e[first + i], i);
      const int rows = conditions(static_cast<const D*>(z));
      for (int i = 0; i < rows; ++i, ++row) {
        r[row] = out[i].v;
        if (!jac) continue;
        double* to = jac + static_cast<std::size_t>(row) * (ends + 1);
        std::fill_n(to, ends + 1, 0.0);
        std::copy_n(out[i].d.begin(), count, to + first);
        to[ends] = out[i].d[2 * most];
      }
    };
    const D axial = D::seed(p, 2 * most);
    block(0, size[0], [&](const D* x) { return end_rows(*problem, x, true, axial, out); });
    for (int j = 0; j + 1 < n; ++j) {
      const int right = at + size[j], a = size[j], b = size[j + 1];
      block(right, a + b, [&](const D* x) {
        if (pattern[j + 1]) return touch_down(*problem, x, x + a, out);
        if (pattern[j]) return lift_off(*problem, x, x + a, out);
        return point(*problem, x, x + a, places[j], out);
      });
      at += 2 * a;
    }
    block(at + size[n - 1], size[n - 1], [&](const D* x) { return end_rows(*problem, x, false, axial, out); });
  };
  return {ends / 2, evaluate};
}

}  // namespace tendril::continuation
