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

TENDRIL_WIDE void free_jacobians(const SectionPiece& law, bool curved, const Fields<Pack>& s, const Pack* u, Pack* out,
                                 Pack* jac) {
  formulation::varying_free_jacobian<Pack>(law, curved, s, u, out, jac);
}
TENDRIL_WIDE void free_residuals(const SectionPiece& law, bool curved, const Fields<Pack>& s, const Pack* u,
                                 Pack* out) {
  formulation::varying_free_residual<Pack>(law, curved, s, u, out);
}
TENDRIL_WIDE void line_jacobians(const SectionPiece& law, bool curved, const Fields<Pack>& s, const Pack* u, Pack* out,
                                 Pack* jac) {
  formulation::varying_line_jacobian<Pack>(law, curved, s, u, out, jac);
}
TENDRIL_WIDE void line_residuals(const SectionPiece& law, bool curved, const Fields<Pack>& s, const Pack* u,
                                 Pack* out) {
  formulation::varying_line_residual<Pack>(law, curved, s, u, out);
}

/// Stiffnesses and stretch stay positive (a law may turn negative beyond the breaks it is for).
bool valid_section(const SectionPiece& law, double s, double F3) {
  const auto p = law.at<double>(s);
  return p.B > 0.0 && p.C > 0.0 && p.e >= 0.0 && 1.0 + p.e * F3 > 0.0;
}
bool valid_free(const SectionPiece& law, double U1, double U2, double d1, double d2, double F3, double s) {
  return 1.0 - d1 * U2 + d2 * U1 > 0.0 && valid_section(law, s, F3);
}
void forbid(Pack* out, int equations, int lane) {
  for (int e = 0; e < equations; ++e) out[e].set(lane, nan);
}

template <class F>
void describe(collocation::System& s) {
  s.order.assign(F::order.begin(), F::order.end());
  s.first.assign(F::first.begin(), F::first.end());
  s.quadratures = 0;
  s.inputs = F::inputs;
}

}  // namespace

VaryingFreeSystem::VaryingFreeSystem(const ScaledProblem* problem, int piece) : problem_(problem), piece_(piece) {
  describe<VaryingFree>(*this);
}

void VaryingFreeSystem::residual(double S, const double* u, double* out) const {
  const auto s = problem_->section(S);
  const SectionPiece& law = problem_->law.pieces[piece_];
  formulation::varying_free_residual<double>(law, problem_->curved, s, u, out);
  if (!valid_free(law, s.U[0][0], s.U[0][1], u[0], u[4], u[15], u[17])) std::fill_n(out, VaryingFree::components, nan);
}

void VaryingFreeSystem::jacobian(double S, const double* u, double* out, double* jac) const {
  const auto s = problem_->section(S);
  const SectionPiece& law = problem_->law.pieces[piece_];
  formulation::varying_free_jacobian<double>(law, problem_->curved, s, u, out, jac);
  if (!valid_free(law, s.U[0][0], s.U[0][1], u[0], u[4], u[15], u[17])) std::fill_n(out, VaryingFree::components, nan);
}

void VaryingFreeSystem::residuals(const double* S, int count, const Pack* u, Pack* out) const {
  if (!numerics::wide_units()) return System::residuals(S, count, u, out);
  const Fields<Pack>& s = problem_->fields(S, count);
  const SectionPiece& law = problem_->law.pieces[piece_];
  free_residuals(law, problem_->curved, s, u, out);
  for (int i = 0; i < count; ++i)
    if (!valid_free(law, s.U[0][0][i], s.U[0][1][i], u[0][i], u[4][i], u[15][i], u[17][i]))
      forbid(out, VaryingFree::components, i);
}

void VaryingFreeSystem::jacobians(const double* S, int count, const Pack* u, Pack* out, Pack* jac) const {
  if (!numerics::wide_units()) return System::jacobians(S, count, u, out, jac);
  const Fields<Pack>& s = problem_->fields(S, count);
  const SectionPiece& law = problem_->law.pieces[piece_];
  free_jacobians(law, problem_->curved, s, u, out, jac);
  for (int i = 0; i < count; ++i)
    if (!valid_free(law, s.U[0][0][i], s.U[0][1][i], u[0][i], u[4][i], u[15][i], u[17][i]))
      forbid(out, VaryingFree::components, i);
}

VaryingLineSystem::VaryingLineSystem(const ScaledProblem* problem, int piece) : problem_(problem), piece_(piece) {
  describe<VaryingLine>(*this);
}

void VaryingLineSystem::residual(double S, const double* u, double* out) const {
  const SectionPiece& law = problem_->law.pieces[piece_];
  formulation::varying_line_residual<double>(law, problem_->curved, problem_->section(S), u, out);
  if (!valid_section(law, u[11], u[9])) std::fill_n(out, VaryingLine::components, nan);
}

void VaryingLineSystem::jacobian(double S, const double* u, double* out, double* jac) const {
  const SectionPiece& law = problem_->law.pieces[piece_];
  formulation::varying_line_jacobian<double>(law, problem_->curved, problem_->section(S), u, out, jac);
  if (!valid_section(law, u[11], u[9])) std::fill_n(out, VaryingLine::components, nan);
}

void VaryingLineSystem::residuals(const double* S, int count, const Pack* u, Pack* out) const {
  if (!numerics::wide_units()) return System::residuals(S, count, u, out);
  const SectionPiece& law = problem_->law.pieces[piece_];
  line_residuals(law, problem_->curved, problem_->fields(S, count), u, out);
  for (int i = 0; i < count; ++i)
    if (!valid_section(law, u[11][i], u[9][i])) forbid(out, VaryingLine::components, i);
}

void VaryingLineSystem::jacobians(const double* S, int count, const Pack* u, Pack* out, Pack* jac) const {
  if (!numerics::wide_units()) return System::jacobians(S, count, u, out, jac);
  const SectionPiece& law = problem_->law.pieces[piece_];
  line_jacobians(law, problem_->curved, problem_->fields(S, count), u, out, jac);
  for (int i = 0; i < count; ++i)
    if (!valid_section(law, u[11][i], u[9][i])) forbid(out, VaryingLine::components, i);
}

}  // namespace tendril::segmentation
