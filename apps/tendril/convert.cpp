#include "convert.hpp"

#include <cstdio>
#include <filesystem>

#include "console.hpp"
#include "hdf5_file.hpp"
#include "tendril/io/atomic_file.hpp"
#include "tendril/io/stored_result.hpp"

namespace tendril::app {
namespace {

void write_csv(const io::StoredResult& stored, const std::string& base) {
  io::write_file(base + "contacts.csv", io::contacts_csv(stored.c, stored.result));
  io::write_file(base + "fields.csv", io::fields_csv(stored.c, stored.result));
}

void write_vtp(const io::StoredResult& stored, const std::string& base) {
  const double wall =
      io::rod_radius(stored.c).value_or(0.0) * (stored.c.word("tube.side", "inside") == "outside" ? -1.0 : 1.0);
  io::write_file(base + "tube.vtp", io::tube_vtp(stored.tube, wall));
  std::vector<std::string> files;
  for (std::size_t i = 0; i < stored.result.steps.size(); ++i) {
    char name[32];
    std::snprintf(name, sizeof name, "rod_%04zu.vtp", i + 1);
    files.emplace_back(name);
    io::write_file(base + name, io::rod_vtp(stored.c, stored.result.steps[i]));
  }
  io::write_file(base + "rod.pvd", io::paraview_list(stored.result, files));
}

}  // namespace

int convert(const std::string& result_file, std::string format, const std::string& output) {
  if (format.empty()) {
    const std::string ending = std::filesystem::path(output).extension().string();
    format = ending == ".h5" || ending == ".hdf5" ? "h5" : "";
  }
  if (format != "h5" && format != "csv" && format != "vtp") {
    message("tendril: convert: say what to write with --to h5, csv or vtp\n");
    return kUsage;
  }
  if (format == "h5" && !has_hdf5()) {
    message("tendril: this program was built without HDF5 (Debian: libhdf5-dev)\n");
    return kUsage;
  }
  const io::StoredResult stored = io::read_stored_result(result_file);
  if (format == "vtp" && stored.tube.empty()) {
    message("tendril: " + result_file + " has no fields to draw: write it with `tendril run --fields`\n");
    return kInvalid;
  }
  if (format == "h5") {
    write_hdf5(stored, output);
  } else {
    io::make_directory(output);
    (format == "csv" ? write_csv : write_vtp)(stored, output + "/");
  }
  message("wrote " + output + (format == "h5" ? "\n" : "/\n"));
  return kSolved;
}

}  // namespace tendril::app
