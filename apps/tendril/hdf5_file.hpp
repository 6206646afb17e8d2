#pragma once
// A result as one HDF5 file: inputs, states, fields, provenance. The only place that knows HDF5; it belongs to the
// program, so that the library does not ask it of those who link it.
//
//   /                attributes tendril, result_schema, title, units, status, message, parameter, case (JSON text)
//   /steps/0001      attributes as the keys of a step in the result file; /certificate attributes of its own
//     contacts/...   a data set per column; what a point or a clamp does not have is NaN
//     segments/...   kind, start, end
//     fields/...     a data set per column with the attribute unit (files written with fields)
//     state          what --from starts from
//   /events/...      /trace/...      /tube/...

#include <string>

#include "tendril/io/stored_result.hpp"

namespace tendril::app {

/// Whether this build can write HDF5.
bool has_hdf5();

/// Written beside its place and renamed. Throws io::FileError.
void write_hdf5(const io::StoredResult& stored, const std::string& path);

}  // namespace tendril::app
