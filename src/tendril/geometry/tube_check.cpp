#include "tendril/geometry/tube_check.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "tendril/geometry/error.hpp"

namespace tendril::geometry {

namespace {

struct Sample {
  double S, clearance, curvature;
  double product() const { return clearance * curvature; }
};

Sample sample(const Tube& tube, double S) {
  return {S, tube.clearance->at(S)[0], tube.axis->at(S).U[0].head<2>().norm()};
}

// Ends, knots of axis and clearance, and equal parts between: at least kFewest intervals in all.
std::vector<double> places(const Tube& tube) {
  constexpr double kFewest = 1000.0;
  constexpr int kBetweenKnots = 4;
  const double length = tube.length();
  std::vector<double> fixed{0.0, length};
  for (const auto* knots : {&tube.axis->knots(), &tube.clearance->knots()}) {
    for (double knot : *knots) {
      if (knot > 0.0 && knot < length) fixed.push_back(knot);
    }
  }
  std::sort(fixed.begin(), fixed.end());
  std::vector<double> all;
  for (std::size_t i = 0; i + 1 < fixed.size(); ++i) {
    const double width = fixed[i + 1] - fixed[i];
    if (!(width > 0.0)) continue;
    const int parts = std::max(kBetweenKnots, static_cast<int>(std::ceil(kFewest * width / length)));
    for (int k = 0; k < parts; ++k) all.push_back(fixed[i] + width * k / parts);
  }
  all.push_back(length);
  return all;
}

// Largest value of `measure` near sample i, by golden section between its neighbours.
Sample largest_near(const Tube& tube, const std::vector<Sample>& samples, std::size_t i,
                    const std::function<double(const Sample&)>& measure) {
  constexpr double kGolden = 0.6180339887498949;
  double a = samples[i > 0 ? i - 1 : i].S, b = samples[std::min(i + 1, samples.size() - 1)].S;
  Sample best = samples[i];
  for (int step = 0; step < 40; ++step) {
    const Sample left = sample(tube, b - kGolden * (b - a)), right = sample(tube, a + kGolden * (b - a));
    const double at_left = measure(left), at_right = measure(right);
    if (at_left > measure(best)) best = left;
    if (at_right > measure(best)) best = right;
    if (at_left > at_right) {
      b = right.S;
    } else {
      a = left.S;
    }
  }
  return best;
}

Sample largest(const Tube& tube, const std::vector<Sample>& samples,
               const std::function<double(const Sample&)>& measure) {
  const auto it = std::max_element(samples.begin(), samples.end(),
                                   [&](const Sample& a, const Sample& b) { return measure(a) < measure(b); });
  return largest_near(tube, samples, static_cast<std::size_t>(it - samples.begin()), measure);
}

// One issue for each stretch where `measure` exceeds `bound`, at its worst place.
void collect(const Tube& tube, const std::vector<Sample>& samples, const std::function<double(const Sample&)>& measure,
             double bound, const std::function<Issue(const Sample&)>& issue, std::vector<Issue>& issues) {
  constexpr std::size_t kMostIssues = 20;
  for (std::size_t i = 0; i < samples.size() && issues.size() < kMostIssues; ++i) {
    if (measure(samples[i]) < bound) continue;
    std::size_t worst = i;
    for (; i < samples.size() && measure(samples[i]) >= bound; ++i) {
      if (measure(samples[i]) > measure(samples[worst])) worst = i;
    }
    issues.push_back(issue(largest_near(tube, samples, worst, measure)));
  }
}

}  // namespace

TubeQuality measure_tube(const Tube& tube, std::vector<Issue>& issues) {
  if (!tube.axis || !tube.clearance) {
    throw GeometryError({"tube", 0.0, 0.0, 0.0, tube.axis ? "has no clearance" : "has no axis", ""});
  }
  require_positive(issues, "axis.length", tube.length());
  throw_if_any(issues);

  std::vector<Sample> samples;
  for (double S : places(tube)) {
    samples.push_back(sample(tube, S));
    const Sample& last = samples.back();
    if (!std::isfinite(last.clearance) || !std::isfinite(last.curvature)) {
      const bool bore = !std::isfinite(last.clearance);
      throw GeometryError(
          {bore ? "clearance" : "axis", S, bore ? last.clearance : last.curvature, 0.0,
           std::string(bore ? "the clearance" : "the curvature") + " is not finite at S = " + number_text(S),
           "the law must cover the whole axis"});
    }
  }

  const auto product = [](const Sample& s) { return s.product(); };
  const auto narrow = [](const Sample& s) { return -s.clearance; };
  const auto wide = [](const Sample& s) { return s.clearance; };
  const auto bent = [](const Sample& s) { return s.curvature; };
  const Sample narrowest = largest(tube, samples, narrow);
  const Sample tightest = largest(tube, samples, product);

  collect(
      tube, samples, narrow, 0.0,
      [](const Sample& s) {
        return Issue{"clearance",
                     s.S,
                     s.clearance,
                     0.0,
                     "is " + number_text(s.clearance) + " at S = " + number_text(s.S) + ", must be greater than 0",
                     "the rod must fit the tube everywhere"};
      },
      issues);
  if (issues.empty() && !(narrowest.clearance > 0.0)) {
    issues.push_back({"clearance", narrowest.S, narrowest.clearance, 0.0,
                      "falls to " + number_text(narrowest.clearance) + " at S = " + number_text(narrowest.S), ""});
  }
  const auto too_tight = [](const Sample& s) {
    return Issue{"clearance x curvature",
                 s.S,
                 s.product(),
                 1.0,
                 "is " + number_text(s.product()) + " at S = " + number_text(s.S) + " (clearance " +
                     number_text(s.clearance) + ", radius of curvature " + number_text(1.0 / s.curvature) +
                     "), must be below 1: neighbouring sections of the tube cross",
                 "smooth the axis, cut this part off, or reduce the clearance"};
  };
  const std::size_t before = issues.size();
  collect(tube, samples, product, 1.0, too_tight, issues);
  if (issues.size() == before && !(tightest.product() < 1.0)) issues.push_back(too_tight(tightest));

  TubeQuality quality{};
  quality.length = tube.length();
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double width = samples[i].S - samples[i - 1].S;
    const double middle = sample(tube, 0.5 * (samples[i].S + samples[i - 1].S)).curvature;
    quality.total_bend += width * (samples[i - 1].curvature + 4.0 * middle + samples[i].curvature) / 6.0;  // Simpson
  }
  const Sample sharpest = largest(tube, samples, bent), widest = largest(tube, samples, wide);
  quality.curvature_max = sharpest.curvature;
  quality.curvature_max_S = sharpest.S;
  quality.curvature_clearance_max = tightest.product();
  quality.curvature_clearance_max_S = tightest.S;
  quality.clearance_min = narrowest.clearance;
  quality.clearance_min_S = narrowest.S;
  quality.clearance_max = widest.clearance;
  quality.clearance_max_S = widest.S;
  return quality;
}

TubeQuality check_tube(const Tube& tube) {
  std::vector<Issue> issues;
  const TubeQuality quality = measure_tube(tube, issues);
  throw_if_any(std::move(issues));
  return quality;
}

}  // namespace tendril::geometry
