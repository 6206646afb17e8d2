// The chain's unknowns as one vector, their typical sizes, and the opaque state for files.
#include <algorithm>
#include <cmath>

#include "tendril/segmentation/chain.hpp"

namespace tendril::segmentation {

using formulation::FreeRod;

int Chain::unknowns() const { return column_of_p() + 1 + (phase_ ? 1 : 0); }

void Chain::gather(std::vector<double>& x) const {
  x.resize(unknowns());
  each_part([&](int j, int q, const collocation::Segment& s, double a, double) {
    if (q > 0) x[first_column_[j][q] - 1] = a;
    std::copy(s.states_data().begin(), s.states_data().end(), x.begin() + first_column_[j][q]);
  });
  std::copy(S_.begin(), S_.end(), x.begin() + state_columns_);
  x[column_of_p()] = p_;
  if (phase_) x.back() = multiplier_;
}

void Chain::scatter(const std::vector<double>& x) {
  for (int j = 0; j < segments(); ++j)
    for (int q = 0; q < segment_[j].parts(); ++q) {
      auto& z = segment_[j].part(q).states_data();
      if (q > 0) segment_[j].move_cut(q - 1, x[first_column_[j][q] - 1]);
      std::copy_n(x.begin() + first_column_[j][q], z.size(), z.begin());
    }
  std::copy_n(x.begin() + state_columns_, S_.size(), S_.begin());
  p_ = x[column_of_p()];
  if (phase_) multiplier_ = x.back();
  mechanics_->problem.p = p_;
}

void Chain::gather_all(std::vector<double>& x) const {
  gather(x);
  each_part([&](int, int, const collocation::Segment& s, double, double) {
    x.insert(x.end(), s.local().begin(), s.local().end());
  });
}

void Chain::scatter_all(const std::vector<double>& x) {
  scatter({x.begin(), x.begin() + unknowns()});
  set_local(x.data() + unknowns());
}

void Chain::advance(const std::vector<double>& t, double step) {
  std::vector<double> dx(t), dw;
  for (double& v : dx) v *= step;
  local_changes(dx, dw);
  std::vector<double> x;
  gather(x);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += dx[i];
  scatter(x);
  std::vector<double> w;
  gather_local(w);
  for (std::size_t i = 0; i < w.size(); ++i) w[i] += dw[i];
  set_local(w.data());
}

void Chain::rebind(std::shared_ptr<Mechanics> mechanics) {
  const std::shared_ptr<Mechanics> before = mechanics_;
  mechanics_ = std::move(mechanics);
  for (int j = 0; j < segments(); ++j) {
    const bool near = &segment_[j].system() == &before->near_wall;
    for (int q = 0; q < segment_[j].parts(); ++q)
      segment_[j].part(q).rebind(mechanics_->system(line_[j], segment_[j].law(q), near));
  }
  mechanics_->problem.p = p_;
}

bool Chain::stay(const std::vector<double>& before) {
  bool same = true;
  for (int j = 0; j < segments(); ++j) {
    CutSegment& s = segment_[j];
    for (int q = 0; q < s.parts(); ++q)
      same = s.part(q).stay(s.left(q, before[j]), s.right(q, before[j + 1]), s.left(q, S_[j]), s.right(q, S_[j + 1]),
                            mechanics_->problem.knots) &&
             same;
    s.count();
  }
  if (!same) {
    number();
    if (phase_) choose_phase(), number();
  }
  return same;
}

void Chain::typical() {
  StateScale t{mechanics_->problem.clearance_max, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0};
  t.d1 = t.d0;
  t.d2 = 10.0 * t.d0;
  each_part([&](int j, int, const collocation::Segment& s, double, double) {
    for (int i = 0; i <= s.pieces(); ++i) {
      const double* z = s.state(i);
      if (line_[j]) {
        t.b1 = std::max(t.b1, std::abs(z[1]));
        t.b2 = std::max(t.b2, std::abs(z[2]));
        t.turn1 = std::max(t.turn1, std::abs(z[4]));
        for (int q = 5; q < 7; ++q) t.F = std::max(t.F, std::abs(z[q]));
      } else if (near_wall(j)) {
        t.b1 = std::max(t.b1, std::abs(z[1]));
        t.b2 = std::max(t.b2, std::abs(z[2]));
        t.turn1 = std::max(t.turn1, std::abs(z[7]));
        for (int q = 8; q < 11; ++q) t.F = std::max(t.F, std::abs(z[q]));
      } else {
        t.d1 = std::max({t.d1, std::abs(z[1]), std::abs(z[4])});
        t.d2 = std::max({t.d2, std::abs(z[2]), std::abs(z[5])});
        t.turn1 = std::max(t.turn1, std::abs(z[7]));
        for (int q = 8; q < 11; ++q) t.F = std::max(t.F, std::abs(z[q]));
      }
    }
  });
  typical_ = t;
}

void Chain::scales(std::vector<double>& d) const {
  d.assign(unknowns(), 1.0);
  const StateScale& t = typical_;
  const double free[12] = {t.d0, t.d1, t.d2, t.d0, t.d1, t.d2, 1.0, t.turn1, t.F, t.F, t.F, 1.0};
  const double near[12] = {1.0, t.b1, t.b2, t.d0, t.d1, t.d2, 1.0, t.turn1, t.F, t.F, t.F, 1.0};
  const double line[8] = {1.0, t.b1, t.b2, 1.0, t.turn1, t.F, t.F, 1.0};
  each_part([&](int j, int q, const collocation::Segment& s, double, double) {
    for (int i = 0; i <= s.pieces(); ++i)
      std::copy_n(line_[j]       ? line
                  : near_wall(j) ? near
                                 : free,
                  s.states(), d.begin() + first_column_[j][q] + i * s.states());
  });
  d[column_of_p()] = p_scale_;
  if (phase_) d.back() = t.F;
}

// Format 1, or 2: the tip rests on the wall; of a varying rod 3 and 4: every segment tells the cuts and pieces of its
// law first. With collars or point loads 5 and 6: cuts also tell what sits there, and the collars follow the segments.
void Chain::store(std::vector<double>& out) const {
  const bool varies = mechanics_->problem.varies(), marked = mechanics_->problem.marked();
  out = {1.0 + (tip_ ? 1.0 : 0.0) +
             (marked   ? 4.0
              : varies ? 2.0
                       : 0.0),
         static_cast<double>(k_), p_, p_scale_, static_cast<double>(segments())};
  for (int j = 0; j < segments(); ++j) out.push_back(near_wall(j) ? 2.0 : line_[j]);  // 2: free, in wall coordinates
  out.insert(out.end(), S_.begin(), S_.end());
  each_part([&](int j, int part, const collocation::Segment& s, double a, double b) {
    if (varies && part == 0) {
      const CutSegment& whole = segment_[j];
      out.push_back(whole.parts());
      for (int q = 0; q < whole.parts(); ++q) out.push_back(whole.law(q));
      for (int q = 0; q + 1 < whole.parts(); ++q) {
        const Cut& c = whole.cut(q);
        out.insert(out.end(), {c.S, c.s});
        if (marked)
          out.insert(out.end(), {static_cast<double>(c.collar), static_cast<double>(c.load), c.placed ? 1.0 : 0.0});
      }
    }
    out.push_back(s.pieces());
    for (int i = 0; i <= s.pieces(); ++i) out.push_back(s.place(i, a, b));
    out.insert(out.end(), s.states_data().begin(), s.states_data().end());
    out.insert(out.end(), s.local().begin(), s.local().end());
  });
  out.insert(out.end(), touching_.begin(), touching_.end());
}

bool Chain::restore(const std::vector<double>& in, std::shared_ptr<Mechanics> mechanics) {
  std::size_t at = 0;
  bool ok = true;
  auto next = [&]() { return at < in.size() ? in[at++] : (ok = false, 0.0); };
  const bool varies = mechanics->problem.varies(), marked = mechanics->problem.marked();
  const double form = next() - (marked ? 4.0 : varies ? 2.0 : 0.0);
  if (form != 1.0 && form != 2.0) return false;
  mechanics_ = std::move(mechanics);
  tip_ = form == 2.0 && mechanics_->problem.tip_free();
  k_ = static_cast<int>(next());
  p_ = next();
  p_scale_ = next();
  const double n = next();
  if (!ok || k_ < 4 || k_ > 7 || !(n >= 1.0 && n < 1e6)) return false;
  line_.clear();
  S_.clear();
  segment_.clear();
  std::vector<char> near;
  for (int j = 0; j < n; ++j) {
    const double kind = next();
    line_.push_back(kind == 1.0);
    near.push_back(kind == 2.0);
  }
  for (std::size_t j = 0; j < near.size(); ++j)
    if (near[j] && (j == 0 || j + 1 == near.size())) return false;
  for (int j = 0; j <= n; ++j) S_.push_back(next());
  mechanics_->problem.p = p_;
  for (int j = 0; j < n && ok; ++j) {
    if (!(S_[j + 1] > S_[j])) return false;
    const double parts = varies ? next() : 1.0;
    if (!(parts >= 1.0 && parts < 1e5)) return false;
    std::vector<int> law;
    std::vector<Cut> cuts;
    for (int q = 0; q < parts; ++q) law.push_back(varies ? static_cast<int>(next()) : 0);
    for (int q = 0; q + 1 < parts; ++q) {
      Cut c;
      c.S = next();
      c.s = next();
      if (marked) {
        c.collar = static_cast<int>(next());
        c.load = static_cast<int>(next());
        c.placed = next() != 0.0;
        if (c.collar >= static_cast<int>(mechanics_->problem.collars.size()) ||
            c.load >= static_cast<int>(mechanics_->problem.point_loads.size()))
          return false;
      }
      cuts.push_back(c);
    }
    std::vector<collocation::Segment> pieces_of;
    for (int q = 0; q < parts && ok; ++q) {
      if (varies && !(law[q] >= 0 && law[q] < static_cast<int>(mechanics_->problem.law.pieces.size()))) return false;
      pieces_of.emplace_back(mechanics_->system(line_[j], law[q], near[j]), k_);
      const double a = q == 0 ? S_[j] : cuts[q - 1].S, b = q + 1 == parts ? S_[j + 1] : cuts[q].S;
      const double pieces = next();
      if (!(pieces >= 1.0 && pieces < 1e6) || !(b > a)) return false;
      std::vector<double> s;
      for (int i = 0; i <= pieces; ++i) s.push_back(next());
      if (!ok) return false;
      auto& seg = pieces_of.back();
      seg.initialise_on(a, b, std::span(s).subspan(1, s.size() - 2), [](double, double* u, double* q0) {
        std::fill_n(u, formulation::state_inputs, 0.0);
        q0[0] = 0.0;
      });
      for (double& z : seg.states_data()) z = next();
      for (double& w : seg.local()) w = next();
    }
    if (!ok) return false;
    if (varies)
      segment_.emplace_back(std::move(pieces_of), std::move(cuts), std::move(law));
    else
      segment_.emplace_back(std::move(pieces_of.front()));
  }
  touching_.clear();
  for (std::size_t i = 0; i < mechanics_->problem.collars.size(); ++i) touching_.push_back(next() != 0.0);
  if (!ok) return false;
  multiplier_ = 0.0;
  choose_phase();
  number();
  return true;
}

}  // namespace tendril::segmentation
