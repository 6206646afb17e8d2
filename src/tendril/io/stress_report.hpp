#pragma once
// The most stressed section of a solved step, where the case tells the rod's modulus and section (A.1).

#include <optional>

#include "tendril/continuation/result.hpp"
#include "tendril/io/case.hpp"
#include "tendril/rod/section_stress.hpp"

namespace tendril::io {

struct StressReport {
  double S = 0.0;              // where the von Mises stress is largest, among 4001 places along the axis  [length]
  rod::SectionStress section;  // there; `strain` is the largest along the rod
};

/// None without `rod.young_modulus`, or without a state.
std::optional<StressReport> stress_report(const Case& c, const continuation::Step& step);

}  // namespace tendril::io
