#pragma once
// Three components of any scalar type (double, dual numbers), with the few operations surface formulas need. Eigen is
// avoided here because it wants traits for every scalar type.

#include <array>

namespace tendril::geometry {

template <class T>
struct Triple {
  std::array<T, 3> c;

  T& operator[](int i) { return c[i]; }
  const T& operator[](int i) const { return c[i]; }

  friend Triple operator+(const Triple& a, const Triple& b) { return {{a[0] + b[0], a[1] + b[1], a[2] + b[2]}}; }
  friend Triple operator-(const Triple& a, const Triple& b) { return {{a[0] - b[0], a[1] - b[1], a[2] - b[2]}}; }
  friend Triple operator-(const Triple& a) { return {{-a[0], -a[1], -a[2]}}; }
  friend Triple operator*(const T& s, const Triple& a) { return {{s * a[0], s * a[1], s * a[2]}}; }
};

template <class T>
T dot(const Triple<T>& a, const Triple<T>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <class T>
Triple<T> cross(const Triple<T>& a, const Triple<T>& b) {
  return {{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
}

}  // namespace tendril::geometry
