#pragma once
// Results as JSON, keys as documented for the result file; numbers in the shortest form that reads back exactly, null
// where there is no value, never NaN. And back: the state of a step, to start another solve from.

#include <string>
#include <vector>

#include "tendril/continuation/result.hpp"
#include "tendril/io/case.hpp"

namespace tendril::io {

/// The whole result file. With `fields` also the sampled tube, so that the state can be drawn from the file alone.
std::string result_json(const Case& c, const continuation::Result& result, bool fields);

/// "converged" | "not_converged" | "outside_validity"
std::string_view status_name(continuation::Status status);

/// Text of a result file, checked to be one. Throws FileError, InputError.
std::string read_result(const std::string& path);

/// State of the last step of a result file that has one. Throws FileError, InputError.
std::vector<double> read_state(const std::string& path);

}  // namespace tendril::io
