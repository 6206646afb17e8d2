#include "hdf5_file.hpp"

#include <unistd.h>

#include <cstdio>
#include <limits>

#include "tendril/io/result_json.hpp"

#ifndef TENDRIL_HDF5

namespace tendril::app {

bool has_hdf5() { return false; }
void write_hdf5(const io::StoredResult&, const std::string&) {}

}  // namespace tendril::app

#else

#include <hdf5.h>

namespace tendril::app {
namespace {

using continuation::Contact;

/// An open HDF5 object; closed by the function that fits it.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {
    if (id < 0) throw io::FileError("HDF5 refuses an object of the result");
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() { close_(id_); }
  operator hid_t() const { return id_; }  // NOLINT: the C functions take it as such

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

void check(herr_t status) {
  if (status < 0) throw io::FileError("HDF5 cannot write the result (is the disk full?)");
}

Handle group(hid_t at, const std::string& name) {
  return {H5Gcreate2(at, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose};
}

Handle text_type() {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  check(H5Tset_size(type, H5T_VARIABLE));
  check(H5Tset_cset(type, H5T_CSET_UTF8));
  return {H5Tcopy(type), H5Tclose};
}

void attribute(hid_t at, const char* name, const std::string& text) {
  const Handle type = text_type(), space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle a(H5Acreate2(at, name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  const char* value = text.c_str();
  check(H5Awrite(a, type, &value));
}

void attribute(hid_t at, const char* name, double value) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle a(H5Acreate2(at, name, H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  check(H5Awrite(a, H5T_NATIVE_DOUBLE, &value));
}

void column(hid_t at, const char* name, const std::vector<double>& values, const std::string& unit = {},
            hsize_t width = 1) {
  const hsize_t size[2] = {values.size() / width, width};
  const Handle space(H5Screate_simple(width == 1 ? 1 : 2, size, nullptr), H5Sclose);
  const Handle set(H5Dcreate2(at, name, H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose);
  if (!values.empty()) check(H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()));
  if (!unit.empty()) attribute(set, "unit", unit);
}

void column(hid_t at, const char* name, const std::vector<std::string>& values) {
  std::vector<const char*> texts;
  for (const std::string& value : values) texts.push_back(value.c_str());
  const hsize_t size = values.size();
  const Handle type = text_type(), space(H5Screate_simple(1, &size, nullptr), H5Sclose);
  const Handle set(H5Dcreate2(at, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose);
  if (!texts.empty()) check(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, texts.data()));
}

/// One column from a list of rows.
template <class Rows, class Value>
auto each(const Rows& rows, const Value& value) {
  std::vector<decltype(value(rows.front()))> out;
  for (const auto& row : rows) out.push_back(value(row));
  return out;
}

void write_contacts(hid_t step, const std::vector<Contact>& contacts, const io::Case& c) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const auto unit = [&](io::Dimension d) { return c.si ? std::string(io::si_unit(d)) : std::string(); };
  const std::string m = unit(io::Dimension::length), n = unit(io::Dimension::force),
                    p = unit(io::Dimension::force_per_length);
  const Handle at = group(step, "contacts");
  column(at, "kind", each(contacts, [](const Contact& k) { return std::string(kind_name(k)); }));
  const auto put = [&](const char* name, const std::string& u, auto value) {
    column(at, name, each(contacts, value), u);
  };
  const auto of_line = [&](auto member) { return [=](const Contact& k) { return k.line ? double(k.*member) : none; }; };
  put("start", m, [](const Contact& k) { return k.start; });
  put("end", m, [](const Contact& k) { return k.end; });
  put("s_start", m, [](const Contact& k) { return k.s_start; });
  put("s_end", m, [](const Contact& k) { return k.s_end; });
  put("angle_start", "rad", [](const Contact& k) { return k.angle_start; });
  put("angle_end", "rad", [](const Contact& k) { return k.angle_end; });
  put("force_start", n, [&](const Contact& k) { return k.force_start.value_or(none); });
  put("force_end", n, [&](const Contact& k) { return k.force_end.value_or(none); });
  put("force_distributed", n, of_line(&Contact::force_distributed));
  put("force", n, [](const Contact& k) { return k.force; });
  put("pressure_min", p, of_line(&Contact::pressure_min));
  put("pressure_max", p, of_line(&Contact::pressure_max));
  put("pressure_mid", p, of_line(&Contact::pressure_mid));
  std::vector<double> vectors;
  for (const Contact& k : contacts)
    vectors.insert(vectors.end(), {k.force_vector[0], k.force_vector[1], k.force_vector[2]});
  column(at, "force_vector", vectors, n, 3);
}

void write_step(hid_t steps, std::size_t index, const continuation::Step& s, const io::Case& c) {
  char name[16];
  std::snprintf(name, sizeof name, "%04zu", index + 1);
  const Handle at = group(steps, name);
  if (s.parameter) attribute(at, "parameter", *s.parameter);
  attribute(at, "status", std::string(io::status_name(s.status)));
  attribute(at, "message", s.message);
  attribute(at, "rod_length", s.rod_length);
  attribute(at, "axial_force_start", s.axial_force_start);
  attribute(at, "axial_force_end", s.axial_force_end);
  attribute(at, "torque_start", s.torque_start);
  attribute(at, "torque_end", s.torque_end);
  attribute(at, "push", s.push);
  attribute(at, "stability", s.stability);
  attribute(at, "branch", s.branch);
  {
    const Handle figures = group(at, "certificate");
    const auto& k = s.certificate;
    const std::pair<const char*, double> all[] = {
        {"equilibrium", k.equilibrium},           {"gap_min", k.gap_min},       {"reaction_min", k.reaction_min},
        {"curvature_max", k.curvature_max},       {"continuity", k.continuity}, {"balance", k.balance},
        {"invariant_spread", k.invariant_spread}, {"error", k.error},           {"strain_max", k.strain_max},
        {"phase_multiplier", k.phase_multiplier}};
    for (const auto& [figure, value] : all) attribute(figures, figure, value);
  }
  write_contacts(at, s.contacts, c);
  {
    const Handle segments = group(at, "segments");
    column(segments, "kind", each(s.segments, [](const auto& g) { return std::string(g.line ? "line" : "free"); }));
    column(segments, "start", each(s.segments, [](const auto& g) { return g.start; }));
    column(segments, "end", each(s.segments, [](const auto& g) { return g.end; }));
  }
  column(at, "state", s.state);
  if (s.fields.S.empty()) return;
  const Handle fields = group(at, "fields");
  for (const io::FieldColumn& f : io::field_columns()) {
    const bool told = c.si || f.dimension == io::Dimension::angle;
    column(fields, f.name, s.fields.*f.values, told ? std::string(io::si_unit(f.dimension)) : std::string());
  }
}

void write(const io::StoredResult& stored, const std::string& path) {
  const Handle file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
  const auto& r = stored.result;
  attribute(file, "tendril", stored.version);
  attribute(file, "result_schema", 1.0);
  attribute(file, "title", stored.c.title);
  attribute(file, "units", std::string(stored.c.si ? "m, N, N m, rad" : "as given"));
  attribute(file, "status", std::string(io::status_name(r.status)));
  attribute(file, "message", r.message);
  if (stored.c.path) attribute(file, "parameter", stored.c.path->parameter);
  column(file, "case", std::vector<std::string>{stored.case_text});  // an attribute would be limited to 64 KiB
  {
    const Handle steps = group(file, "steps");
    for (std::size_t i = 0; i < r.steps.size(); ++i) write_step(steps, i, r.steps[i], stored.c);
  }
  {
    const Handle events = group(file, "events");
    column(events, "parameter", each(r.events, [](const auto& e) { return e.parameter; }));
    column(events, "kind", each(r.events, [](const auto& e) { return e.kind; }));
    column(events, "S", each(r.events, [](const auto& e) { return e.S; }));
    column(events, "rod_length", each(r.events, [](const auto& e) { return e.rod_length; }));
    column(events, "axial_force_end", each(r.events, [](const auto& e) { return e.axial_force_end; }));
  }
  {
    const Handle trace = group(file, "trace");
    column(trace, "parameter", each(r.trace, [](const auto& t) { return t.parameter; }));
    column(trace, "rod_length", each(r.trace, [](const auto& t) { return t.rod_length; }));
    column(trace, "axial_force_end", each(r.trace, [](const auto& t) { return t.axial_force_end; }));
    column(trace, "torque_end", each(r.trace, [](const auto& t) { return t.torque_end; }));
    column(trace, "contacts", each(r.trace, [](const auto& t) { return double(t.contacts); }));
  }
  if (!stored.tube.empty()) {
    const Handle tube = group(file, "tube");
    column(tube, "S", each(stored.tube, [](const auto& t) { return t.S; }));
    column(tube, "clearance", each(stored.tube, [](const auto& t) { return t.clearance; }));
    for (const auto& [name, member] : {std::pair{"position", &io::TubeSection::position},
                                       std::pair{"D1", &io::TubeSection::D1}, std::pair{"D2", &io::TubeSection::D2}}) {
      std::vector<double> rows;
      for (const io::TubeSection& t : stored.tube)
        rows.insert(rows.end(), {(t.*member)[0], (t.*member)[1], (t.*member)[2]});
      column(tube, name, rows, {}, 3);
    }
  }
  check(H5Fflush(file, H5F_SCOPE_GLOBAL));
}

}  // namespace

bool has_hdf5() { return true; }

void write_hdf5(const io::StoredResult& stored, const std::string& path) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // its own report goes to stderr; ours names the file
  const std::string part = path + ".part" + std::to_string(::getpid());
  try {
    write(stored, part);
    if (std::rename(part.c_str(), path.c_str()) != 0) throw io::FileError("cannot be written");
  } catch (const io::FileError& error) {
    std::remove(part.c_str());
    throw io::FileError(path + ": " + error.what());
  }
}

}  // namespace tendril::app

#endif
