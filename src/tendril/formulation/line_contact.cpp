#include "tendril/formulation/line_contact.hpp"

namespace tendril::formulation {

LineContact::WallJet LineContact::wall_jet(const Section& sec, const double* u) {
  using J = numerics::Jet<double>;
  std::array<V3<J>, 3> U;
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) U[j][i] = J{sec.U[j][i], sec.U[j + 1][i]};
  std::array<J, 4> Q;
  for (int j = 0; j < 4; ++j) Q[j] = J{sec.Q[j], sec.Q[j + 1]};
  // κ_n' does not contain β''' ((III.2.49) differentiated), so the unknown slope of β''' is irrelevant here
  return curve_jet<J>(U, Q, J{u[0], u[1]}, J{u[1], u[2]}, J{u[2], u[3]}, J{u[3], 0.0});
}

SurfaceCurve<double> LineContact::values(const WallJet& c) {
  SurfaceCurve<double> curve;
  curve.J1bar = c.J1bar.v.v;
  curve.kn = c.kn.v.v;
  curve.kg = c.kg.v.v;
  curve.tg = c.tg.v.v;
  for (int i = 0; i < 3; ++i) {
    curve.t[i] = c.t[i].v.v;
    curve.gv[i] = c.gv[i].v.v;
    curve.N[i] = c.N[i].v.v;
  }
  return curve;
}

LineContact::Wall LineContact::wall(const Material& m, const Section& sec, const double* u) {
  // F_n' is the total derivative of the explicit F_n: everything is evaluated on jets along the curve, with the highest
  // derivatives of the unknowns entering as the slopes of the second highest.
  using J = numerics::Jet<double>;
  using numerics::dot;
  const auto c = wall_jet(sec, u);
  const J Fg{u[7], u[8]}, F3{u[9], u[10]}, psip{u[5], u[6]};
  const J alpha = 1.0 + m.eta2 * F3;
  const J J1 = alpha * c.J1bar.v;
  const J M3 = (1.0 / (1.0 + m.nu)) * (alpha * c.tg.v + J1 * psip);
  const V3<double> ds = load_slope(sec.sigma, sec.sigma_slope, sec.U[0]),
                   dm = load_slope(sec.mu, sec.mu_slope, sec.U[0]);
  const V3<J> sigma{J{sec.sigma[0], ds[0]}, J{sec.sigma[1], ds[1]}, J{sec.sigma[2], ds[2]}};
  const V3<J> mu{J{sec.mu[0], dm[0]}, J{sec.mu[1], dm[1]}, J{sec.mu[2], dm[2]}};
  const V3<J> gv{c.gv[0].v, c.gv[1].v, c.gv[2].v}, t{c.t[0].v, c.t[1].v, c.t[2].v};
  const V3<J> N{c.N[0].v, c.N[1].v, c.N[2].v};
  const J Fn = normal_force<J>(m, alpha, J1, c.kn.v, c.kn.d, c.kg.v, c.tg.v, M3, Fg, dot(sigma, t), dot(mu, gv));
  Wall w;
  w.Fn = Fn.v;
  w.M3 = M3.v;
  const double a = alpha.v;
  w.rho = -(J1.v * Fn.d + a * (c.kn.v.v * F3.v + c.tg.v.v * Fg.v) + dot(sigma, N).v);  // (III.2.31)
  w.curve = values(c);
  return w;
}

}  // namespace tendril::formulation
