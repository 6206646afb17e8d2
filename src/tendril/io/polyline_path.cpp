#include "tendril/io/polyline_path.hpp"

#include <algorithm>
#include <cmath>
#include <queue>
#include <unordered_map>

namespace tendril::io {
namespace {

using geometry::Vec3;

constexpr double kCoincident = 1e-6;  // of the extent: single precision of the files

double extent(const PolylineFile& file) {
  Vec3 low = file.points.front(), high = low;
  for (const Vec3& p : file.points) low = low.cwiseMin(p), high = high.cwiseMax(p);
  return (high - low).norm();
}

// The lines as a graph: points that coincide are one node, consecutive points of a line are joined.
struct Graph {
  std::vector<std::size_t> node_of;                  // of each point of the file
  std::vector<std::size_t> point_of;                 // the first point of each node
  std::vector<std::vector<std::size_t>> neighbours;  // of each node, in the order of the file
};

Graph make_graph(const PolylineFile& file) {
  Graph graph;
  graph.node_of.assign(file.points.size(), 0);
  const double size = std::max(kCoincident * extent(file), 1e-300);
  struct Cell {
    std::int64_t i, j, k;
    bool operator==(const Cell& o) const { return i == o.i && j == o.j && k == o.k; }
  };
  struct Hash {
    std::size_t operator()(const Cell& c) const {
      return static_cast<std::size_t>(c.i) * 73856093u ^ static_cast<std::size_t>(c.j) * 19349663u ^
             static_cast<std::size_t>(c.k) * 83492791u;
    }
  };
  const Vec3 origin = file.points.front();
  std::unordered_map<Cell, std::vector<std::size_t>, Hash> cells;
  const auto cell_of = [&](const Vec3& p) {
    const Vec3 scaled = (p - origin) / size;
    return Cell{std::llround(scaled[0]), std::llround(scaled[1]), std::llround(scaled[2])};
  };
  for (const auto& line : file.lines) {
    std::size_t before = 0;
    for (std::size_t n = 0; n < line.size(); ++n) {
      const Vec3& p = file.points[line[n]];
      const Cell home = cell_of(p);
      std::size_t node = graph.point_of.size();
      for (std::int64_t i = -1; i <= 1 && node == graph.point_of.size(); ++i) {
        for (std::int64_t j = -1; j <= 1; ++j) {
          for (std::int64_t k = -1; k <= 1; ++k) {
            const auto it = cells.find({home.i + i, home.j + j, home.k + k});
            if (it == cells.end()) continue;
            for (const std::size_t other : it->second) {
              if ((file.points[graph.point_of[other]] - p).norm() <= size) node = std::min(node, other);
            }
          }
        }
      }
      if (node == graph.point_of.size()) {
        graph.point_of.push_back(line[n]);
        graph.neighbours.emplace_back();
        cells[home].push_back(node);
      }
      graph.node_of[line[n]] = node;
      if (n > 0 && node != before) {
        auto& from = graph.neighbours[before];
        if (std::find(from.begin(), from.end(), node) == from.end()) {
          from.push_back(node);
          graph.neighbours[node].push_back(before);
        }
      }
      before = node;
    }
  }
  return graph;
}

// A node is an end if one way leaves it, or several to the same side: centrelines that start at one inlet.
std::vector<std::size_t> end_nodes(const PolylineFile& file, const Graph& graph) {
  std::vector<std::size_t> ends;
  for (std::size_t node = 0; node < graph.point_of.size(); ++node) {
    const auto& near = graph.neighbours[node];
    bool end = !near.empty() && near.size() <= 16;
    for (std::size_t a = 0; a < near.size() && end; ++a) {
      for (std::size_t b = 0; b < a && end; ++b) {
        const Vec3 here = file.points[graph.point_of[node]];
        end = (file.points[graph.point_of[near[a]]] - here).dot(file.points[graph.point_of[near[b]]] - here) > 0;
      }
    }
    if (end) ends.push_back(node);
  }
  return ends;
}

// Shortest way (Dijkstra); empty where there is none.
std::vector<std::size_t> shortest_way(const PolylineFile& file, const Graph& graph, std::size_t from, std::size_t to) {
  constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  std::vector<double> distance(graph.point_of.size(), HUGE_VAL);
  std::vector<std::size_t> before(graph.point_of.size(), kNone);
  using Entry = std::pair<double, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  distance[from] = 0;
  open.push({0, from});
  while (!open.empty()) {
    const auto [d, node] = open.top();
    open.pop();
    if (d > distance[node]) continue;
    if (node == to) break;
    for (const std::size_t next : graph.neighbours[node]) {
      const double there = d + (file.points[graph.point_of[next]] - file.points[graph.point_of[node]]).norm();
      if (there >= distance[next]) continue;
      distance[next] = there;
      before[next] = node;
      open.push({there, next});
    }
  }
  if (!std::isfinite(distance[to])) return {};
  std::vector<std::size_t> way;
  for (std::size_t node = to; node != kNone; node = before[node]) way.push_back(graph.point_of[node]);
  std::reverse(way.begin(), way.end());
  return way;
}

std::string place_text(const Vec3& p) {
  const auto short_number = [](double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", value);
    return std::string(text);
  };
  return "(" + short_number(p[0]) + ", " + short_number(p[1]) + ", " + short_number(p[2]) + ")";
}

std::vector<std::size_t> joined(const PolylineFile& file, const std::vector<std::size_t>& branch,
                                const std::function<Issue&(const std::string&, const std::string&)>& complain) {
  std::vector<std::size_t> path;
  for (std::size_t n = 0; n < branch.size(); ++n) {
    if (branch[n] >= file.lines.size()) {
      Issue& issue = complain("tube.axis.branch", "the file has no line " + std::to_string(branch[n]));
      issue.bound = file.lines.size() == 1 ? "0, the only one" : "0 to " + std::to_string(file.lines.size() - 1);
      return {};
    }
    std::vector<std::size_t> line = file.lines[branch[n]];
    if (line.empty()) continue;
    if (path.empty()) {
      // The first line runs towards the second one.
      if (n + 1 < branch.size() && branch[n + 1] < file.lines.size() && !file.lines[branch[n + 1]].empty()) {
        const auto& next = file.lines[branch[n + 1]];
        const auto gap = [&](std::size_t end) {
          return std::min((file.points[end] - file.points[next.front()]).norm(),
                          (file.points[end] - file.points[next.back()]).norm());
        };
        if (gap(line.front()) < gap(line.back())) std::reverse(line.begin(), line.end());
      }
      path = line;
      continue;
    }
    const Vec3 end = file.points[path.back()];
    if ((file.points[line.back()] - end).norm() < (file.points[line.front()] - end).norm())
      std::reverse(line.begin(), line.end());
    const double gap = (file.points[line.front()] - end).norm();
    if (gap > 1e3 * kCoincident * extent(file)) {
      Issue& issue = complain("tube.axis.branch", "line " + std::to_string(branch[n]) + " does not start where line " +
                                                      std::to_string(branch[n - 1]) + " ends");
      issue.value = "a gap of " + shortest(gap);
      return {};
    }
    path.insert(path.end(), line.begin(), line.end());
  }
  return path;
}

}  // namespace

std::vector<TreeEnd> tree_ends(const PolylineFile& file) {
  std::vector<TreeEnd> ends;
  if (file.points.empty()) return ends;
  const Graph graph = make_graph(file);
  for (const std::size_t node : end_nodes(file, graph)) ends.push_back({graph.point_of[node]});
  return ends;
}

std::string list_ends(const PolylineFile& file, const std::vector<TreeEnd>& ends) {
  constexpr std::size_t kShown = 40;
  std::string text;
  for (std::size_t i = 0; i < ends.size() && i < kShown; ++i) {
    text += (i > 0 ? "; " : "") + std::to_string(i) + " at " + place_text(file.points[ends[i].point]);
    if (!file.radius.empty()) {
      char radius[32];
      std::snprintf(radius, sizeof radius, "%.4g", file.radius[ends[i].point]);
      text += std::string(", radius ") + radius;
    }
  }
  if (ends.size() > kShown) text += "; and " + std::to_string(ends.size() - kShown) + " more";
  return text;
}

std::vector<std::size_t> choose_path(const PolylineFile& file, const PathChoice& choice,
                                     const std::function<Issue&(const std::string&, const std::string&)>& complain) {
  const bool by_ends = !choice.ends.empty() || choice.start_near || choice.end_near;
  if (!choice.branch.empty()) {
    if (by_ends) {
      complain("tube.axis.branch", "`tube.axis.branch` and the ends of a path exclude each other");
      return {};
    }
    return joined(file, choice.branch, complain);
  }
  if (file.lines.size() == 1 && !by_ends) return file.lines.front();
  if (file.points.empty()) return {};
  const Graph graph = make_graph(file);
  const std::vector<std::size_t> nodes = end_nodes(file, graph);
  std::vector<TreeEnd> ends;
  for (const std::size_t node : nodes) ends.push_back({graph.point_of[node]});

  const std::string hint = "choose two with `tube.axis.ends`, or lines with `tube.axis.branch`";
  std::size_t from = 0, to = 1;
  if (!choice.ends.empty()) {
    if (choice.start_near || choice.end_near) {
      complain("tube.axis.ends", "`tube.axis.ends` and `start_near`, `end_near` exclude each other");
      return {};
    }
    from = choice.ends[0], to = choice.ends[1];
    if (from >= ends.size() || to >= ends.size() || from == to) {
      Issue& issue = complain("tube.axis.ends", "`tube.axis.ends` must be two different ends of the file");
      issue.value = std::to_string(from) + ", " + std::to_string(to);
      issue.bound = list_ends(file, ends);
      return {};
    }
  } else if (choice.start_near || choice.end_near) {
    const auto nearest_end = [&](const std::optional<Vec3>& target, std::size_t other) {
      if (!target) return other;
      std::size_t best = 0;
      for (std::size_t i = 1; i < ends.size(); ++i) {
        if ((file.points[ends[i].point] - *target).norm() < (file.points[ends[best].point] - *target).norm()) best = i;
      }
      return best;
    };
    constexpr std::size_t kNone = static_cast<std::size_t>(-1);
    if (ends.size() < 2) {
      complain("tube.axis.start_near", "the lines of the file have no two ends");
      return {};
    }
    from = nearest_end(choice.start_near, kNone);
    to = nearest_end(choice.end_near, kNone);
    if (from == kNone || to == kNone) {
      if (ends.size() > 2) {
        Issue& issue = complain(from == kNone ? "tube.axis.end_near" : "tube.axis.start_near",
                                "both `start_near` and `end_near` are needed: the file has more than two ends");
        issue.value = list_ends(file, ends);
        return {};
      }
      (from == kNone ? from : to) = from == kNone ? 1 - to : 1 - from;
    }
    if (from == to) {
      complain("tube.axis.end_near", "`start_near` and `end_near` are nearest to the same end").value =
          list_ends(file, ends);
      return {};
    }
  } else if (ends.size() != 2) {
    Issue& issue =
        complain("tube.axis.file", "the file is a tree of " + std::to_string(file.lines.size()) + " lines with " +
                                       std::to_string(ends.size()) + " ends: which path is meant?");
    issue.value = list_ends(file, ends);
    issue.hint = hint;
    return {};
  } else if (!file.lines.front().empty() && graph.node_of[file.lines.front().front()] == nodes[1]) {
    std::swap(from, to);  // run as the first line runs
  }
  std::vector<std::size_t> way = shortest_way(file, graph, nodes[from], nodes[to]);
  if (way.empty()) {
    Issue& issue = complain(choice.ends.empty() ? "tube.axis.file" : "tube.axis.ends",
                            "no line of the file leads from one end to the other");
    issue.value = list_ends(file, ends);
    issue.hint = hint;
  }
  return way;
}

}  // namespace tendril::io
