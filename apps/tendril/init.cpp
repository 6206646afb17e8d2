// Starter cases of `tendril init`: complete, commented, each runs as it is. Their data files are made from formulas.

#include "init.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "console.hpp"
#include "tendril/io/atomic_file.hpp"
#include "tendril/io/diagnostics.hpp"

namespace tendril::app {
namespace {

constexpr const char* kVessel =
    R"(# A guidewire in a vessel. `tendril run vessel.toml --report vessel.html`, `tendril explain KEY` for any key.
schema = 1
title = "0.035 in guidewire in a vessel"
units = "si"                     # m, N, N m; any quantity may be a string with its unit

[rod]
bending_stiffness = "900 N mm^2" # EI, from a three-point bending test; or young_modulus and diameter
poisson_ratio = 0.3              # GJ = EI / 1.3
diameter = "0.035 in"

[tube]                           # its radius comes from the file; less that of the wire it is the clearance
side = "inside"
[tube.axis]
kind = "points"                  # a smooth curve through the points
file = "vessel_centreline.csv"   # x, y, z and radius: put yours in its place: CSV, .vtp (VMTK), .pth (SimVascular),
                                 # .mrk.json (3D Slicer); `tendril quality FILE` says what it holds
# file_unit = "mm"               # of a .vtp or .pth, which do not say it
# ends = [0, 1]                  # way through a tree of branches; `tendril quality FILE` numbers the ends
# smoothing = "0.1 mm"           # for points that jitter; "auto": 15 % of the median radius
# reverse = true                 # from the other end

[start]                          # at the first point
kind = "clamped"

[end]
kind = "sleeve"                  # the wire slides through; exactly one of axial_force, push, rod_length
position = "150 mm"              # along the centreline; left out: its end
axial_force = -2.5               # N just inside the end: tension is positive, pushing is negative
torque = 0.0
)";

constexpr const char* kWell =
    R"(# Drill pipe in a well. `tendril run well.toml --report well.html`, `tendril explain KEY` for any key.
schema = 1
title = "5 in drill pipe in the tangent of a well"
units = "si"                     # m, N, N m; any quantity may be a string with its unit

[rod]                            # 5 in, 19.5 lb/ft drill pipe
outer_diameter = "5 in"
inner_diameter = "4.276 in"
young_modulus = "210 GPa"
poisson_ratio = 0.3
weight_per_length = "16 lb/ft"   # buoyed; down is the default of a survey

[tube]
side = "inside"
radius = "4 1/4 in"              # 8 1/2 in hole; the clearance follows from the diameter of the pipe
[tube.axis]
kind = "survey"                  # minimum curvature; world x north, y east, z down
file = "well_survey.csv"         # md, inc, azi: put yours in its place: CSV, LAS, WITSML; `tendril quality FILE` checks it
from = 600.0                     # measured depth of the section that is solved
to = 800.0

[start]                          # at `from`
kind = "clamped"

[end]                            # at `to`
kind = "sleeve"                  # exactly one of axial_force, push, rod_length
axial_force = "-20 kN"           # F3 just inside the end: tension is positive, weight on bit is negative
torque = "5 kN m"
)";

constexpr const char* kHelix =
    R"(# A rod pushed into a helical tube. `tendril run helix.toml --report helix.html`, `tendril explain KEY` for any key.
schema = 1
title = "Rod pushed into a helical tube"
units = "dimensionless"          # any consistent set of units; "si" lets quantities be strings: "9.625 in", "12 klbf"

[rod]
bending_stiffness = 1.0          # EI
torsional_stiffness = 0.75       # GJ
axial_stiffness = 400.0          # EA; leave it out for an inextensible rod

[tube]
side = "inside"                  # or "outside": the rod winds around it
clearance = 0.05                 # radius of the tube less radius of the rod; or [[S, value], ...] along the axis
[tube.axis]
kind = "helix"
radius = 0.225                   # of the helix
pitch_angle = 0.785              # between tangent and axis of the helix, rad; > 0 is right-handed
length = 1.0                     # along the helix

[start]                          # S = 0
kind = "clamped"                 # position and direction held; or "pinned"

[end]                            # S = length
kind = "sleeve"                  # the rod slides through; exactly one of axial_force, push, rod_length
axial_force = -8.0               # F3 just inside the end: tension is positive, pushing is negative
torque = -1.0                    # M3; or twist

[path]                           # follow one number of the case and report every change of the contacts
parameter = "end.axial_force"
values = [-10.0, -20.0, -40.0]
)";

constexpr const char* kStraight =
    R"(# A rod buckling in a straight tube. `tendril run straight.toml --report straight.html`, `tendril explain KEY` for any key.
schema = 1
title = "Rod buckling in a straight tube"
units = "dimensionless"          # any consistent set of units; "si" lets quantities be strings: "9.625 in", "12 klbf"

[rod]
bending_stiffness = 1.0          # EI
torsional_stiffness = 0.75       # GJ; axial_stiffness is left out: inextensible

[tube]
side = "inside"
clearance = 0.02                 # radius of the tube less radius of the rod
[tube.axis]
kind = "straight"
length = 1.0

[start]                          # S = 0
kind = "clamped"                 # position and direction held

[end]                            # S = length
kind = "sleeve"                  # the rod slides through; exactly one of axial_force, push, rod_length
axial_force = -45.0              # just beyond Euler's load 4 pi^2 = 39.48; tension is positive
torque = 0.0

[path]                           # follow one number of the case and report every change of the contacts
parameter = "end.axial_force"
values = [-60.0, -100.0, -170.0]
)";

/// A centreline of gentle bends that narrows from 8 to 4 mm.
std::string vessel_centreline() {
  std::string csv = "x_mm,y_mm,z_mm,radius_mm\n";
  for (int i = 0; i <= 40; ++i) {
    const double z = 5.0 * i, t = std::numbers::pi * z / 200.0;
    csv += fmt::format("{:.4f},{:.4f},{:g},{:.3f}\n", 18.0 * (1.0 - std::cos(1.25 * t)), 10.0 * std::sin(t), z,
                       6.0 + 2.0 * std::cos(t));
  }
  return csv;
}

/// Vertical to 150 m, built at 3 deg/30 m to 45 deg, then held while it turns a little.
std::string well_survey() {
  std::string csv = "md_m,inc_deg,azi_deg\n";
  for (int md = 0; md <= 900; md += 30)
    csv +=
        fmt::format("{},{:g},{:g}\n", md, std::clamp(0.1 * (md - 150), 0.0, 45.0), 40.0 + 0.02 * std::max(md - 700, 0));
  return csv;
}

struct File {
  std::string name, text;
};

std::vector<File> files_of(const std::string& kind) {
  if (kind == "vessel") return {{"vessel.toml", kVessel}, {"vessel_centreline.csv", vessel_centreline()}};
  if (kind == "well") return {{"well.toml", kWell}, {"well_survey.csv", well_survey()}};
  if (kind == "helix") return {{"helix.toml", kHelix}};
  if (kind == "straight") return {{"straight.toml", kStraight}};
  return {};
}

}  // namespace

const std::vector<std::string>& starters() {
  static const std::vector<std::string> names{"vessel", "well", "helix", "straight"};
  return names;
}

int init(const std::string& kind, const std::string& directory, bool force) {
  const std::vector<File> files = files_of(kind);
  if (files.empty()) {
    const std::string near = io::nearest(kind, starters());
    message("tendril: there is no starter case `" + kind + "`" +
            (near.empty() ? "" : "; did you mean `" + near + "`?") +
            "\n       there are vessel, well, helix, straight\n");
    return kUsage;
  }
  const std::filesystem::path base(directory);
  for (const File& file : files) {
    if (force || !std::filesystem::exists(base / file.name)) continue;
    message("tendril: " + (base / file.name).string() + " is there already; --force replaces it\n");
    return kFile;
  }
  if (!directory.empty()) io::make_directory(directory);
  for (const File& file : files) {
    io::write_file((base / file.name).string(), file.text);
    message("wrote " + (base / file.name).string() + "\n");
  }
  const std::string file = (base / files.front().name).string();
  message("next: tendril run " + file + "\n");
  return kSolved;
}

}  // namespace tendril::app
