// The chain's unknowns as one vector, their typical sizes, and the opaque state for files.
#include <algorithm>
#include <cmath>

#include "tendril/segmentation/chain.hpp"

namespace tendril::segmentation {

using formulation::FreeRod;

int Chain::unknowns() const { return column_of_p() + 1 + (phase_ ? 1 : 0); }

void Chain::gather(std::vector<double>& x) const {
  x.resize(unknowns());
  for (int j = 0; j < segments(); ++j)
    std::copy(segment_[j].states_data().begin(), segment_[j].states_data().end(), x.begin() + first_column_[j]);
  std::copy(S_.begin(), S_.end(), x.begin() + state_columns_);
  x[column_of_p()] = p_;
  if (phase_) x.back() = multiplier_;
}

void Chain::scatter(const std::vector<double>& x) {
  for (int j = 0; j < segments(); ++j)
    std::copy_n(x.begin() + first_column_[j], segment_[j].states_data().size(), segment_[j].states_data().begin());
  std::copy_n(x.begin() + state_columns_, S_.size(), S_.begin());
  p_ = x[column_of_p()];
  if (phase_) multiplier_ = x.back();
  mechanics_->problem.p = p_;
}

void Chain::gather_all(std::vector<double>& x) const {
  gather(x);
  for (const auto& s : segment_) x.insert(x.end(), s.local().begin(), s.local().end());
}

void Chain::scatter_all(const std::vector<double>& x) {
  scatter({x.begin(), x.begin() + unknowns()});
  std::size_t at = unknowns();
  for (auto& s : segment_)
    for (double& w : s.local()) w = x[at++];
}

void Chain::advance(const std::vector<double>& t, double step) {
  std::vector<double> dx(t), dw;
  for (double& v : dx) v *= step;
  local_changes(dx, dw);
  std::vector<double> x;
  gather(x);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += dx[i];
  scatter(x);
  std::size_t at = 0;
  for (auto& s : segment_)
    for (double& w : s.local()) w += dw[at++];
}

void Chain::rebind(std::shared_ptr<Mechanics> mechanics) {
  const std::shared_ptr<Mechanics> before = mechanics_;
  mechanics_ = std::move(mechanics);
  for (int j = 0; j < segments(); ++j) {
    const collocation::System* system = &mechanics_->free;
    if (line_[j]) system = &mechanics_->line;
    if (&segment_[j].system() == &before->near_wall) system = &mechanics_->near_wall;
    segment_[j].rebind(system);
  }
  mechanics_->problem.p = p_;
}

bool Chain::stay(const std::vector<double>& before) {
  bool same = true;
  for (int j = 0; j < segments(); ++j)
    same = segment_[j].stay(before[j], before[j + 1], S_[j], S_[j + 1], mechanics_->problem.knots) && same;
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
  for (int j = 0; j < segments(); ++j) {
    const auto& s = segment_[j];
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
  }
  typical_ = t;
}

void Chain::scales(std::vector<double>& d) const {
  d.assign(unknowns(), 1.0);
  const StateScale& t = typical_;
  const double free[12] = {t.d0, t.d1, t.d2, t.d0, t.d1, t.d2, 1.0, t.turn1, t.F, t.F, t.F, 1.0};
  const double near[12] = {1.0, t.b1, t.b2, t.d0, t.d1, t.d2, 1.0, t.turn1, t.F, t.F, t.F, 1.0};
  const double line[8] = {1.0, t.b1, t.b2, 1.0, t.turn1, t.F, t.F, 1.0};
  for (int j = 0; j < segments(); ++j) {
    const auto& s = segment_[j];
    for (int i = 0; i <= s.pieces(); ++i)
      std::copy_n(line_[j] ? line : near_wall(j) ? near : free, s.states(), d.begin() + column_of_state(j, i, 0));
  }
  d[column_of_p()] = p_scale_;
  if (phase_) d.back() = t.F;
}

void Chain::store(std::vector<double>& out) const {
  out = {tip_ ? 2.0 : 1.0, static_cast<double>(k_), p_, p_scale_, static_cast<double>(segments())};
  for (int j = 0; j < segments(); ++j) out.push_back(near_wall(j) ? 2.0 : line_[j]);  // 2: free, in wall coordinates
  out.insert(out.end(), S_.begin(), S_.end());
  for (int j = 0; j < segments(); ++j) {
    const auto& s = segment_[j];
    out.push_back(s.pieces());
    for (int i = 0; i <= s.pieces(); ++i) out.push_back(s.place(i, S_[j], S_[j + 1]));
    out.insert(out.end(), s.states_data().begin(), s.states_data().end());
    out.insert(out.end(), s.local().begin(), s.local().end());
  }
}

bool Chain::restore(const std::vector<double>& in, std::shared_ptr<Mechanics> mechanics) {
  std::size_t at = 0;
  bool ok = true;
  auto next = [&]() { return at < in.size() ? in[at++] : (ok = false, 0.0); };
  const double form = next();  // 2: the tip rests on the wall
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
    const collocation::System* system = &mechanics_->free;
    if (line_[j]) system = &mechanics_->line;
    if (near[j]) system = &mechanics_->near_wall;
    segment_.emplace_back(system, k_);
    const double pieces = next();
    if (!(pieces >= 1.0 && pieces < 1e6) || !(S_[j + 1] > S_[j])) return false;
    std::vector<double> s;
    for (int i = 0; i <= pieces; ++i) s.push_back(next());
    if (!ok) return false;
    auto& seg = segment_.back();
    seg.initialise_on(S_[j], S_[j + 1], std::span(s).subspan(1, s.size() - 2), [](double, double* u, double* q) {
      std::fill_n(u, FreeRod::inputs, 0.0);
      q[0] = 0.0;
    });
    for (double& z : seg.states_data()) z = next();
    for (double& w : seg.local()) w = next();
  }
  if (!ok) return false;
  multiplier_ = 0.0;
  choose_phase();
  number();
  return true;
}

}  // namespace tendril::segmentation
