#include <algorithm>
#include <cmath>

#include "tendril/segmentation/discovery.hpp"

namespace tendril::segmentation {

// Loaded stretches of wall. A line contact's concentrated end shows as a peak, often cut off from the rest by a sliver
// of gap no wider than the mesh resolves: such neighbours are one contact.
std::vector<FoundContact> read_contacts(const DiscreteRod& rod, const std::vector<Vector4>& u, double clearance,
                                        const std::vector<double>& pressure_at, const std::vector<double>& gap_at) {
  std::vector<FoundContact> found;
  const auto& q = rod.points();
  struct Cluster {
    std::size_t first, last;  // quadrature points
    double force;
  };
  std::vector<Cluster> clusters;
  const auto force = [&](std::size_t i) { return q[i].weight * pressure_at[i]; };
  double largest = 0.0;
  for (std::size_t i = 0; i < q.size(); ++i) largest = std::max(largest, force(i));
  if (!(largest > 0.0)) return found;
  for (std::size_t i = 0; i < q.size(); ++i) {
    if (force(i) <= 1e-4 * largest) continue;
    double gap = 0.0;
    const double h = rod.nodes()[q[i].element + 1] - rod.nodes()[q[i].element];
    if (!clusters.empty())
      for (std::size_t k = clusters.back().last; k < i; ++k) gap = std::max(gap, gap_at[k]);
    const double apart = clusters.empty() ? 1e300 : q[i].S - q[clusters.back().last].S;
    if (apart < 1.5 * h || (apart < 3.0 * h && gap < 1e-3 * clearance)) {
      clusters.back().last = i;
      clusters.back().force += force(i);
    } else {
      clusters.push_back({i, i, force(i)});
    }
  }
  const auto angle = [&](double S) {
    const auto x = rod.at(S, u);
    return std::atan2(x[3], x[0]);
  };
  for (const auto& cluster : clusters) {
    FoundContact c;
    c.force = cluster.force;
    const double first = q[cluster.first].S, last = q[cluster.last].S;
    const double h = rod.nodes()[q[cluster.first].element + 1] - rod.nodes()[q[cluster.first].element];
    const auto centre = [&](double from, double to, double pressure, double& excess) {
      double moment = 0.0;
      excess = 0.0;
      for (std::size_t i = cluster.first; i <= cluster.last; ++i) {
        if (q[i].S < from || q[i].S > to) continue;
        const double f = force(i) - pressure * q[i].weight;
        excess += f;
        moment += f * q[i].S;
      }
      return std::clamp(moment / excess, from, to);
    };
    double total = 0.0;
    c.start = c.end = centre(first, last, 0.0, total);
    double inner_share = 1.0;
    double spread = 0.0;  // standard deviation of the load
    for (std::size_t i = cluster.first; i <= cluster.last; ++i)
      spread += force(i) / total * (q[i].S - c.start) * (q[i].S - c.start);
    if (last - first > 1.8 * h && std::sqrt(spread) > 0.6 * h) {
      c.line = true;
      c.start = first;
      c.end = last;
      // What the outer stretch carries beyond the pressure further in is the concentrated end, its centre the line's
      // end.
      const double edge = std::min(3.0 * h, 0.3 * (last - first));
      double inner = 0.0, width = 0.0;
      for (std::size_t i = cluster.first; i <= cluster.last; ++i) {
        if (q[i].S <= first + edge || q[i].S >= last - edge) continue;
        inner += force(i);
        width += q[i].weight;
      }
      const double pressure = width > 0.0 ? inner / width : 0.0;
      inner_share = inner / total;
      double excess = 0.0;
      const double from = centre(first, first + edge, pressure, excess);
      if (excess > pressure * h) {
        c.start = from;
        c.force_start = excess + pressure * (from - first);
      }
      const double to = centre(last - edge, last, pressure, excess);
      if (excess > pressure * h) {
        c.end = to;
        c.force_end = excess + pressure * (last - to);
      }
    }
    // A line that runs into an end held on the wall starts there, without a concentrated force of its own.
    const auto on_wall = [&](std::size_t node) {
      const double Q = rod.clearance_at(rod.nodes()[node]);
      return std::abs(std::hypot(u[node][0], u[node][2]) - Q) < 1e-9 * Q;
    };
    if (c.line && cluster.first < 3 && on_wall(0)) {
      c.start = rod.nodes().front();
      c.force_start = 0.0;
    }
    if (c.line && cluster.last + 3 >= q.size() && on_wall(rod.node_count() - 1)) {
      c.end = rod.nodes().back();
      c.force_end = 0.0;
    }
    // Two loaded spots with nothing between them are two points.
    if (c.line && c.force_start > 0.0 && c.force_end > 0.0 && inner_share < 1e-4) {
      for (const bool second : {false, true}) {
        FoundContact point;
        point.start = point.end = second ? c.end : c.start;
        point.angle_start = point.angle_end = angle(point.start);
        point.force = second ? c.force_end : c.force_start;
        found.push_back(point);
      }
      continue;
    }
    c.angle_start = angle(c.start);
    c.angle_end = angle(c.end);
    found.push_back(c);
  }
  return found;
}

}  // namespace tendril::segmentation
