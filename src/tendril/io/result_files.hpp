#pragma once
// The directory of results: result.json, contacts.csv, fields.csv, and for ParaView rod.vtp, tube.vtp and, for a path,
// one rod file per step with rod.pvd. Every file is written whole or not at all.

#include <span>
#include <string>

#include "tendril/continuation/result.hpp"
#include "tendril/io/case.hpp"

namespace tendril::io {

/// A column of the fields: its name in every file, what it measures, where its values are.
struct FieldColumn {
  const char* name;
  Dimension dimension;
  std::vector<double> continuation::Fields::*values;
};
std::span<const FieldColumn> field_columns();

std::string contacts_csv(const Case& c, const continuation::Result& result);
std::string fields_csv(const Case& c, const continuation::Result& result);

/// The rod as a polyline with point data (PolyData XML, raw appended).
std::string rod_vtp(const Case& c, const continuation::Step& step);
/// One section of the tube: axis, frame and clearance.
struct TubeSection {
  double S = 0.0;
  geometry::Vec3 position, D1, D2;
  double clearance = 0.0;
};
/// The wall through sections; `wall` is its distance from the axis less the clearance.
std::string tube_vtp(const std::vector<TubeSection>& sections, double wall);
/// The wall as a swept surface; its radius is the bore's where the case gives it, else the clearance.
std::string tube_vtp(const Case& c);
/// List of time steps; `files` belong to `result.steps` one to one.
std::string paraview_list(const continuation::Result& result, const std::vector<std::string>& files);

/// Everything into `directory`, which is created. Needs steps with fields. Throws FileError.
void write_results(const Case& c, const continuation::Result& result, const std::string& directory);

}  // namespace tendril::io
