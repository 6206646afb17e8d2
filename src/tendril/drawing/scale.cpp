#include "tendril/drawing/scale.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "tendril/drawing/text.hpp"

namespace tendril::drawing {
namespace {

std::string with_minus_sign(std::string text) {
  return !text.empty() && text[0] == '-' ? "\u2212" + text.substr(1) : text;
}

std::string power_of_ten(int exponent) {
  static const std::array<const char*, 10> digits = {"\u2070", "\u00B9", "\u00B2", "\u00B3", "\u2074",
                                                     "\u2075", "\u2076", "\u2077", "\u2078", "\u2079"};
  std::string out = "10";
  for (const char c : std::to_string(exponent)) out += c == '-' ? "\u207B" : digits[static_cast<std::size_t>(c - '0')];
  return out;
}

std::vector<Tick> linear_ticks(double low, double high, int wanted) {
  const double raw = (high - low) / std::max(wanted, 1);
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  const double ratio = raw / power;
  const double step = power * (ratio < 1.5 ? 1 : ratio < 3.5 ? 2 : ratio < 7.5 ? 5 : 10);
  // Plain decimals where they are short, else a power of ten common to the axis.
  const double largest = std::max(std::abs(low), std::abs(high));
  const int magnitude = static_cast<int>(std::floor(std::log10(largest)));
  const int exponent = magnitude >= 5 || magnitude <= -4 ? magnitude : 0;
  const double unit = std::pow(10.0, exponent);
  const int decimals = std::max(0, -static_cast<int>(std::floor(std::log10(step / unit) + 1e-9)));
  std::vector<Tick> list;
  const double slack = 1e-9 * step;
  for (double k = std::ceil((low - slack) / step); k * step <= high + slack; k += 1.0) {
    const double value = k * step;
    std::string label = k == 0.0 ? "0" : with_minus_sign(fixed(value / unit, std::min(decimals, 15)));
    if (k != 0.0 && exponent != 0) label += "\u00D7" + power_of_ten(exponent);
    list.push_back({value, label});
  }
  return list;
}

std::vector<Tick> logarithmic_ticks(double low, double high, int wanted) {
  const int first = static_cast<int>(std::floor(std::log10(low) + 1e-9));
  const int last = static_cast<int>(std::ceil(std::log10(high) - 1e-9));
  const int stride = std::max(1, (last - first) / std::max(wanted, 1));
  const bool few = last - first <= 2;
  std::vector<Tick> list;
  for (int e = first; e <= last; ++e) {
    for (int m = 1; m < 10; ++m) {
      const double value = m * std::pow(10.0, e);
      if (value < low * (1 - 1e-9) || value > high * (1 + 1e-9)) continue;
      const bool labelled = m == 1 ? (e - first) % stride == 0 : few && (m == 2 || m == 5);
      if (!labelled && m != 1 && last - first > 6) continue;
      std::string label;
      if (labelled && e >= -2 && e <= 3) {
        label = fixed(value, std::max(0, -e));
      } else if (labelled) {
        label = (m == 1 ? "" : std::to_string(m) + "\u00D7") + power_of_ten(e);
      }
      list.push_back({value, label});
    }
  }
  return list;
}

std::string hex(const std::array<double, 3>& rgb) {
  static const char* digits = "0123456789abcdef";
  std::string out = "#";
  for (const double c : rgb) {
    const int n = static_cast<int>(std::lround(std::clamp(c, 0.0, 255.0)));
    out += digits[n / 16];
    out += digits[n % 16];
  }
  return out;
}

}  // namespace

double Scale::operator()(double value) const {
  if (!logarithmic) return (value - from) / (to - from);
  if (!(value > 0)) return std::numeric_limits<double>::quiet_NaN();
  return std::log(value / from) / std::log(to / from);
}

std::vector<Tick> ticks(const Scale& scale, int wanted) {
  const auto [low, high] = std::minmax(scale.from, scale.to);
  std::vector<Tick> list = scale.logarithmic ? logarithmic_ticks(low, high, wanted) : linear_ticks(low, high, wanted);
  const bool labelled = std::any_of(list.begin(), list.end(), [](const Tick& t) { return !t.label.empty(); });
  // Less than a decade between two round numbers: ordinary ticks serve better.
  if (scale.logarithmic && !labelled) list = linear_ticks(low, high, wanted);
  return list;
}

Scale scale_of(const std::vector<double>& values, bool logarithmic) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double v : values) {
    if (!std::isfinite(v) || (logarithmic && !(v > 0))) continue;
    low = std::min(low, v);
    high = std::max(high, v);
  }
  if (!(low <= high)) return logarithmic ? Scale{0.1, 10.0, true} : Scale{0.0, 1.0, false};
  constexpr double kMargin = 0.04, kNoise = 1e-9;
  if (logarithmic) {
    const double factor = std::max(std::pow(high / low, kMargin), high / low < 1 + kNoise ? 2.0 : 1.0);
    return {low / factor, high * factor, true};
  }
  const double span = high - low, size = std::max(std::abs(low), std::abs(high));
  const double margin = span > kNoise * size && span > 0 ? kMargin * span : size > 0 ? 0.5 * size : 0.5;
  return {low - margin, high + margin, false};
}

std::string palette(int index) {
  static const std::array<const char*, 8> colours = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                     "#e69f00", "#56b4e9", "#000000", "#7f7f7f"};
  const int size = static_cast<int>(colours.size());
  return colours[static_cast<std::size_t>(((index % size) + size) % size)];
}

std::string diverging_colour(double t) {
  static const std::array<std::array<double, 3>, 7> stops = {
      {{5, 48, 97}, {33, 102, 172}, {96, 160, 208}, {190, 190, 190}, {240, 140, 105}, {200, 40, 50}, {110, 0, 31}}};
  const double place = (std::clamp(std::isfinite(t) ? t : 0.0, -1.0, 1.0) + 1) / 2 * (stops.size() - 1);
  const std::size_t i = std::min(static_cast<std::size_t>(place), stops.size() - 2);
  const double f = place - static_cast<double>(i);
  std::array<double, 3> rgb{};
  for (std::size_t c = 0; c < 3; ++c) rgb[c] = (1 - f) * stops[i][c] + f * stops[i + 1][c];
  return hex(rgb);
}

}  // namespace tendril::drawing
