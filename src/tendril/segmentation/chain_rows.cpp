// End and junction conditions of the chain, with exact derivatives. State layouts: free δ1 δ1' δ1'' δ2 δ2' δ2'' φ φ' F1
// F2 F3 s (12), in wall coordinates β β' β'' n n' n'' for the first six; line contact β β' β'' ψ ψ' F_g F3 s (8).
#include <algorithm>
#include <cmath>

#include "tendril/formulation/convert.hpp"
#include "tendril/formulation/near_wall.hpp"
#include "tendril/segmentation/chain.hpp"
#include "tendril/segmentation/end_state.hpp"
#include "tendril/segmentation/in_plane.hpp"
#include "tendril/segmentation/tip.hpp"

namespace tendril::segmentation {
namespace {

using formulation::FreeRod;
using formulation::LineContact;
using formulation::Section;
using numerics::dot;
using numerics::Dual;

constexpr int free_states = 12, line_states = 8;

/// H = ½(M1² + M2²) + F3 + ½ η² F3²: minus the push on the straight rod outside a frictionless sleeve.
template <class T>
T configurational(const auto& eta2, const T& bending2, const T& F3) {
  return 0.5 * bending2 + F3 + 0.5 * eta2 * (F3 * F3);
}

template <int N>
void store_row(const Dual<N>& f, const int* place, int width, double* r, double* values, int row) {
  r[row] = f.v;
  for (int i = 0; i < N; ++i)
    if (place[i] >= 0) values[row * width + place[i]] += f.d[i];
}

/// The material at an end: of a varying rod it depends on the state s there.
template <bool varies, class T>
auto material(const ScaledProblem& P, int law, const T& s) {
  if constexpr (varies)
    return formulation::LocalMaterial<T>(P.law.pieces[law], P.curved, s);
  else
    return P.material;
}

// Columns: states of the end, S of the end, p. Rows: as many as the end needs.
template <bool varies>
int end_rows(const ScaledProblem& P, bool left, bool line, bool rests, int law, const double* z, double S, double* r,
             double* values) {
  if (!left && P.tip_free()) return free_tip_rows(P, line, rests, law, z, S, r, values);
  const int ns = line ? line_states : free_states, width = ns + 2;
  const auto& e = left ? P.start : P.end;
  const bool twist_here = (P.source.twist_at == Which::start) == left;
  const bool axial_here =
      P.source.axial == AxialControl::rod_length ? !left : (P.source.axial_at == Which::start) == left;
  constexpr int most = varies ? 12 : 11;
  using T = Dual<most + 2>;  // 11 states (7 of a line contact), of a varying rod s as well, S, p
  const int dense = (line ? 7 : 11) + (varies ? 1 : 0);
  int place[most + 2];
  for (int i = 0; i < most + 2; ++i) place[i] = -1;
  T x[12];
  for (int i = 0; i < dense; ++i) {
    x[i] = T::seed(z[i], i);
    place[i] = i;
  }
  const T dS = T::seed(0.0, most), dp = T::seed(0.0, most + 1);
  place[most] = ns;
  place[most + 1] = ns + 1;
  const Section sec = P.section(S);
  const auto l = formulation::lift<T>(sec, dS, dp);
  const auto m = material<varies, T>(P, law, x[ns - 1]);
  auto now = [&](const Scalar& s) { return T(P.now(s)) + s.rate * dp; };
  int n = 0;
  auto row = [&](const T& f) { store_row(f, place, width, r, values, n++); };
  int out_of_plane[3] = {line ? 0 : 1, line ? 1 : 3, 0};  // β and β', or what holds δ2; the twist
  T M3, phi, F3, bending2;
  if (line) {
    const T e1 = now(e.eccentricity[0]), e2 = now(e.eccentricity[1]), s1 = now(e.slope[0]), s2 = now(e.slope[1]);
    const auto Q = formulation::lift_clearance<T>(sec, dS, dp);
    if (e.kind == End::Kind::guided) {
      row(x[5]);  // F_g = 0
      row(x[1]);
    } else {
      row(wrapped(x[0] - atan2(e2, e1)));
      row(x[1] - (e1 * s2 - e2 * s1) / (e1 * e1 + e2 * e2));
    }
    const auto c = LineContact::curve<T>(l, Q, x[0], x[1], x[2]);
    M3 = LineContact::twisting_moment<T>(m, c, x[6], x[4]);
    F3 = x[6];
    const T alpha = 1.0 + m.eta2 * F3;
    bending2 = alpha * alpha * (c.kn * c.kn + c.kg * c.kg);
    if constexpr (varies) bending2 = m.B * bending2;
    const T cb = cos(x[0]), sb = sin(x[0]);
    const T d1 = Q[0] * cb, d2 = Q[0] * sb;
    const T d1p = Q[1] * cb - x[1] * d2, d2p = Q[1] * sb + x[1] * d1;
    const auto k = FreeRod::kinematics<T>(l, d1, d1p, T(0.0), d2, d2p, T(0.0));
    const auto nb = formulation::touch_basis<T>(k, cb, sb, Q[1]);
    phi = x[3] - formulation::darboux_angle(nb, x[0]);
  } else {
    const FreeEnd<T> f(m, l, x);
    if (e.kind == End::Kind::guided) {
      n = free_tip_rows(P, false, rests, law, z, S, r, values);
    } else {
      row(x[0] - now(e.eccentricity[0]));
      row(x[3] - now(e.eccentricity[1]));
      if (e.kind == End::Kind::pinned) {
        if constexpr (varies) {
          for (const T& M : bending_moments<T>(m, f, x[6])) row(M);
        } else {
          row(f.w1);
          row(f.w2);
        }
      } else {
        row(x[1] - now(e.slope[0]));
        row(x[4] - now(e.slope[1]));
      }
    }
    M3 = f.M3;
    phi = x[6];
    F3 = x[10];
    bending2 = f.w1 * f.w1 + f.w2 * f.w2;
    if constexpr (varies) bending2 = m.B * bending2;
  }
  out_of_plane[2] = n;
  if (!twist_here)
    row(phi - now(e.roll));
  else if (P.source.twist == TwistControl::torque)
    row(M3 - now(P.twist));
  else
    row(phi - now(P.twist));
  const int s_column = ns - 1;
  auto s_row = [&](double value, double rate) {
    r[n] = z[s_column] - value;
    values[n * width + s_column] = 1.0;
    values[n * width + ns + 1] = -rate;
    ++n;
  };
  const bool from_end = varies && P.law.from_end;  // then s = 0 at the far end
  if (from_end ? !left : left) s_row(from_end ? 0.0 : P.start_s, 0.0);
  if (from_end && left && P.source.axial == AxialControl::rod_length) s_row(-P.now(P.axial), -P.axial.rate);
  if (axial_here) {
    if (P.source.axial == AxialControl::rod_length) {
      if (!from_end) s_row(P.now(P.axial), P.axial.rate);
    } else if (P.source.axial == AxialControl::axial_force)
      row(F3 - now(P.axial));
    else
      row(configurational<T>(m.eta2, bending2, F3) + now(P.axial));  // push = -H
  }
  // place of the end
  r[n] = left ? S - P.start_position : S - P.now(P.end_position);
  values[n * width + ns] = 1.0;
  values[n * width + ns + 1] = left ? 0.0 : -P.end_position.rate;
  ++n;
  if (P.planar) {
    if (e.kind == End::Kind::pinned) out_of_plane[1] = 2;  // M1 = 0
    if (e.kind == End::Kind::guided) out_of_plane[0] = 1;  // F2 = 0, δ2' = 0
    keep_end_in_plane(line, left, out_of_plane, z, r, values, width);
  }
  return n;
}

}  // namespace

int Chain::left_rows(double* r, double* values) const {
  const auto& s = segment_.front();
  const auto rows = mechanics_->problem.varies() ? end_rows<true> : end_rows<false>;
  return rows(mechanics_->problem, true, is_line(0), false, s.law(0), s.state(0), S_.front(), r, values);
}

int Chain::right_rows(double* r, double* values) const {
  const auto& s = segment_.back();
  const auto rows = mechanics_->problem.varies() ? end_rows<true> : end_rows<false>;
  return rows(mechanics_->problem, false, is_line(segments() - 1), tip_, s.law(s.parts() - 1), s.state(s.pieces()),
              S_.back(), r, values);
}

int Chain::junction_rows(int j, double* r, double* values) const {
  const ScaledProblem& P = mechanics_->problem;
  const bool left_line = is_line(j), right_line = is_line(j + 1);
  const double* zl = segment_[j].state(segment_[j].pieces());
  const double* zr = segment_[j + 1].state(0);
  const int nl = segment_[j].states(), nr = segment_[j + 1].states(), width = nl + nr + 2;
  const Section sec = P.section(S_[j + 1]);
  int n = 0;
  if (near_wall(j) || near_wall(j + 1)) {
    if (!left_line && !right_line) return point_rows_near_wall(j, r, values);
  }
  if (!left_line && !right_line) {  // point contact
    using T = Dual<15>;             // 11 left states, F1 and F2 on the right, S, p
    T x[11];
    int place[15];
    for (int i = 0; i < 11; ++i) {
      x[i] = T::seed(zl[i], i);
      place[i] = i;
    }
    const T F1 = T::seed(zr[8], 11), F2 = T::seed(zr[9], 12), dS = T::seed(0.0, 13), dp = T::seed(0.0, 14);
    place[11] = nl + 8;
    place[12] = nl + 9;
    place[13] = nl + nr;
    place[14] = nl + nr + 1;
    const auto l = formulation::lift<T>(sec, dS, dp);
    const auto Q = formulation::lift_clearance<T>(sec, dS, dp);
    const FreeEnd<T> f(P.material, l, x);
    auto row = [&](const T& g) { store_row(g, place, width, r, values, n++); };
    const T radius = sqrt(x[0] * x[0] + x[3] * x[3]);
    row(radius - Q[0]);  // (IV.1.10)
    if (held(j))
      row(T(S_[j + 1] - held_[j]) + dS);
    else
      row((x[0] * x[1] + x[3] * x[4]) / radius - Q[1]);  // (IV.1.11)
    const auto nb = formulation::touch_basis<T>(f.k, x[0] / radius, x[3] / radius, Q[1]);
    row((F1 - x[8]) * nb.n2 - (F2 - x[9]) * nb.n1);   // ⟦F_g⟧ = 0
    for (int q : {0, 1, 2, 3, 4, 5, 6, 7, 10, 11}) {  // δ to δ'', φ, φ', F3, s continuous
      r[n] = zr[q] - zl[q];
      values[n * width + nl + q] = 1.0;
      values[n * width + q] = -1.0;
      ++n;
    }
    if (P.planar) keep_junction_in_plane(false, false, {2, 6, 7, 8, 9, 10}, zl, zr, r, values);
    return n;
  }
  // end of a line contact: one side free (x), the other on the wall (y)
  using T = Dual<20>;
  const double* zf = left_line ? zr : zl;
  const double* zc = left_line ? zl : zr;
  const int f0 = left_line ? nl : 0, c0 = left_line ? 0 : nl;
  T x[11], y[7];
  int place[20];
  for (int i = 0; i < 11; ++i) {
    x[i] = T::seed(zf[i], i);
    place[i] = f0 + i;
  }
  for (int i = 0; i < 7; ++i) {
    y[i] = T::seed(zc[i], 11 + i);
    place[11 + i] = c0 + i;
  }
  const T dS = T::seed(0.0, 18), dp = T::seed(0.0, 19);
  place[18] = nl + nr;
  place[19] = nl + nr + 1;
  const auto l = formulation::lift<T>(sec, dS, dp);
  const auto Q = formulation::lift_clearance<T>(sec, dS, dp);
  // the same section on both sides: how the material varies with s enters no derivative where the moments agree
  const formulation::Material material = material_behind(j);
  const bool near = near_wall(left_line ? j + 1 : j);
  T z[11];  // the free side in δ1, δ2
  std::copy_n(x, 11, z);
  if (near) formulation::NearWall::eccentricity<3, T>(Q, x, x + 3, z, z + 3);
  const FreeEnd<T> f(material, l, z);
  const auto c = LineContact::curve<T>(l, Q, y[0], y[1], y[2]);
  auto row = [&](const T& g) { store_row(g, place, width, r, values, n++); };
  const T cb = cos(y[0]), sb = sin(y[0]);
  const T& bp = y[1];
  T tangent;  // the condition that places the junction
  // δ = Q e, δ' = (Q e)', δ'' = (Q e)''  (the last equivalent to ⟦κ_n⟧ = ⟦κ_g⟧ = 0, the stretch being continuous)
  if (near) {
    row(wrapped(x[0] - y[0]));
    row(x[3]);
    row(x[1] - y[1]);
    row(x[4]);
    row(x[2] - y[2]);
    tangent = x[5];
  } else {
    row(x[0] - Q[0] * cb);
    row(x[3] - Q[0] * sb);
    row(x[1] - (Q[1] * cb - Q[0] * bp * sb));
    row(x[4] - (Q[1] * sb + Q[0] * bp * cb));
    const T radial = Q[2] - Q[0] * bp * bp, around = 2.0 * Q[1] * bp + Q[0] * y[2];
    const T c1 = x[2] - (radial * cb - around * sb), c2 = x[5] - (radial * sb + around * cb);
    row(cb * c2 - sb * c1);
    tangent = cb * c1 + sb * c2;
  }
  row(held(j) ? T(S_[j + 1] - held_[j]) + dS : tangent);
  const auto nb = formulation::touch_basis<T>(f.k, cb, sb, Q[1]);
  row(y[3] - x[6] - formulation::darboux_angle(nb, y[0]));               // (IV.1.13-14)
  row(f.M3 - LineContact::twisting_moment<T>(material, c, y[6], y[4]));  // ⟦M3⟧ = 0
  row(x[10] - y[6]);                                                     // ⟦F3⟧ = 0
  row(x[8] * nb.n2 - x[9] * nb.n1 - y[5]);                               // ⟦F_g⟧ = 0
  r[n] = zf[11] - zc[7];
  values[n * width + f0 + 11] = 1.0;
  values[n * width + c0 + 7] = -1.0;
  ++n;
  if (P.planar) keep_junction_in_plane(left_line, right_line, {1, 3, 4, 6, 7, 9}, zl, zr, r, values);
  return n;
}

// A point contact with a side in wall coordinates: n = n' = 0 there, exactly.
int Chain::point_rows_near_wall(int j, double* r, double* values) const {
  const ScaledProblem& P = mechanics_->problem;
  const double *zl = segment_[j].state(segment_[j].pieces()), *zr = segment_[j + 1].state(0);
  constexpr int nl = free_states, width = 2 * free_states + 2;
  using T = Dual<21>;  // 11 left states, δ and F1, F2 on the right, S, p
  T x[11], y[6];
  int place[21];
  for (int i = 0; i < 11; ++i) {
    x[i] = T::seed(zl[i], i);
    place[i] = i;
  }
  for (int i = 0; i < 6; ++i) {
    y[i] = T::seed(zr[i], 11 + i);
    place[11 + i] = nl + i;
  }
  const T F1 = T::seed(zr[8], 17), F2 = T::seed(zr[9], 18), dS = T::seed(0.0, 19), dp = T::seed(0.0, 20);
  place[17] = nl + 8;
  place[18] = nl + 9;
  place[19] = nl + free_states;
  place[20] = nl + free_states + 1;
  const Section sec = P.section(S_[j + 1]);
  const auto l = formulation::lift<T>(sec, dS, dp);
  const auto Q = formulation::lift_clearance<T>(sec, dS, dp);
  const bool left = near_wall(j), right = near_wall(j + 1);
  T a[11], b[6];  // both sides in δ1, δ2
  std::copy_n(x, 11, a);
  std::copy_n(y, 6, b);
  if (left) formulation::NearWall::eccentricity<3, T>(Q, x, x + 3, a, a + 3);
  if (right) formulation::NearWall::eccentricity<3, T>(Q, y, y + 3, b, b + 3);
  int n = 0;
  auto row = [&](const T& g) { store_row(g, place, width, r, values, n++); };
  const T* wall = left ? x : y;
  row(wall[3]);                                           // (IV.1.10)
  row(held(j) ? T(S_[j + 1] - held_[j]) + dS : wall[4]);  // (IV.1.11)
  const FreeEnd<T> f(P.material, l, a);
  const T radius = sqrt(a[0] * a[0] + a[3] * a[3]);
  const auto nb = formulation::touch_basis<T>(f.k, a[0] / radius, a[3] / radius, Q[1]);
  row((F1 - x[8]) * nb.n2 - (F2 - x[9]) * nb.n1);  // ⟦F_g⟧ = 0
  for (int q = 0; q < 6; ++q) {                    // δ to δ'' continuous
    if (left && right)
      row(q == 0 ? wrapped(y[q] - x[q]) : y[q] - x[q]);
    else
      row(b[q] - a[q]);
  }
  for (int q : {6, 7, 10, 11}) {  // φ, φ', F3, s continuous
    r[n] = zr[q] - zl[q];
    values[n * width + nl + q] = 1.0;
    values[n * width + q] = -1.0;
    ++n;
  }
  return n;
}

formulation::Material Chain::material_behind(int junction) const {
  const ScaledProblem& P = mechanics_->problem;
  if (!P.varies()) return P.material;
  const CutSegment& s = segment_[junction + 1];
  const auto p = P.law.pieces[s.law(0)].at<double>(s.state(0)[s.states() - 1]);
  return {p.e, 1.0 / p.C - 1.0, p.B, {p.k1, p.k2}};
}

// A cut of a free segment or a line contact: place, directors, moments and forces go on; the curvature need not. On a
// wall the moment about g follows the wall's curvature: where it cannot go on there is no line contact (V.17). A point
// load P, C makes F and M jump by -P, -C (P.1); at a collar that touches, F jumps along the wall's normal (C.1).
int Chain::cut_rows(int j, int q, double* r, double* values) const {
  const ScaledProblem& P = mechanics_->problem;
  const CutSegment& s = segment_[j];
  const bool line = is_line(j);
  const int ns = s.states(), width = 2 * ns + 2;
  const double *zl = s.part(q).state(s.part(q).pieces()), *zr = s.part(q + 1).state(0);
  const double S = s.cut(q).S;
  const Section sec = P.section(S);
  using T = Dual<2 * free_states + 2>;
  T x[free_states], y[free_states];
  int place[2 * free_states + 2];
  for (int& i : place) i = -1;
  for (int i = 0; i < ns; ++i) {
    x[i] = T::seed(zl[i], i);
    y[i] = T::seed(zr[i], ns + i);
    place[i] = i;
    place[ns + i] = ns + i;
  }
  const T dS = T::seed(0.0, 2 * ns), dp = T::seed(0.0, 2 * ns + 1);
  place[2 * ns] = 2 * ns;
  place[2 * ns + 1] = 2 * ns + 1;
  const auto l = formulation::lift<T>(sec, dS, dp);
  const formulation::LocalMaterial<T> before(P.law.pieces[s.law(q)], P.curved, x[ns - 1]),
      behind(P.law.pieces[s.law(q + 1)], P.curved, y[ns - 1]);
  int n = 0;
  auto row = [&](const T& g) { store_row(g, place, width, r, values, n++); };
  const Cut& cut = s.cut(q);
  const auto given = [&](const Eigen::Vector3d& v) {  // a world-fixed vector in D
    const auto c = in_frame(sec, v);
    const auto rate = numerics::cross(c, sec.U[0]);
    formulation::V3<T> out;
    const Scalar& scale = P.source.point_load_scale;
    for (int i = 0; i < 3; ++i) out[i] = P.now(scale) * (T(c[i]) + rate[i] * dS) + (scale.rate * c[i]) * dp;
    return out;
  };
  formulation::V3<T> load{T(0.0), T(0.0), T(0.0)}, couple = load;
  if (cut.load >= 0) {
    load = given(P.point_loads[cut.load].force);
    couple = given(P.point_loads[cut.load].couple);
  }
  if (line) {
    const auto Q = formulation::lift_clearance<T>(sec, dS, dp);
    const auto moments = [&](const formulation::LocalMaterial<T>& m, const T* z) {  // M·N and M3
      const auto c = LineContact::curve<T>(l, Q, z[0], z[1], z[2]);
      T MN = (1.0 + m.eta2 * z[6]) * c.kg;
      if (m.curved) MN = MN - (m.k1 * sin(z[3]) + m.k2 * cos(z[3]));
      return std::array<T, 2>{m.B * MN, LineContact::twisting_moment<T>(m, c, z[6], z[4])};
    };
    const auto a = moments(before, x), b = moments(behind, y);
    const auto c = LineContact::curve<T>(l, Q, x[0], x[1], x[2]);  // N, g and d3 are those of both sides
    row(b[0] - a[0] + dot(couple, c.N));
    row(b[1] - a[1] + dot(couple, c.t));
    for (const int i : {0, 1, 3}) row(y[i] - x[i]);
    row(y[5] - x[5] + dot(load, c.gv));
    row(y[6] - x[6] + dot(load, c.t));
    row(y[7] - x[7]);
  } else {
    const FreeEnd<T> f(before, l, x), g(behind, l, y);
    const auto a = bending_moments<T>(before, f, x[6]), b = bending_moments<T>(behind, g, y[6]);
    row(b[0] - a[0] + dot(couple, f.k.k1));
    row(b[1] - a[1] + dot(couple, f.k.k2));
    row(g.M3 - f.M3 + dot(couple, f.k.t));
    for (const int i : {0, 1, 3, 4, 6}) row(y[i] - x[i]);
    if (cut.collar >= 0 && touches(cut.collar)) {
      const auto Q = formulation::lift_clearance<T>(sec, dS, dp);
      formulation::V3<T> jump;  // ⟦F⟧ + P in D: along the wall's normal
      for (int i = 0; i < 3; ++i)
        jump[i] = (y[8] - x[8]) * f.k.k1[i] + (y[9] - x[9]) * f.k.k2[i] + (y[10] - x[10]) * f.k.t[i] + load[i];
      const T radius = sqrt(x[0] * x[0] + x[3] * x[3]), cb = x[0] / radius, sb = x[3] / radius;
      const T C3 = 1.0 - x[0] * l.U[0][1] + x[3] * l.U[0][0];
      row(radius - (Q[0] - P.sign * P.collars[cut.collar].height));
      row(cb * jump[1] - sb * jump[0]);
      row(Q[1] * (cb * jump[0] + sb * jump[1]) + C3 * jump[2]);
    } else {
      row(y[8] - x[8] + dot(load, f.k.k1));
      row(y[9] - x[9] + dot(load, f.k.k2));
      row(y[10] - x[10] + dot(load, f.k.t));
    }
    row(y[11] - x[11]);
  }
  if (cut.placed)
    row(T(S - P.point_loads[cut.load].at) + dS);
  else
    row(y[ns - 1] - cut.s);
  if (P.planar)
    keep_junction_in_plane(line, line, line ? std::array{2, 3, 4, 0, 1, 5} : std::array{5, 6, 7, 0, 2, 9}, zl, zr, r,
                           values);
  return n;
}

int Chain::closure_row(const Closure& c, double* r, double* values) const {
  switch (c.kind) {
    case Closure::Kind::parameter:
      r[0] = p_ - c.value;
      values[0] = 1.0;
      break;
    case Closure::Kind::unknown: {
      double x;
      if (c.index >= state_columns_) {
        const int q = c.index - state_columns_;
        x = q <= segments() ? S_[q] : p_;
      } else {
        x = 0.0;
        each_part([&](int j, int q, const collocation::Segment& s, double a, double) {
          const int at = c.index - first_column_[j][q];
          if (at >= 0 && at < static_cast<int>(s.states_data().size())) x = s.states_data()[at];
          if (q > 0 && at == -1) x = a;
        });
      }
      r[0] = x - c.value;
      values[0] = 1.0;
      break;
    }
    case Closure::Kind::span:
      r[0] = S_[c.index + 1] - S_[c.index] - c.value;
      values[0] = -1.0;
      values[1] = 1.0;
      break;
  }
  return 1;
}

}  // namespace tendril::segmentation
