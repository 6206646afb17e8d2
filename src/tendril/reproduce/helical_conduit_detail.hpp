#pragma once
// Parts of the system `helical_conduit`: the problem, what is kept of its paths, the pictures. L = B = 1.

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "tendril/closed_form/helical_conduit.hpp"
#include "tendril/continuation/result.hpp"
#include "tendril/reproduce/system.hpp"
#include "tendril/segmentation/chain.hpp"

namespace tendril::reproduce::conduit {

using continuation::Contact;
using continuation::Event;
using continuation::Result;
using continuation::Step;
using segmentation::Chain;
using segmentation::Problem;

constexpr double kPitch = std::numbers::pi / 4, kEta = 1.0 / 20, kTorque = -1.0;

struct Conduit {
  closed_form::HelicalConduit shape{kPitch, 1 / (std::numbers::pi * std::numbers::sqrt2)};
  double T0 = closed_form::axis_tension(shape, kTorque, kEta);
  double unit = std::abs(T0);

  /// D1 is the Frenet normal in the middle.
  Problem problem(double clearance, double T) const;
  Chain state(double clearance, const Step& step) const;
};

/// What the middle of the rod shows.
struct Middle {
  double delta_1 = 0, curvature = 0, sin2 = 0;  // sin2: of the angle between d3 and D3
};

struct Branch {
  double clearance = 0;
  int side = 0;  // -1 compression, the outer side; +1 tension, the inner side
  Result result;
  std::vector<Middle> middle;  // of every step
  const Step& at(double load, double unit) const {
    return *std::min_element(result.steps.begin(), result.steps.end(), [&](const Step& a, const Step& b) {
      return std::abs(*a.parameter - load * unit) < std::abs(*b.parameter - load * unit);
    });
  }
};

/// Both sides of one clearance as one course of states, from the greatest compression to the greatest tension.
struct Course {
  double clearance = 0;
  std::vector<const Step*> step;
  std::vector<Middle> middle;
};

/// The events of one branch, for the marks.
struct Marked {
  int colour = 0;
  double clearance = 0, side = 0, first = 0, first_length = 0, line = 0, line_length = 0, reaction = 0;
  double first_curvature = 0, curvature = 0;
};

Picture early_picture(const Conduit& conduit, const std::vector<Course>& courses, const std::vector<Marked>& events);
Picture late_picture(const Conduit& conduit, const std::vector<Course>& courses, const std::vector<Marked>& events);
Picture free_picture(const continuation::Fields& fields);
/// The rod in the conduit in the states of these branches at these loads.
Picture body_picture(const Conduit& conduit, const std::string& name, const std::string& caption,
                     const std::vector<std::pair<const Branch*, double>>& states);
Course joined(const Branch& compression, const Branch& tension);
Data course_data(const std::string& name, const Course& course, double unit);

}  // namespace tendril::reproduce::conduit
