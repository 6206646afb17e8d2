#pragma once
// A small valid case for tests of reading, and a place to write files.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "tendril/io/case.hpp"

namespace tendril::io::test {

inline const std::string kCase = R"(schema = 1
title = "test"

[rod]
bending_stiffness = 1.0
torsional_stiffness = 0.75

[tube]
clearance = 0.025
[tube.axis]
kind = "helix"
radius = 0.225
pitch_angle = 0.785
length = 1.0

[start]
kind = "clamped"

[end]
kind = "sleeve"
axial_force = -7.0
torque = -1.0
)";

/// The case with one piece of its text replaced (the piece must be there).
inline std::string with(const std::string& from, const std::string& to, std::string text = kCase) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

inline Case read(const std::string& text, const std::vector<std::string>& overrides = {},
                 const std::string& directory = {}) {
  return parse_case(text, "case.toml", Format::toml, overrides, directory);
}

inline std::vector<Issue> issues_of(const std::string& text, const std::vector<std::string>& overrides = {},
                                    const std::string& directory = {}, Format format = Format::toml) {
  try {
    parse_case(text, format == Format::json ? "case.json" : "case.toml", format, overrides, directory);
  } catch (const InputError& error) {
    return error.issues();
  }
  return {};
}

/// A directory that is removed with the test.
class Scratch {
 public:
  Scratch()
      : path_(std::filesystem::temp_directory_path() /
              ("tendril_io_" + std::to_string(::getpid()) + "_" + std::to_string(counter()++))) {
    std::filesystem::create_directories(path_);
  }
  ~Scratch() { std::filesystem::remove_all(path_); }
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  std::string path() const { return path_.string(); }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
  }
  static std::string slurp(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

 private:
  static int& counter() {
    static int count = 0;
    return count;
  }
  std::filesystem::path path_;
};

}  // namespace tendril::io::test
