#include "tendril/drawing/contour.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace tendril::drawing {

std::vector<LevelLine> level_lines(const std::vector<double>& x, const std::vector<double>& y,
                                   const std::vector<double>& value, double level,
                                   const std::function<double(double, double)>& exact) {
  const int nx = static_cast<int>(x.size()), ny = static_cast<int>(y.size());
  const auto at = [&](int i, int j) { return value[static_cast<std::size_t>(j) * nx + i] - level; };
  // An edge is 2 (j nx + i) from node (i, j) to the right, + 1 upwards.
  std::map<int, std::array<double, 2>> crossing;
  std::multimap<int, int> joined;
  const auto cross = [&](int i, int j, bool up) {
    const int edge = 2 * (j * nx + i) + up;
    if (crossing.count(edge)) return edge;
    double a = 0.0, b = 1.0, fa = at(i, j), fb = up ? at(i, j + 1) : at(i + 1, j), t = fa / (fa - fb);
    const auto place = [&](double s) {
      return std::array<double, 2>{up ? x[i] : x[i] + s * (x[i + 1] - x[i]), up ? y[j] + s * (y[j + 1] - y[j]) : y[j]};
    };
    for (int n = 0; exact && n < 60 && b - a > 1e-12; ++n) {  // Illinois
      const auto p = place(t);
      const double f = exact(p[0], p[1]) - level;
      if (!std::isfinite(f) || f == 0.0) break;
      if ((f > 0.0) == (fb > 0.0)) {
        b = t, fb = f, fa *= n > 0 ? 0.5 : 1.0;
      } else {
        a = t, fa = f, fb *= n > 0 ? 0.5 : 1.0;
      }
      const double next = a + (b - a) * fa / (fa - fb);
      const bool settled = std::abs(next - t) < 1e-11;
      t = next;
      if (settled) break;
    }
    crossing[edge] = place(t);
    return edge;
  };
  for (int j = 0; j + 1 < ny; ++j) {
    for (int i = 0; i + 1 < nx; ++i) {
      const double corner[4] = {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)};
      double mean = 0.0;
      for (double c : corner) mean += 0.25 * c;
      if (!std::isfinite(mean)) continue;
      const auto side = [&](int k) { return corner[k] > 0.0; };
      std::vector<int> edges;
      if (side(0) != side(1)) edges.push_back(cross(i, j, false));
      if (side(1) != side(2)) edges.push_back(cross(i + 1, j, true));
      if (side(2) != side(3)) edges.push_back(cross(i, j + 1, false));
      if (side(3) != side(0)) edges.push_back(cross(i, j, true));
      const auto join = [&](int a, int b) {
        joined.emplace(a, b);
        joined.emplace(b, a);
      };
      if (edges.size() == 2) join(edges[0], edges[1]);
      if (edges.size() == 4) {  // a saddle: the middle decides which corners hang together
        const bool turn = (mean > 0.0) == side(0);
        join(edges[0], edges[turn ? 1 : 3]);
        join(edges[2], edges[turn ? 3 : 1]);
      }
    }
  }
  std::vector<LevelLine> lines;
  const auto follow = [&](int edge) {
    LevelLine line;
    while (true) {
      line.x.push_back(crossing[edge][0]);
      line.y.push_back(crossing[edge][1]);
      const auto next = joined.find(edge);
      if (next == joined.end()) break;
      const int to = next->second;
      joined.erase(next);
      const auto [from, end] = joined.equal_range(to);
      for (auto k = from; k != end; ++k) {
        if (k->second == edge) {
          joined.erase(k);
          break;
        }
      }
      edge = to;
    }
    lines.push_back(std::move(line));
  };
  for (const auto& c : crossing)  // open lines from their ends, then closed ones
    if (joined.count(c.first) == 1) follow(c.first);
  for (const auto& c : crossing)
    if (joined.count(c.first) > 0) follow(c.first);
  return lines;
}

}  // namespace tendril::drawing
