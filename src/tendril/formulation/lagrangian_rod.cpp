#include "tendril/formulation/lagrangian_rod.hpp"

namespace tendril::formulation {

double lagrangian_pressure(const LagrangianRodData& rod, const double* u) {
  using J = numerics::Jet<double>;
  const TubeJet tube = rod.tube(u[0]);
  const Quaternion<double> q{u[4], u[6], u[8], u[10]};
  const V3<double> M{u[12], u[14], u[16]};
  const LagrangianContact<double> c(rod, tube, u[0], u[2], q, M, u[18], u[20]);
  Quaternion<J> qJ;
  V3<J> MJ;
  for (int i = 0; i < 4; ++i) qJ[i] = J(q[i], c.cosserat.dq[i]);
  for (int i = 0; i < 3; ++i) MJ[i] = J(M[i], c.cosserat.dM[i]);
  const LagrangianContact<J> moving(rod, tube, J(u[0], c.dS), J(u[2], c.dbeta), qJ, MJ, J(u[18], c.dFt),
                                    J(u[20], c.dFg));
  return -numerics::dot(rod.force, c.N) - moving.Fn.d + numerics::dot(c.F, c.dN);
}

}  // namespace tendril::formulation
