#pragma once
// Three components over any scalar (double, dual, jet): the components of a vector in some frame. Deliberately tiny, so
// that derivative-carrying scalars pass through without expression templates.

#include <array>

namespace tendril::numerics {

template <class T>
using V3 = std::array<T, 3>;

template <class T>
V3<T> operator+(const V3<T>& a, const V3<T>& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
template <class T>
V3<T> operator-(const V3<T>& a, const V3<T>& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
template <class T>
V3<T> operator*(const T& f, const V3<T>& a) {
  return {f * a[0], f * a[1], f * a[2]};
}
template <class T>
T dot(const V3<T>& a, const V3<T>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <class T>
V3<T> cross(const V3<T>& a, const V3<T>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

}  // namespace tendril::numerics
