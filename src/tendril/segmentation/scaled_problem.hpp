#pragma once
// The global problem scaled by the axis length L and the bending stiffness B (II.2.31-35): lengths by L, forces by
// B/L², moments by B/L. One scaling for all elementary problems. Also the two formulations as collocation systems.

#include <memory>
#include <vector>

#include "tendril/collocation/system.hpp"
#include "tendril/formulation/free_rod.hpp"
#include "tendril/formulation/line_contact.hpp"
#include "tendril/numerics/pack.hpp"
#include "tendril/segmentation/problem.hpp"
#include "tendril/segmentation/varying_systems.hpp"

namespace tendril::segmentation {

/// Components in D of a vector of the world.
inline formulation::V3<double> in_frame(const formulation::Section& s, const Eigen::Vector3d& v) {
  formulation::V3<double> c;
  for (int d = 0; d < 3; ++d) c[d] = s.D[d][0] * v[0] + s.D[d][1] * v[1] + s.D[d][2] * v[2];
  return c;
}

struct ScaledProblem {
  /// `parameter` is the value of the path parameter at which the problem's scalars hold.
  explicit ScaledProblem(const Problem& problem, double parameter = 0.0);

  Problem source;
  double L = 1.0, B = 1.0;
  formulation::Material material;
  rod::SectionLaw law;  // of a varying rod, scaled; empty: `material` everywhere
  bool curved = false;  // the unstressed rod is curved somewhere
  // Point loads (times source.point_load_scale) and collars, scaled. A rod that has any is one that varies, with a
  // break of its law at each on it.
  std::vector<rod::PointLoad> point_loads;
  std::vector<rod::Collar> collars;
  struct Mark {
    int collar = -1, load = -1;
  };
  std::vector<Mark> marks;  // what sits where each piece of the law begins
  double sign = 1.0;        // ς
  struct ScaledEnd {
    End::Kind kind;
    Scalar eccentricity[2], slope[2], roll;
    TipLoad tip;
  } start, end;
  double start_position = 0.0, start_s = 0.0;  // S and s of the near end: 0, but for a window cut out of a rod
  Scalar end_position;                         // S of the far end
  double p0 = 0.0, p = 0.0;                    // parameter of the scalars as stored, and now
  Scalar axial, twist;                         // values of the two end conditions
  std::vector<double> knots;                   // ascending, inside (0, end)
  double clearance_max = 0.0;
  bool axisymmetric = false;  // rotating everything about the axis changes nothing
  bool weightless = false;    // no body force, no couple
  bool planar = false;        // asked for, and the plane δ2 = 0 is one of symmetry: what leaves it is held at zero

  /// A scalar at the present parameter: the scalars that carry a rate are linear in p.
  double now(const Scalar& s) const { return s.value + s.rate * (p - p0); }
  formulation::Section section(double S) const;
  /// Distance from the axis at which the centreline stands where a collar touches the wall.
  double collar_clearance(int collar, const formulation::Section& s) const {
    return s.Q[0] - sign * collars[collar].height;
  }
  bool tip_free() const { return end.kind == End::Kind::free; }
  /// The length of the rod is given, the place of its free tip is not.
  bool tip_place_free() const { return tip_free() && source.axial == AxialControl::rod_length; }
  /// Up to eight sections side by side, remembered while the places and p stay; not for several threads at once.
  const formulation::Fields<numerics::Pack>& fields(const double* S, int count) const;
  bool loads_move() const { return source.body_force_scale.rate != 0.0 || source.body_couple_scale.rate != 0.0; }
  bool varies() const { return !law.uniform(); }
  bool marked() const { return !point_loads.empty() || !collars.empty(); }
  /// Material, bending stiffness included, at a state in the free or the line layout (varying: with s and the piece).
  formulation::Material material_at(const double* u, bool line = false) const;
  /// Body force per unit reference length at a free state, the weight of a varying rod included; components in D.
  formulation::V3<double> body_force_at(const formulation::Section& s, const double* u) const;
  /// Normal force, pressure and twisting moment of a line-contact state.
  formulation::LineContact::Wall wall(const formulation::Section& s, const double* line) const;
  void line_to_free(const formulation::Section& s, const double* line, double* free) const;
  void free_to_line(const formulation::Section& s, const double* free, double near, double* line) const;
  /// Moments M1, M2, M3 of a free state with kinematics k, components in k.
  std::array<double, 3> moments(const formulation::FreeRod::Kinematics<double>& k, const double* u) const;
  double force_unit() const { return B / (L * L); }
  double moment_unit() const { return B / L; }

 private:
  void mark();  // point loads, collars and where they sit
  struct CachedFields {
    int count = 0;
    double first = 0.0, middle = 0.0, last = 0.0, p = 0.0;
    formulation::Fields<numerics::Pack> fields;
  };
  static constexpr std::size_t cache_size = 512;
  mutable std::vector<CachedFields> cache_;
};

/// Contact-free equations as a collocation system over scaled S.
class FreeSystem final : public collocation::System {
 public:
  explicit FreeSystem(const ScaledProblem* problem);
  void residual(double S, const double* u, double* out) const override;
  void jacobian(double S, const double* u, double* out, double* jac) const override;
  void residuals(const double* S, int count, const numerics::Pack* u, numerics::Pack* out) const override;
  void jacobians(const double* S, int count, const numerics::Pack* u, numerics::Pack* out,
                 numerics::Pack* jac) const override;
  void highest(const double* S, int count, const numerics::Pack* u, numerics::Pack* out,
               numerics::Pack* top) const override;

 private:
  const ScaledProblem* problem_;
};

/// Contact-free equations in wall coordinates (formulation/near_wall.hpp); presents its inputs in the contact-free
/// form.
class NearWallSystem final : public collocation::System {
 public:
  explicit NearWallSystem(const ScaledProblem* problem);
  void residual(double S, const double* u, double* out) const override;
  void jacobian(double S, const double* u, double* out, double* jac) const override;
  void present(double S, double* u) const override;

 private:
  const ScaledProblem* problem_;
  FreeSystem free_;
};

/// Line-contact equations as a collocation system over scaled S.
class LineSystem final : public collocation::System {
 public:
  explicit LineSystem(const ScaledProblem* problem);
  void residual(double S, const double* u, double* out) const override;
  void jacobian(double S, const double* u, double* out, double* jac) const override;
  void residuals(const double* S, int count, const numerics::Pack* u, numerics::Pack* out) const override;
  void jacobians(const double* S, int count, const numerics::Pack* u, numerics::Pack* out,
                 numerics::Pack* jac) const override;

 private:
  const ScaledProblem* problem_;
};

/// A scaled problem with its systems at fixed addresses; shared by the chains of one study, never between threads.
struct Mechanics {
  explicit Mechanics(const Problem& problem, double parameter = 0.0)
      : problem(problem, parameter), free(&this->problem), near_wall(&this->problem), line(&this->problem) {
    vary();
  }
  explicit Mechanics(const ScaledProblem& problem)
      : problem(problem), free(&this->problem), near_wall(&this->problem), line(&this->problem) {
    vary();
  }
  Mechanics(const Mechanics&) = delete;
  ScaledProblem problem;
  FreeSystem free;
  NearWallSystem near_wall;
  LineSystem line;
  /// The system of a kind of segment; `piece` of the section law where the rod varies, `near`: in wall coordinates.
  const collocation::System* system(bool is_line, int piece, bool near = false) const;

 private:
  std::vector<std::unique_ptr<VaryingFreeSystem>> varying_free_;
  std::vector<std::unique_ptr<VaryingLineSystem>> varying_line_;
  void vary();
};

}  // namespace tendril::segmentation
