#pragma once
// Numbers of a VTK DataArray from its bytes: raw or base64, plain or in zlib blocks, of either byte order. Every size
// that the file states is checked against the bytes that are there before anything is allocated for it.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tendril::io {

/// How a VTK XML file packs its arrays.
struct VtkPacking {
  bool base64 = false;
  bool zlib = false;
  bool big_endian = false;
  int header_bytes = 4;  // of each size in a header, 4 or 8
};

/// Thrown with what is wrong: "the base64 text ends after 17 of 480 bytes".
struct VtkArrayError {
  std::string problem, value, bound, hint;
};

/// Bytes of a type ("Float64": 8), 0 if VTK has no such type.
int vtk_type_bytes(std::string_view type);

/// `count` numbers of `type` that start at the beginning of `data`. Throws VtkArrayError.
std::vector<double> unpack(std::string_view data, const VtkPacking& packing, std::string_view type, std::size_t count);

}  // namespace tendril::io
