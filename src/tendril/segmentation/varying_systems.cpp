#include "tendril/segmentation/varying_systems.hpp"

#include <algorithm>
#include <limits>

#include "tendril/formulation/varying_jacobians.hpp"
#include "tendril/numerics/target.hpp"
#include "tendril/segmentation/scaled_problem.hpp"

namespace tendril::segmentation {
namespace {

using formulation::Fields;
using formulation::LineContact;
using formulation::VaryingFree;
using formulation::VaryingLine;
using numerics::Pack;
using rod::SectionPiece;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// What tells the two forms apart, by overload: their equations, and which of the inputs are F3 and s.
template <class R>
void balance(VaryingFree, const SectionPiece& law, bool curved, const Fields<R>& s, const R* u, R* out) {
  formulation::varying_free_residual<R>(law, curved, s, u, out);
}
template <class R>
void balance(VaryingLine, const SectionPiece& law, bool curved, const Fields<R>& s, const R* u, R* out) {
  formulation::varying_line_residual<R>(law, curved, s, u, out);
}
template <class R>
void balance(VaryingFree, const SectionPiece& law, bool curved, const Fields<R>& s, const R* u, R* out, R* jac) {
  formulation::varying_free_jacobian<R>(law, curved, s, u, out, jac);
}
template <class R>
void balance(VaryingLine, const SectionPiece& law, bool curved, const Fields<R>& s, const R* u, R* out, R* jac) {
  formulation::varying_line_jacobian<R>(law, curved, s, u, out, jac);
}

template <class Form>
TENDRIL_WIDE void wide_residuals(const SectionPiece& law, bool curved, const Fields<Pack>& s, const Pack* u,
                                 Pack* out) {
  balance<Pack>(Form(), law, curved, s, u, out);
}
template <class Form>
TENDRIL_WIDE void wide_jacobians(const SectionPiece& law, bool curved, const Fields<Pack>& s, const Pack* u, Pack* out,
                                 Pack* jac) {
  balance<Pack>(Form(), law, curved, s, u, out, jac);
}

/// Stiffnesses and stretch stay positive (a law may turn negative beyond the breaks it is for).
bool valid_section(const SectionPiece& law, double s, double F3) {
  const auto p = law.at<double>(s);
  return p.B > 0.0 && p.C > 0.0 && p.e >= 0.0 && 1.0 + p.e * F3 > 0.0;
}
/// `in(k)`: input k; a free rod also stays this side of the axis' centre of curvature.
template <class In>
bool valid(VaryingFree, const SectionPiece& law, double U1, double U2, const In& in) {
  return 1.0 - in(0) * U2 + in(4) * U1 > 0.0 && valid_section(law, in(17), in(15));
}
template <class In>
bool valid(VaryingLine, const SectionPiece& law, double, double, const In& in) {
  return valid_section(law, in(11), in(9));
}

}  // namespace

template <class Form>
VaryingSystem<Form>::VaryingSystem(const ScaledProblem* problem, int piece) : problem_(problem), piece_(piece) {
  order.assign(Form::order.begin(), Form::order.end());
  first.assign(Form::first.begin(), Form::first.end());
  quadratures = 0;
  inputs = Form::inputs;
}

template <class Form>
void VaryingSystem<Form>::residual(double S, const double* u, double* out) const {
  const auto s = problem_->section(S);
  const SectionPiece& law = problem_->law.pieces[piece_];
  balance<double>(Form(), law, problem_->curved, s, u, out);
  if (!valid(Form(), law, s.U[0][0], s.U[0][1], [&](int k) { return u[k]; })) std::fill_n(out, Form::components, nan);
}

template <class Form>
void VaryingSystem<Form>::jacobian(double S, const double* u, double* out, double* jac) const {
  const auto s = problem_->section(S);
  const SectionPiece& law = problem_->law.pieces[piece_];
  balance<double>(Form(), law, problem_->curved, s, u, out, jac);
  if (!valid(Form(), law, s.U[0][0], s.U[0][1], [&](int k) { return u[k]; })) std::fill_n(out, Form::components, nan);
}

namespace {

template <class Form>
void forbid_invalid(const SectionPiece& law, const Fields<Pack>& s, int count, const Pack* u, Pack* out) {
  for (int i = 0; i < count; ++i) {
    if (valid(Form(), law, s.U[0][0][i], s.U[0][1][i], [&](int k) { return u[k][i]; })) continue;
    for (int e = 0; e < Form::components; ++e) out[e].set(i, nan);
  }
}

}  // namespace

template <class Form>
void VaryingSystem<Form>::residuals(const double* S, int count, const Pack* u, Pack* out) const {
  if (!numerics::wide_units()) return System::residuals(S, count, u, out);
  const Fields<Pack>& s = problem_->fields(S, count);
  const SectionPiece& law = problem_->law.pieces[piece_];
  wide_residuals<Form>(law, problem_->curved, s, u, out);
  forbid_invalid<Form>(law, s, count, u, out);
}

template <class Form>
void VaryingSystem<Form>::jacobians(const double* S, int count, const Pack* u, Pack* out, Pack* jac) const {
  if (!numerics::wide_units()) return System::jacobians(S, count, u, out, jac);
  const Fields<Pack>& s = problem_->fields(S, count);
  const SectionPiece& law = problem_->law.pieces[piece_];
  wide_jacobians<Form>(law, problem_->curved, s, u, out, jac);
  forbid_invalid<Form>(law, s, count, u, out);
}

template class VaryingSystem<VaryingFree>;
template class VaryingSystem<VaryingLine>;

}  // namespace tendril::segmentation
