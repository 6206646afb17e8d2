#pragma once
// Files appear whole or not at all: written beside their place under another name, then renamed. Devices and pipes are
// written directly. Every failure (full disk, no permission) is a FileError and leaves the old file as it was.

#include <string>
#include <string_view>

namespace tendril::io {

void write_file(const std::string& path, std::string_view content);

/// Creates the directory (and its parents) if it is not there.
void make_directory(const std::string& path);

}  // namespace tendril::io
