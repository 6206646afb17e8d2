#include "tendril/io/formats/vtk_array.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace tendril::io {
namespace {

constexpr std::size_t kLargestInflation = 1032;  // deflate cannot pack more into one byte

// Bytes in the order of the file, one after the other. Base64 may be padded in the middle, as VTK pads a header.
class Bytes {
 public:
  Bytes(std::string_view data, bool base64) : data_(data), base64_(base64) {}

  // No more than this is left; checked before a buffer of `count` bytes is made.
  std::size_t most_left() const {
    return base64_ ? (data_.size() - at_) / 4 * 3 + 3 + (held_ - given_) : data_.size() - at_;
  }

  std::vector<unsigned char> take(std::size_t count, const char* what) {
    if (count > most_left()) throw ends(what, most_left(), count);
    std::vector<unsigned char> out(count);
    for (std::size_t i = 0; i < count; ++i) {
      if (!base64_) {
        out[i] = static_cast<unsigned char>(data_[at_++]);
        continue;
      }
      if (given_ == held_ && !quad()) throw ends(what, i, count);
      out[i] = three_[given_++];
    }
    return out;
  }

  // A header that was encoded by itself ends with its quad.
  void end_of_header() {
    if (base64_) given_ = held_;
  }

 private:
  static VtkArrayError ends(const char* what, std::size_t there, std::size_t wanted) {
    return {std::string("the data end within ") + what, std::to_string(there) + " bytes",
            std::to_string(wanted) + " bytes", "is the file complete?"};
  }

  static int digit(char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    return c == '+' ? 62 : c == '/' ? 63 : -1;
  }

  bool quad() {
    unsigned bits = 0;
    int digits = 0, pads = 0;
    while (digits + pads < 4) {
      while (at_ < data_.size() &&
             (data_[at_] == ' ' || data_[at_] == '\n' || data_[at_] == '\r' || data_[at_] == '\t'))
        ++at_;
      if (at_ == data_.size()) return false;
      const char c = data_[at_++];
      if (c == '=' && digits >= 2) {
        ++pads;
        bits <<= 6;
        continue;
      }
      const int value = digit(c);
      if (value < 0 || pads > 0) {
        const bool shown = c > ' ' && c < 127;
        throw VtkArrayError{"this is not base64", shown ? std::string("character '") + c + "'" : "an unprintable byte",
                            "A-Z a-z 0-9 + / =", ""};
      }
      bits = bits << 6 | static_cast<unsigned>(value);
      ++digits;
    }
    three_ = {static_cast<unsigned char>(bits >> 16), static_cast<unsigned char>(bits >> 8 & 255),
              static_cast<unsigned char>(bits & 255)};
    given_ = 0;
    held_ = 3 - pads;
    return true;
  }

  std::string_view data_;
  bool base64_;
  std::size_t at_ = 0;
  std::array<unsigned char, 3> three_{};
  int given_ = 0, held_ = 0;
};

template <class T>
T number_at(const unsigned char* bytes, bool big_endian) {
  std::array<unsigned char, sizeof(T)> copy;
  std::copy_n(bytes, sizeof(T), copy.begin());
  if (big_endian != (std::endian::native == std::endian::big)) std::reverse(copy.begin(), copy.end());
  T value;
  std::memcpy(&value, copy.data(), sizeof(T));
  return value;
}

std::size_t size_at(const unsigned char* bytes, const VtkPacking& packing) {
  return packing.header_bytes == 8 ? static_cast<std::size_t>(number_at<std::uint64_t>(bytes, packing.big_endian))
                                   : number_at<std::uint32_t>(bytes, packing.big_endian);
}

template <class T>
void convert(const std::vector<unsigned char>& bytes, bool big_endian, std::vector<double>& out) {
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = static_cast<double>(number_at<T>(bytes.data() + i * sizeof(T), big_endian));
}

void inflate_block(const std::vector<unsigned char>& packed, unsigned char* out, std::size_t size) {
  z_stream stream{};
  if (inflateInit(&stream) != Z_OK) throw VtkArrayError{"zlib does not start", "", "", ""};
  stream.next_in = const_cast<unsigned char*>(packed.data());
  stream.avail_in = static_cast<uInt>(packed.size());
  stream.next_out = out;
  stream.avail_out = static_cast<uInt>(size);
  const int status = inflate(&stream, Z_FINISH);
  const std::size_t made = size - stream.avail_out;
  inflateEnd(&stream);
  if (status == Z_STREAM_END && made == size) return;
  if (status == Z_DATA_ERROR || status == Z_NEED_DICT) {
    throw VtkArrayError{"the zlib data are damaged", stream.msg ? stream.msg : "", "", "write the file again"};
  }
  throw VtkArrayError{"a zlib block does not give the size it states", std::to_string(made) + " bytes",
                      std::to_string(size) + " bytes", "write the file again"};
}

std::vector<unsigned char> unpack_bytes(std::string_view data, const VtkPacking& packing, std::size_t wanted) {
  Bytes bytes(data, packing.base64);
  const auto width = static_cast<std::size_t>(packing.header_bytes);
  const auto differs = [&](std::size_t stated) {
    return VtkArrayError{"the array has the wrong size", std::to_string(stated) + " bytes",
                         std::to_string(wanted) + " bytes", "its number of components and its type must fit"};
  };
  if (!packing.zlib) {
    const std::size_t stated = size_at(bytes.take(width, "the header of an array").data(), packing);
    if (stated != wanted) throw differs(stated);
    return bytes.take(wanted, "an array");
  }
  const auto head = bytes.take(3 * width, "the header of an array");
  const std::size_t blocks = size_at(head.data(), packing), block = size_at(head.data() + width, packing),
                    last = size_at(head.data() + 2 * width, packing);
  if (blocks > bytes.most_left() / width) {
    throw VtkArrayError{"the header states more zlib blocks than there are bytes", std::to_string(blocks),
                        "<= " + std::to_string(bytes.most_left() / width), "is the file complete?"};
  }
  // Whole blocks, then a shorter one unless its size is 0.
  const std::size_t whole = blocks - (last > 0 && blocks > 0 ? 1 : 0);
  if (last > wanted || (whole > 0 && block > wanted / whole)) throw differs(whole > 0 ? block : last);
  if (const std::size_t stated = whole * block + (whole < blocks ? last : 0); stated != wanted) throw differs(stated);
  const auto sizes = bytes.take(blocks * width, "the header of an array");
  bytes.end_of_header();
  if (wanted / kLargestInflation > bytes.most_left()) {
    throw VtkArrayError{"the data are too short for the numbers they should hold",
                        std::to_string(bytes.most_left()) + " bytes", std::to_string(wanted) + " bytes after inflation",
                        "is the file complete?"};
  }
  std::vector<unsigned char> out(wanted);
  for (std::size_t i = 0, at = 0; i < blocks; ++i) {
    const std::size_t size = i < whole ? block : last;
    inflate_block(bytes.take(size_at(sizes.data() + i * width, packing), "a zlib block"), out.data() + at, size);
    at += size;
  }
  return out;
}

}  // namespace

int vtk_type_bytes(std::string_view type) {
  if (type == "Float64" || type == "Int64" || type == "UInt64") return 8;
  if (type == "Float32" || type == "Int32" || type == "UInt32") return 4;
  if (type == "Int16" || type == "UInt16") return 2;
  return type == "Int8" || type == "UInt8" ? 1 : 0;
}

std::vector<double> unpack(std::string_view data, const VtkPacking& packing, std::string_view type, std::size_t count) {
  const auto width = static_cast<std::size_t>(vtk_type_bytes(type));
  const std::vector<unsigned char> bytes = unpack_bytes(data, packing, width * count);
  std::vector<double> out(count);
  const bool big = packing.big_endian;
  if (type == "Float64") convert<double>(bytes, big, out);
  if (type == "Float32") convert<float>(bytes, big, out);
  if (type == "Int64") convert<std::int64_t>(bytes, big, out);
  if (type == "UInt64") convert<std::uint64_t>(bytes, big, out);
  if (type == "Int32") convert<std::int32_t>(bytes, big, out);
  if (type == "UInt32") convert<std::uint32_t>(bytes, big, out);
  if (type == "Int16") convert<std::int16_t>(bytes, big, out);
  if (type == "UInt16") convert<std::uint16_t>(bytes, big, out);
  if (type == "Int8") convert<std::int8_t>(bytes, big, out);
  if (type == "UInt8") convert<std::uint8_t>(bytes, big, out);
  return out;
}

}  // namespace tendril::io
