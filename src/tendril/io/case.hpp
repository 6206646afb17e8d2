#pragma once
// A case file, read and checked: every number in SI or, dimensionless, as written; defaults not filled in. A Case can
// be turned into the problem at any value of its path parameter. Reading collects all problems and throws one
// InputError.

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tendril/continuation/insertion.hpp"
#include "tendril/continuation/study.hpp"
#include "tendril/io/diagnostics.hpp"
#include "tendril/io/keys.hpp"
#include "tendril/segmentation/problem.hpp"

namespace tendril::io {

struct Centreline;  // centreline.hpp

/// How the curve of a file or of points was laid, in case units.
struct CurveReport {
  double smoothing = 0.0;                   // tolerance of the points; 0: the curve passes through them
  bool automatic = false;                   // the tolerance was not given, but needed
  double deviation = 0.0, deviation_S = 0;  // largest distance from the points, or of a survey from minimum curvature
  double radius_smoothing = 0.0;            // tolerance of the radius column
  double radius_deviation = 0.0, radius_deviation_S = 0;
};

/// The [path] of a case. Scalars with a rate follow the parameter smoothly; any other number rebuilds the problem.
struct PathRequest {
  std::string parameter;  // key path, "end.slope.0"
  Dimension dimension = Dimension::none;
  double start = 0.0;          // the case's own value
  std::vector<double> values;  // listed values, in order
  bool smooth = true;
  bool motion = false;  // an [insertion]: values belong to it where it lists them, and nothing is rebuilt
};

struct Case {
  std::string name;  // file name as given
  std::string title;
  bool si = false;                                     // units = "si"
  std::map<std::string, std::vector<double>> numbers;  // by key path; lists of pairs flattened
  std::map<std::string, std::string> words;            // strings, words and booleans ("true")
  std::shared_ptr<const Centreline> centreline;        // kinds points and survey
  std::optional<PathRequest> path;
  geometry::Tube tube;             // of the case as written
  CurveReport curve;               // kinds points and survey
  std::vector<std::string> notes;  // worth telling, not wrong

  bool has(const std::string& key) const { return numbers.count(key) != 0 || words.count(key) != 0; }
  double number(const std::string& key, double fallback = 0.0) const;
  double component(const std::string& key, std::size_t i, double fallback = 0.0) const;
  std::string word(const std::string& key, const std::string& fallback = {}) const;
};

/// Read a case file (.json: JSON, anything else: TOML) with `key=value` overrides. Throws InputError, FileError.
Case read_case(const std::string& file, const std::vector<std::string>& overrides = {});

enum class Format { toml, json };
/// The same for a text; `directory` is where its relative file names start.
Case parse_case(const std::string& text, const std::string& name, Format format,
                const std::vector<std::string>& overrides = {}, const std::string& directory = {});

/// The problem at value `parameter` of the path parameter (ignored without a path).
segmentation::Problem build_problem(const Case& c, double parameter);
segmentation::Problem build_problem(const Case& c);

/// [solve] and [path] for the mechanics.
segmentation::SolveOptions solve_options(const Case& c);
continuation::Path study_path(const Case& c);
/// [insertion] of a case whose path is a motion.
continuation::Insertion insertion(const Case& c);
/// What every face does with a case: one state, its path or its insertion.
continuation::Result run(const Case& c, const continuation::StudyOptions& options);

/// What the weight in air is multiplied by: 1 - fluid_density / density.
double buoyancy_factor(const Case& c);

/// Radius of the rod where the case tells it.
std::optional<double> rod_radius(const Case& c);

}  // namespace tendril::io
