#pragma once
// Eight numbers side by side, for evaluating one formula at several places at once: each arithmetic operation acts on
// all lanes. Fixed width, so results do not depend on the machine's vector units beyond the rounding of fused
// operations.

#include <array>
#include <cmath>
#include <cstring>

namespace tendril::numerics {

struct alignas(64) Pack {
  static constexpr int lanes = 8;
#if defined(__GNUC__)
  typedef double Lanes __attribute__((vector_size(lanes * sizeof(double))));
#else
  using Lanes = std::array<double, lanes>;
#endif
  Lanes x;  // not initialised by default, as a double is not

  Pack() = default;
  Pack(double value) {  // NOLINT: a number is the same in all lanes
    for (int i = 0; i < lanes; ++i) x[i] = value;
  }
  double operator[](int lane) const { return x[lane]; }
  void set(int lane, double value) { x[lane] = value; }
  static Pack load(const double* from) {
    Pack r;
    std::memcpy(&r.x, from, sizeof r.x);
    return r;
  }
  void store(double* to) const { std::memcpy(to, &x, sizeof x); }
  double largest() const {
    double m = x[0];
    for (int i = 1; i < lanes; ++i) m = x[i] > m ? x[i] : m;
    return m;
  }
  double sum() const { return ((x[0] + x[4]) + (x[2] + x[6])) + ((x[1] + x[5]) + (x[3] + x[7])); }

#if defined(__GNUC__)
#define TENDRIL_PACK_OPERATOR(op)                         \
  friend Pack operator op(const Pack& a, const Pack& b) { \
    Pack r;                                               \
    r.x = a.x op b.x;                                     \
    return r;                                             \
  }
#else
#define TENDRIL_PACK_OPERATOR(op)                              \
  friend Pack operator op(const Pack& a, const Pack& b) {      \
    Pack r;                                                    \
    for (int i = 0; i < lanes; ++i) r.x[i] = a.x[i] op b.x[i]; \
    return r;                                                  \
  }
#endif
  TENDRIL_PACK_OPERATOR(+)
  TENDRIL_PACK_OPERATOR(-)
  TENDRIL_PACK_OPERATOR(*)
  TENDRIL_PACK_OPERATOR(/)
#undef TENDRIL_PACK_OPERATOR
  friend Pack operator-(const Pack& a) { return Pack(0.0) - a; }
  Pack& operator+=(const Pack& b) { return *this = *this + b; }
  Pack& operator-=(const Pack& b) { return *this = *this - b; }
  Pack& operator*=(const Pack& b) { return *this = *this * b; }
};

inline Pack larger(const Pack& a, const Pack& b) {
  Pack r;
  for (int i = 0; i < Pack::lanes; ++i) r.x[i] = a.x[i] > b.x[i] ? a.x[i] : b.x[i];
  return r;
}
inline Pack magnitude(const Pack& a) { return larger(a, -a); }
inline Pack sqrt(const Pack& a) {
  Pack r;
  for (int i = 0; i < Pack::lanes; ++i) r.x[i] = std::sqrt(a.x[i]);
  return r;
}
inline Pack sin(const Pack& a) {
  Pack r;
  for (int i = 0; i < Pack::lanes; ++i) r.x[i] = std::sin(a.x[i]);
  return r;
}
inline Pack cos(const Pack& a) {
  Pack r;
  for (int i = 0; i < Pack::lanes; ++i) r.x[i] = std::cos(a.x[i]);
  return r;
}

}  // namespace tendril::numerics
