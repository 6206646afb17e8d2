#include "tendril/formulation/varying_rod.hpp"

namespace tendril::formulation {

VaryingLine::Wall VaryingLine::wall(const rod::SectionPiece& law, bool curved, const Section& sec, const double* u) {
  // as LineContact::wall: everything on jets along the curve, F_n' the total derivative of the explicit F_n
  using J = numerics::Jet<double>;
  using numerics::dot;
  const auto c = LineContact::wall_jet(sec, u);
  const auto load = [&](const V3<double>& a, const V3<double>& slope) {
    const V3<double> d = load_slope(a, slope, sec.U[0]);
    return V3<J>{J{a[0], d[0]}, J{a[1], d[1]}, J{a[2], d[2]}};
  };
  const J s{u[11], u[12]}, F3{u[9], u[10]}, Fg{u[7], u[8]};
  const J weight = law.at<J>(s).weight;
  const V3<J> sigma0 = load(sec.sigma, sec.sigma_slope), gravity = load(sec.gravity, {}),
              mu = load(sec.mu, sec.mu_slope);
  V3<J> sigma;
  for (int i = 0; i < 3; ++i) sigma[i] = sigma0[i] + weight * gravity[i];
  const V3<J> gv{c.gv[0].v, c.gv[1].v, c.gv[2].v}, t{c.t[0].v, c.t[1].v, c.t[2].v}, N{c.N[0].v, c.N[1].v, c.N[2].v};
  const Resultants<J> r(law, curved, c.J1bar.v, c.kn.v, c.kn.d, c.kg.v, c.tg.v, dot(sigma, t), dot(mu, gv),
                        J{u[4], u[5]}, J{u[5], u[6]}, Fg, F3, s);
  Wall out;
  out.Mg = r.Mg.v;
  out.MN = r.MN.v;
  LineContact::Wall& w = out.wall;
  w.Fn = r.Fn.v;
  w.M3 = r.M3.v;
  w.rho = -(r.J1.v * r.Fn.d + r.alpha.v * (c.kn.v.v * F3.v + c.tg.v.v * Fg.v) + dot(sigma, N).v);  // (III.2.31)
  w.curve = LineContact::values(c);
  return out;
}

}  // namespace tendril::formulation
