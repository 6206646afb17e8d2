// A rod in motion: the session of the library, its states as results. Python's threads may share a session: one moves
// or reads it at a time, and none holds the interpreter meanwhile.

#include "tendril/continuation/session.hpp"

#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <memory>
#include <mutex>

#include "bindings.hpp"

namespace tendril::python {
namespace {

using continuation::Session;

struct Moving {
  CasePtr of;
  std::unique_ptr<Session> session;
  mutable std::mutex busy;
};
using MovingPtr = std::shared_ptr<Moving>;

MovingPtr begin(const CasePtr& of) {
  auto moving = std::make_shared<Moving>();
  moving->of = of;
  continuation::StudyOptions study;
  study.solve = io::solve_options(of->c);
  beside_interpreter([&](const std::atomic<bool>& stop) {
    study.stop = &stop;
    moving->session = std::make_unique<Session>(io::build_problem(of->c), study);
    moving->session->set_stop(nullptr);  // `stop` ends here
  });
  return moving;
}

/// Ctrl-C leaves the session at the last state reached.
Session::Motion move(const MovingPtr& m, double by, Session::Motion (Session::*how)(double)) {
  Session::Motion motion;
  beside_interpreter([&](const std::atomic<bool>& stop) {
    const std::lock_guard lock(m->busy);
    m->session->set_stop(&stop);
    motion = (m->session.get()->*how)(by);
    m->session->set_stop(nullptr);
  });
  return motion;
}

SolvedPtr state(const MovingPtr& m, int points) {
  const std::lock_guard lock(m->busy);
  auto solved = std::make_shared<Solved>();
  solved->of = m->of;
  continuation::Step s = m->session->state(points);
  solved->result.status = s.status;
  solved->result.message = s.message;
  solved->result.steps.push_back(std::move(s));
  solved->result.events = m->session->events();
  return solved;
}

}  // namespace

void bind_session(nb::module_& m) {
  using Snapshot = Session::Snapshot;
  using Motion = Session::Motion;
  using without_gil = nb::call_guard<nb::gil_scoped_release>;
  nb::class_<Snapshot>(m, "Snapshot");
  nb::class_<Motion>(m, "Motion")
      .def_ro("reached", &Motion::reached)
      .def_ro("reason", &Motion::reason)
      .def_ro("substeps", &Motion::substeps)
      .def_ro("jumped", &Motion::jumped)
      .def("__bool__", [](const Motion& self) { return self.reached; })
      .def("__repr__", [](const Motion& self) {
        return "<tendril.Motion: " + (self.reached ? std::string("reached") : "not reached, " + self.reason) +
               (self.jumped ? ", with a jump>" : ">");
      });
  nb::class_<Moving>(m, "Session")
      .def_static("begin", &begin, nb::arg("case"))
      .def_prop_ro("ready", [](const Moving& self) { return self.session->ready(); })
      .def_prop_ro("reason", [](const Moving& self) { return self.session->reason(); })
      .def(
          "advance", [](const MovingPtr& self, double by) { return move(self, by, &Session::advance); },
          nb::arg("distance"))
      .def(
          "rotate", [](const MovingPtr& self, double by) { return move(self, by, &Session::rotate); }, nb::arg("angle"))
      .def_prop_ro(
          "fed",
          [](const Moving& self) {
            const std::lock_guard lock(self.busy);
            return self.session->fed();
          },
          without_gil())
      .def_prop_ro(
          "rotation",
          [](const Moving& self) {
            const std::lock_guard lock(self.busy);
            return self.session->rotation();
          },
          without_gil())
      .def("state", &state, nb::arg("points"), without_gil())
      .def(
          "snapshot",
          [](const Moving& self) {
            const std::lock_guard lock(self.busy);
            return self.session->snapshot();
          },
          without_gil())
      .def(
          "restore",
          [](Moving& self, const Snapshot& at) {
            const std::lock_guard lock(self.busy);
            return self.session->restore(at);
          },
          nb::arg("snapshot"), without_gil());
}

}  // namespace tendril::python
