// The extension module tendril._core. The package tendril is the face; nothing here is meant for users.

#include "bindings.hpp"
#include "tendril/version.hpp"

NB_MODULE(_core, m) {
  m.attr("__version__") = tendril::version();
  tendril::python::bind_errors(m);
  tendril::python::bind_case(m);
  tendril::python::bind_result(m);
  tendril::python::bind_many(m);
  tendril::python::bind_session(m);
}
