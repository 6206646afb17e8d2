#include "tendril/io/cleaning.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace tendril::io {
namespace {

using geometry::Vec3;

constexpr double kTiny = 0.01, kTinyOfTube = 0.05;  // of the median hop; of it and of the radius
constexpr double kCapHop = 4.0;                     // times the median hop
constexpr double kCapFrom = 0.5, kCapTo = 1.5;      // times the radius
constexpr double kHuge = 20.0;                      // times the median hop

std::string text(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.4g", value);
  return buffer;
}

std::string with_unit(double value, const std::string& unit) { return text(value) + (unit.empty() ? "" : " " + unit); }

std::string counted(std::size_t count, const std::string& one, const std::string& many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::vector<double> hops(const std::vector<Vec3>& points) {
  std::vector<double> out;
  for (std::size_t i = 1; i < points.size(); ++i) out.push_back((points[i] - points[i - 1]).norm());
  return out;
}

// Keep the points for which `keep` is true.
void filter(std::vector<Vec3>& points, std::vector<double>& radius, std::vector<int>& rows,
            const std::vector<char>& keep) {
  std::size_t to = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!keep[i]) continue;
    points[to] = points[i];
    if (!radius.empty()) radius[to] = radius[i];
    if (!rows.empty()) rows[to] = rows[i];
    ++to;
  }
  points.resize(to);
  if (!radius.empty()) radius.resize(to);
  if (!rows.empty()) rows.resize(to);
}

void drop_duplicates(std::vector<Vec3>& points, std::vector<double>& radius, std::vector<int>& rows,
                     CleaningReport& report) {
  std::vector<char> keep(points.size(), 1);
  for (std::size_t i = 1, last = 0; i < points.size(); ++i) {
    if (points[i] == points[last])
      keep[i] = 0, ++report.duplicates;
    else
      last = i;
  }
  if (report.duplicates == 0) return;
  filter(points, radius, rows, keep);
  report.notes.push_back(counted(report.duplicates, "repeated point", "repeated points") + " removed");
}

void drop_caps(std::vector<Vec3>& points, std::vector<double>& radius, std::vector<int>& rows, const std::string& unit,
               CleaningReport& report) {
  constexpr std::size_t kFewest = 8;  // below that the median hop says little
  if (radius.empty() || points.size() < kFewest) return;
  const double usual = median(hops(points));
  std::vector<char> keep(points.size(), 1);
  const auto end = [&](std::size_t outer, std::size_t inner, const char* name) {
    const double hop = (points[outer] - points[inner]).norm(), r = radius[inner];
    if (!(hop > kCapHop * usual && hop >= kCapFrom * r && hop <= kCapTo * r)) return;
    keep[outer] = 0;
    ++report.caps;
    report.notes.push_back(std::string(name) + " point removed: an end cap, its hop of " + with_unit(hop, unit) +
                           " is about the radius there, " + with_unit(r, unit));
  };
  end(0, 1, "first");
  end(points.size() - 1, points.size() - 2, "last");
  if (report.caps > 0) filter(points, radius, rows, keep);
}

void drop_tiny(std::vector<Vec3>& points, std::vector<double>& radius, std::vector<int>& rows, const std::string& unit,
               CleaningReport& report) {
  if (points.size() < 5) return;
  const double usual = median(hops(points));
  const auto limit = [&](std::size_t i) {
    const double tube = radius.empty() ? 0.0 : kTinyOfTube * std::min(usual, radius[i]);
    return std::max(kTiny * usual, tube);
  };
  std::vector<char> keep(points.size(), 1);
  double smallest = HUGE_VAL;
  std::size_t last = 0;
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    const double hop = (points[i] - points[last]).norm();
    if (hop < limit(i)) {
      keep[i] = 0;
      ++report.tiny;
      smallest = std::min(smallest, hop);
    } else {
      last = i;
    }
  }
  // The last point stays; those too near to it go.
  const std::size_t n = points.size() - 1;
  for (std::size_t i = n; i-- > 1;) {
    if (!keep[i]) continue;
    const double hop = (points[n] - points[i]).norm();
    if (hop >= limit(n)) break;
    keep[i] = 0;
    ++report.tiny;
    smallest = std::min(smallest, hop);
  }
  if (report.tiny == 0) return;
  filter(points, radius, rows, keep);
  report.notes.push_back(counted(report.tiny, "point", "points") + " removed that lay within a tiny step, down to " +
                         with_unit(smallest, unit) + ", of another (the median step is " + with_unit(usual, unit) +
                         ")");
}

}  // namespace

CleaningReport clean_points(std::vector<Vec3>& points, std::vector<double>& radius, std::vector<int>& rows,
                            const std::string& unit) {
  CleaningReport report;
  report.points_before = points.size();
  drop_duplicates(points, radius, rows, report);
  drop_caps(points, radius, rows, unit, report);
  drop_tiny(points, radius, rows, unit, report);
  report.points_after = points.size();
  const std::vector<double> steps = hops(points);
  if (steps.empty()) return report;
  report.step_min = *std::min_element(steps.begin(), steps.end());
  double place = 0.0;
  for (const double step : steps) {
    if (step > report.step_max) report.step_max = step, report.step_max_place = place;
    place += step;
  }
  if (const double usual = median(steps); report.step_max > kHuge * usual) {
    report.notes.push_back("a huge step of " + with_unit(report.step_max, unit) +
                           " at S = " + with_unit(report.step_max_place, unit) + " (the median step is " +
                           with_unit(usual, unit) + "): the curve there is a guess");
  }
  return report;
}

CleaningReport clean_stations(std::vector<double>& md, std::vector<double>& inc, std::vector<double>& azi,
                              std::vector<int>& rows, const std::string& unit) {
  CleaningReport report;
  report.points_before = md.size();
  std::size_t to = 0;
  for (std::size_t i = 0; i < md.size(); ++i) {
    if (to > 0 && md[i] == md[to - 1] && inc[i] == inc[to - 1] && azi[i] == azi[to - 1]) {
      ++report.duplicates;
      continue;
    }
    md[to] = md[i], inc[to] = inc[i], azi[to] = azi[i], rows[to] = rows[i];
    ++to;
  }
  md.resize(to), inc.resize(to), azi.resize(to), rows.resize(to);
  report.points_after = to;
  if (report.duplicates > 0)
    report.notes.push_back(counted(report.duplicates, "repeated station", "repeated stations") + " removed");
  std::vector<double> steps;
  double first_wrap = 0.0;
  for (std::size_t i = 1; i < md.size(); ++i) {
    steps.push_back(md[i] - md[i - 1]);
    if (steps.back() > report.step_max) report.step_max = steps.back(), report.step_max_place = md[i - 1];
    if (std::abs(azi[i] - azi[i - 1]) > 180.0 && report.wraps++ == 0) first_wrap = md[i - 1];
  }
  if (steps.empty()) return report;
  report.step_min = *std::min_element(steps.begin(), steps.end());
  if (report.wraps > 0) {
    report.notes.push_back("the azimuth passes north " + counted(report.wraps, "time", "times") + ", first after md " +
                           with_unit(first_wrap, unit) + ": taken the short way round");
  }
  if (const double usual = median(steps); report.step_max > kHuge * usual) {
    report.notes.push_back("no station for " + with_unit(report.step_max, unit) + " after md " +
                           with_unit(report.step_max_place, unit) + " (the median step is " + with_unit(usual, unit) +
                           ")");
  }
  return report;
}

}  // namespace tendril::io
