#pragma once
// `tendril convert`: a stored result in another format.

#include <string>

namespace tendril::app {

/// `format` is h5 (one file), csv or vtp (files in a directory); empty: by the ending of `output`.
int convert(const std::string& result_file, std::string format, const std::string& output);

}  // namespace tendril::app
