#include "tendril/io/result_files.hpp"

#include <cmath>
#include <cstdio>

#include "tendril/io/atomic_file.hpp"
#include "tendril/io/result_json.hpp"

namespace tendril::io {
namespace {

using continuation::Contact;
using continuation::Result;
using continuation::Step;

// "force [N]" with si, "force" otherwise.
std::string heading(const Case& c, const std::string& name, Dimension dimension) {
  const std::string unit(si_unit(dimension));
  if (unit.empty()) return name;
  if (dimension == Dimension::angle) return name + " [rad]";
  return c.si ? name + " [" + unit + "]" : name;
}

class CsvWriter {
 public:
  void cell(const std::string& text) {
    if (!first_) out_ += ',';
    first_ = false;
    out_ += text;
  }
  void cell(double value) { cell(std::isfinite(value) ? shortest(value) : std::string()); }
  void cell(const std::optional<double>& value) { cell(value.value_or(NAN)); }
  void end_row() {
    out_ += '\n';
    first_ = true;
  }
  std::string take() { return std::move(out_); }

 private:
  std::string out_;
  bool first_ = true;
};

using D = Dimension;

constexpr FieldColumn kFields[] = {
    {"S", D::length, &continuation::Fields::S},
    {"s", D::length, &continuation::Fields::s},
    {"x", D::length, &continuation::Fields::x},
    {"y", D::length, &continuation::Fields::y},
    {"z", D::length, &continuation::Fields::z},
    {"delta1", D::length, &continuation::Fields::delta1},
    {"delta2", D::length, &continuation::Fields::delta2},
    {"phi", D::angle, &continuation::Fields::phi},
    {"gap", D::length, &continuation::Fields::gap},
    {"pressure", D::force_per_length, &continuation::Fields::pressure},
    {"F1", D::force, &continuation::Fields::F1},
    {"F2", D::force, &continuation::Fields::F2},
    {"F3", D::force, &continuation::Fields::F3},
    {"M1", D::moment, &continuation::Fields::M1},
    {"M2", D::moment, &continuation::Fields::M2},
    {"M3", D::moment, &continuation::Fields::M3},
    {"kappa", D::curvature, &continuation::Fields::kappa},
};

}  // namespace

std::span<const FieldColumn> field_columns() { return kFields; }

std::string contacts_csv(const Case& c, const Result& result) {
  CsvWriter csv;
  for (const char* name : {"step", "parameter", "contact", "kind"}) csv.cell(std::string(name));
  for (const char* name : {"start", "end", "s_start", "s_end"}) csv.cell(heading(c, name, D::length));
  for (const char* name : {"angle_start", "angle_end"}) csv.cell(heading(c, name, D::angle));
  for (const char* name : {"force", "force_start", "force_end", "force_distributed", "force_x", "force_y", "force_z"})
    csv.cell(heading(c, name, D::force));
  for (const char* name : {"pressure_min", "pressure_max", "pressure_mid"})
    csv.cell(heading(c, name, D::force_per_length));
  csv.end_row();
  for (std::size_t i = 0; i < result.steps.size(); ++i) {
    const Step& step = result.steps[i];
    for (std::size_t k = 0; k < step.contacts.size(); ++k) {
      const Contact& contact = step.contacts[k];
      csv.cell(std::to_string(i + 1));
      csv.cell(step.parameter);
      csv.cell(std::to_string(k + 1));
      csv.cell(std::string(kind_name(contact)));
      for (const double v : {contact.start, contact.line ? contact.end : contact.start, contact.s_start,
                             contact.line ? contact.s_end : contact.s_start, contact.angle_start,
                             contact.line ? contact.angle_end : contact.angle_start, contact.force}) {
        csv.cell(v);
      }
      const auto of_line = [&](std::optional<double> value) { return contact.line ? value : std::nullopt; };
      csv.cell(of_line(contact.force_start));
      csv.cell(of_line(contact.force_end));
      csv.cell(of_line(contact.force_distributed));
      for (int j = 0; j < 3; ++j) csv.cell(contact.force_vector[j]);
      csv.cell(of_line(contact.pressure_min));
      csv.cell(of_line(contact.pressure_max));
      csv.cell(of_line(contact.pressure_mid));
      csv.end_row();
    }
  }
  return csv.take();
}

std::string fields_csv(const Case& c, const Result& result) {
  CsvWriter csv;
  csv.cell(std::string("step"));
  csv.cell(std::string("parameter"));
  for (const FieldColumn& column : kFields) csv.cell(heading(c, column.name, column.dimension));
  csv.end_row();
  for (std::size_t i = 0; i < result.steps.size(); ++i) {
    const continuation::Fields& fields = result.steps[i].fields;
    for (std::size_t row = 0; row < fields.S.size(); ++row) {
      csv.cell(std::to_string(i + 1));
      csv.cell(result.steps[i].parameter);
      for (const FieldColumn& column : kFields) {
        const auto& values = fields.*column.values;
        csv.cell(row < values.size() ? values[row] : NAN);
      }
      csv.end_row();
    }
  }
  return csv.take();
}

void write_results(const Case& c, const Result& result, const std::string& directory) {
  make_directory(directory);
  const std::string base = directory + "/";
  write_file(base + "result.json", result_json(c, result, true));
  write_file(base + "contacts.csv", contacts_csv(c, result));
  write_file(base + "fields.csv", fields_csv(c, result));
  write_file(base + "tube.vtp", tube_vtp(c));
  if (result.steps.empty()) return;
  write_file(base + "rod.vtp", rod_vtp(c, result.steps.back()));
  if (!c.path) return;
  std::vector<std::string> files;
  for (std::size_t i = 0; i < result.steps.size(); ++i) {
    char name[32];
    std::snprintf(name, sizeof name, "rod_%04zu.vtp", i + 1);
    files.emplace_back(name);
    write_file(base + name, rod_vtp(c, result.steps[i]));
  }
  write_file(base + "rod.pvd", paraview_list(result, files));
}

}  // namespace tendril::io
