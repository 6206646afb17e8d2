#pragma once
// Any regular parametric surface S(u, v), known by its partial derivatives up to the fourth order (the third enter the
// shear force of a rod bound to it through κ_n', the fourth the reaction pressure and exact Jacobians). Written down as
// a callable over any scalar; differentiation is automatic. Normal N = S_u x S_v / |S_u x S_v| (III.1.6): the order of
// the parameters chooses the side.

#include <array>
#include <memory>
#include <string>
#include <utility>

#include "tendril/geometry/vec3.hpp"
#include "tendril/numerics/dual.hpp"
#include "tendril/numerics/taylor.hpp"

namespace tendril::geometry {

/// All partial derivatives up to the order D at one point.
template <class T, int D>
struct Patch {
  std::array<Triple<T>, (D + 1) * (D + 2) / 2> partial;
  const Triple<T>& operator()(int i, int j) const { return partial[numerics::Taylor2<D>::at(i, j)]; }
  Triple<T>& operator()(int i, int j) { return partial[numerics::Taylor2<D>::at(i, j)]; }
};

class ParametricSurface {
 public:
  virtual ~ParametricSurface() = default;
  virtual Patch<double, 4> patch(double u, double v) const = 0;
};
using SurfacePtr = std::shared_ptr<const ParametricSurface>;

/// A surface from a callable `Triple<T> f(T u, T v)` for any scalar T (sin, cos, exp, sqrt, pow, + - * /).
template <class F>
class CallableSurface final : public ParametricSurface {
 public:
  explicit CallableSurface(F f) : f_(std::move(f)) {}
  Patch<double, 4> patch(double u, double v) const override {
    using T = numerics::Taylor2<4>;
    const Triple<T> x = f_(T::u(u), T::v(v));
    Patch<double, 4> p;
    for (int n = 0; n <= 4; ++n)
      for (int j = 0; j <= n; ++j)
        for (int k = 0; k < 3; ++k) p(n - j, j)[k] = x[k].derivative(n - j, j);
    return p;
  }

 private:
  F f_;
};
template <class F>
SurfacePtr surface_from(F f) {
  return std::make_shared<CallableSurface<F>>(std::move(f));
}

/// Position, first and second derivatives in the order S, S_u, S_v, S_uu, S_uv, S_vv.
template <class T>
using SecondOrder = std::array<Triple<T>, 6>;

/// A surface from its own first and second derivatives, a callable `SecondOrder<T> f(T u, T v)`; the third and fourth
/// follow from those of the second.
template <class F>
class DifferentiatedSurface final : public ParametricSurface {
 public:
  explicit DifferentiatedSurface(F f) : f_(std::move(f)) {}
  Patch<double, 4> patch(double u, double v) const override {
    using T = numerics::Taylor2<2>;
    const SecondOrder<T> x = f_(T::u(u), T::v(v));
    Patch<double, 4> p;
    for (int n = 0; n <= 4; ++n) {
      for (int j = 0; j <= n; ++j) {
        const int i = n - j;
        // the derivative of S_uu, S_uv or S_vv that is S_(i, j); orders below two are given
        const int dj = n < 2 ? j : i >= 2 ? 0 : i == 1 ? 1 : 2, di = n < 2 ? i : 2 - dj;
        for (int k = 0; k < 3; ++k) p(i, j)[k] = x[T::at(di, dj)][k].derivative(i - di, j - dj);
      }
    }
    return p;
  }

 private:
  F f_;
};
template <class F>
SurfacePtr surface_from_derivatives(F f) {
  return std::make_shared<DifferentiatedSurface<F>>(std::move(f));
}

/// Derivatives up to the third over the scalars u and v, which may carry derivatives of their own.
inline Patch<double, 3> lift(const Patch<double, 4>& p, double, double) {
  Patch<double, 3> r;
  for (std::size_t n = 0; n < r.partial.size(); ++n) r.partial[n] = p.partial[n];
  return r;
}
template <int N>
Patch<numerics::Dual<N>, 3> lift(const Patch<double, 4>& p, const numerics::Dual<N>& u, const numerics::Dual<N>& v) {
  Patch<numerics::Dual<N>, 3> r;
  for (int n = 0; n <= 3; ++n) {
    for (int j = 0; j <= n; ++j) {
      for (int k = 0; k < 3; ++k) {
        numerics::Dual<N>& x = r(n - j, j)[k];
        x.v = p(n - j, j)[k];
        for (int q = 0; q < N; ++q) x.d[q] = p(n - j + 1, j)[k] * u.d[q] + p(n - j, j + 1)[k] * v.d[q];
      }
    }
  }
  return r;
}

/// (III.1.58): latitude u, longitude v; N points to the centre.
SurfacePtr sphere(double radius);
/// Axis e_z: height u, angle v; N points to the axis.
SurfacePtr cylinder(double radius);
/// Axis e_z: angle u about it, polar angle v of the section from the equator; N outward.
SurfacePtr torus(double major, double minor);
/// Semi-axes a, b, c: latitude u, longitude v; N inward.
SurfacePtr ellipsoid(double a, double b, double c);
/// The plane y = 0 with x = u, z = v; N = -e_y.
SurfacePtr vertical_plane();
/// The graph z = f(x, y) of a callable over any scalar, u = x, v = y; N upwards.
template <class F>
SurfacePtr graph(F f) {
  return surface_from([f](const auto& x, const auto& y) {
    using T = std::decay_t<decltype(x)>;
    return Triple<T>{{x, y, f(x, y)}};
  });
}

}  // namespace tendril::geometry
