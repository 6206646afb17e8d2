// Exceptions of the library as exceptions of Python: wrong input is tendril.CaseError with every issue, an unreadable
// or unwritable file is OSError.

#include <nanobind/stl/string.h>

#include "bindings.hpp"
#include "tendril/geometry/error.hpp"
#include "tendril/io/diagnostics.hpp"

namespace tendril::python {
namespace {

void raise_case_error(const std::vector<io::Issue>& issues, const std::string& text) {
  const nb::module_ errors = nb::module_::import_("tendril._errors");
  nb::list list;
  for (const io::Issue& i : issues)
    list.append(
        errors.attr("Issue")(i.file, i.line, i.column, i.key, i.message, i.value, i.bound, i.hint, io::render(i)));
  const nb::object error = errors.attr("CaseError")(text, list);
  PyErr_SetObject(reinterpret_cast<PyObject*>(Py_TYPE(error.ptr())), error.ptr());
}

void translate(const std::exception_ptr& thrown, void*) {
  try {
    std::rethrow_exception(thrown);
  } catch (const io::InputError& error) {
    raise_case_error(error.issues(), error.what());
  } catch (const geometry::GeometryError& error) {  // met on a path, where the geometry is built anew
    io::Issue issue;
    issue.key = error.what_field;
    issue.message = error.what();
    issue.hint = error.hint;
    raise_case_error({issue}, error.what());
  } catch (const io::FileError& error) {
    PyErr_SetString(PyExc_OSError, error.what());
  }
}

}  // namespace

void bind_errors(nb::module_&) { nb::register_exception_translator(translate); }

}  // namespace tendril::python
