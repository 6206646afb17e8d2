#pragma once
// Internal to io: from the numbers of a case to the parts of a problem, with each problem reported at its key.

#include <cmath>
#include <functional>
#include <map>

#include "tendril/io/case.hpp"

namespace tendril::io {

/// Where a key was written; a key that was not takes its table's place.
struct Locator {
  const std::map<std::string, Place>* places = nullptr;
  Place fallback;
  Place at(std::string key) const;
};

/// A check in progress: the case, where its keys are, what is wrong so far.
struct Check {
  const Case& c;
  Locator where;
  Issues& issues;
  std::vector<std::string>* notes = nullptr;  // where to tell what was done to the geometry, if at all
  CurveReport* curve = nullptr;

  /// Given, even if with a wrong value that has been reported already.
  bool given(const std::string& key) const { return c.has(key) || issues.has(key); }
  Issue& add(const std::string& key, std::string message) const {
    return issues.add(where.at(key), key, std::move(message));
  }
  /// Exactly one of the keys: reports none at `table`, the second of several at its place. The one given, or "".
  std::string exactly_one(const std::string& table, const std::vector<std::string>& keys, const std::string& why) const;
};

rod::Rod assemble_rod(const Check& check);
/// [[rod.section]]; a uniform law without.
rod::SectionLaw assemble_sections(const Check& check, const rod::Rod& base);
bool has_sections(const Case& c);
/// How distances along the rod are counted: from its start or, where all that is measured is measured from there, from
/// its far end backwards.
struct ArcCount {
  bool from_end = false, mixed = false;
  double length = HUGE_VAL;  // of the rod, where given
  double at(double distance, bool measured_from_end) const {
    return !measured_from_end ? distance : mixed ? length - distance : -distance;
  }
};
/// Nothing where it cannot be told: reported.
std::optional<ArcCount> arc_count(const Check& check);
/// [[rod.collar]] and [[load.point]].
std::vector<rod::Collar> assemble_collars(const Check& check);
std::vector<rod::PointLoad> assemble_point_loads(const Check& check);
rod::BodyLoad assemble_load(const Check& check);
/// Axis and clearance; nothing when they cannot be built.
std::optional<geometry::Tube> assemble_tube(const Check& check);
/// The same tube with its clearance scaled: reported where it could not be handled.
void check_scaled_tube(const Check& check, const geometry::Tube& tube, double factor);
/// Ends and their conditions.
void assemble_ends(const Check& check, segmentation::Problem& problem);
/// What needs rod, ends and tube together: positions inside the axis, eccentricities on the right side of the wall.
void check_together(const Check& check, const segmentation::Problem& problem);

/// Everything; a tube that is passed in is taken as checked and not built again.
segmentation::Problem assemble(const Check& check, const geometry::Tube* tube);

/// Put a value of the path parameter into the case, or find what it is now.
void set_parameter(Case& c, const std::string& parameter, double value);
std::optional<double> current_value(const Case& c, const std::string& parameter);
/// Rebuilding geometry is needed when this key changes.
bool changes_tube(const std::string& parameter);
/// Read [path] from its table and check the problem at every listed value.
void read_path(Case& c, const Node& table, const Locator& where, Issues& issues);

/// Read [insertion] from its table.
void read_insertion(Case& c, const Node& table, const Locator& where, Issues& issues);

/// One quantity of a node: number or string with unit. Reports and returns nothing when it is wrong.
std::optional<double> read_quantity(const Node& node, const Key& key, Dimension dimension, bool si, Issues& issues);

/// `key=value` into the tree: the value replaces the file's, an empty value removes the key.
void apply_override(Node& root, const std::string& text, Issues& issues);

}  // namespace tendril::io
