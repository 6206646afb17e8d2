// Result: steps, events and trace. Columns of numbers are read-only views of the result's own memory; each holds on to
// the step it belongs to, and the step to its result.

#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <limits>

#include "bindings.hpp"
#include "tendril/io/result_files.hpp"
#include "tendril/io/result_json.hpp"
#include "tendril/report/page.hpp"

namespace tendril::python {
namespace {

using continuation::Certificate;
using continuation::Contact;
using continuation::Effort;
using continuation::Fields;
using continuation::Step;

using View = nb::ndarray<nb::numpy, const double, nb::ndim<1>>;

View view(const std::vector<double>& values, nb::handle owner) { return View(values.data(), {values.size()}, owner); }

/// In the order and by the names of the result file; what a point or a clamp does not have is NaN.
nb::tuple contact_row(const Contact& k) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const auto of_line = [&](double value) { return k.line ? value : none; };
  return nb::make_tuple(kind_name(k), k.start, k.line ? k.end : k.start, k.s_start, k.line ? k.s_end : k.s_start,
                        k.angle_start, k.line ? k.angle_end : k.angle_start, of_line(k.force_start.value_or(none)),
                        of_line(k.force_end.value_or(none)), of_line(k.force_distributed), k.force,
                        nb::make_tuple(k.force_vector[0], k.force_vector[1], k.force_vector[2]),
                        of_line(k.pressure_min), of_line(k.pressure_max), of_line(k.pressure_mid));
}

/// Unit of each number that is drawn or tabulated, by its name in the result file; empty without one.
nb::dict units(const Solved& self) {
  const io::Case& c = self.of->c;
  nb::dict by_name;
  const auto put = [&](const char* name, io::Dimension dimension) {
    const bool told = c.si || dimension == io::Dimension::angle;
    by_name[name] = told ? std::string(io::si_unit(dimension)) : std::string();
  };
  for (const io::FieldColumn& column : io::field_columns()) put(column.name, column.dimension);
  for (const char* name : {"start", "end", "rod_length"}) put(name, io::Dimension::length);
  for (const char* name : {"force", "axial_force_start", "axial_force_end", "push"}) put(name, io::Dimension::force);
  for (const char* name : {"torque_start", "torque_end"}) put(name, io::Dimension::moment);
  put("parameter", c.path ? c.path->dimension : io::Dimension::none);
  return by_name;
}

void bind_step(nb::module_& m) {
  nb::class_<Certificate>(m, "Certificate")
      .def_ro("equilibrium", &Certificate::equilibrium)
      .def_ro("gap_min", &Certificate::gap_min)
      .def_ro("reaction_min", &Certificate::reaction_min)
      .def_ro("curvature_max", &Certificate::curvature_max)
      .def_ro("continuity", &Certificate::continuity)
      .def_ro("balance", &Certificate::balance)
      .def_ro("invariant_spread", &Certificate::invariant_spread)
      .def_ro("error", &Certificate::error)
      .def_ro("strain_max", &Certificate::strain_max)
      .def_ro("phase_multiplier", &Certificate::phase_multiplier);
  nb::class_<Effort>(m, "Effort")
      .def_ro("newton_iterations", &Effort::newton_iterations)
      .def_ro("factorisations", &Effort::factorisations)
      .def_ro("patterns_tried", &Effort::patterns_tried)
      .def_ro("wall_seconds", &Effort::wall_seconds);
  nb::class_<Step>(m, "Step")
      .def_ro("parameter", &Step::parameter)
      .def_prop_ro("status", [](const Step& self) { return std::string(io::status_name(self.status)); })
      .def_ro("message", &Step::message)
      .def_ro("rod_length", &Step::rod_length)
      .def_ro("axial_force_start", &Step::axial_force_start)
      .def_ro("axial_force_end", &Step::axial_force_end)
      .def_ro("torque_start", &Step::torque_start)
      .def_ro("torque_end", &Step::torque_end)
      .def_ro("push", &Step::push)
      .def_ro("stability", &Step::stability)
      .def_ro("branch", &Step::branch)
      .def_prop_ro(
          "certificate", [](const Step& self) -> const Certificate& { return self.certificate; },
          nb::rv_policy::reference_internal)
      .def_prop_ro(
          "effort", [](const Step& self) -> const Effort& { return self.effort; }, nb::rv_policy::reference_internal)
      .def("contacts",
           [](const Step& self) {
             nb::list rows;
             for (const Contact& contact : self.contacts) rows.append(contact_row(contact));
             return rows;
           })
      .def("segments",
           [](const Step& self) {
             nb::list rows;
             for (const auto& s : self.segments) rows.append(nb::make_tuple(s.line ? "line" : "free", s.start, s.end));
             return rows;
           })
      .def(
          "field",
          [](nb::handle_t<Step> self, std::size_t index) {
            const Step& step = nb::cast<const Step&>(self);
            return view(step.fields.*io::field_columns()[index].values, self);
          },
          nb::arg("index"))
      .def_prop_ro("state", [](nb::handle_t<Step> self) { return view(nb::cast<const Step&>(self).state, self); });
}

}  // namespace

void bind_result(nb::module_& m) {
  bind_step(m);
  nb::list names;
  for (const io::FieldColumn& column : io::field_columns()) names.append(column.name);
  m.attr("HAS_PAGE") = report::available();
  m.attr("FIELDS") = nb::tuple(names);
  nb::class_<Solved>(m, "Result")
      .def_prop_ro("status", [](const Solved& self) { return std::string(io::status_name(self.result.status)); })
      .def_prop_ro("message", [](const Solved& self) { return self.result.message; })
      .def_prop_ro("interrupted", [](const Solved& self) { return self.result.interrupted; })
      .def("__len__", [](const Solved& self) { return self.result.steps.size(); })
      .def(
          "step", [](const Solved& self, std::size_t i) -> const Step& { return self.result.steps.at(i); },
          nb::rv_policy::reference_internal, nb::arg("index"))
      .def("events",
           [](const Solved& self) {
             nb::list rows;
             for (const auto& e : self.result.events)
               rows.append(nb::make_tuple(e.parameter, e.kind, e.S, e.rod_length, e.axial_force_end));
             return rows;
           })
      .def("trace",
           [](const Solved& self) {
             nb::list rows;
             for (const auto& t : self.result.trace)
               rows.append(nb::make_tuple(t.parameter, t.rod_length, t.axial_force_end, t.torque_end, t.contacts));
             return rows;
           })
      .def("units", &units)
      .def(
          "json", [](const Solved& self, bool fields) { return io::result_json(self.of->c, self.result, fields); },
          nb::arg("fields"), nb::call_guard<nb::gil_scoped_release>())
      .def("picture", &picture, nb::arg("index"), nb::call_guard<nb::gil_scoped_release>())
      .def(
          "page", [](const Solved& self) { return report::page(io::result_json(self.of->c, self.result, true)); },
          nb::call_guard<nb::gil_scoped_release>())
      .def(
          "write",
          [](const Solved& self, const std::string& directory) {
            io::write_results(self.of->c, self.result, directory);
          },
          nb::arg("directory"), nb::call_guard<nb::gil_scoped_release>());
}

}  // namespace tendril::python
