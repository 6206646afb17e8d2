// Long centrelines: 10^6 points are read, and the time it took is recorded (asked: 10 seconds; a test asserts no
// times).

#include <chrono>
#include <cmath>
#include <cstdio>

#include "io_support.hpp"

namespace tendril::io::test {
namespace {

TEST(CsvSlow, AMillionPointsAreReadInTime) {
  Scratch scratch;
  std::string text = "x,y,z\n";
  constexpr int kPoints = 1000000;
  for (int i = 0; i < kPoints; ++i) {
    const double z = 100.0 * i / kPoints;
    char row[80];
    text.append(row, static_cast<std::size_t>(
                         std::snprintf(row, sizeof row, "%.9f,%.9f,%.9f\n", std::sin(0.1 * z), std::cos(0.07 * z), z)));
  }
  scratch.write("line.csv", text);
  const std::string straight = "kind = \"helix\"\nradius = 0.225\npitch_angle = 0.785\nlength = 1.0\n";
  const std::string text_of_case = with(straight, "kind = \"points\"\nfile = \"line.csv\"\n");
  const auto begin = std::chrono::steady_clock::now();
  const Case c = read(text_of_case, {}, scratch.path());
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  RecordProperty("seconds", std::to_string(seconds));
  // |(cos 0.1z / 10, 0.07 sin 0.07z, 1)| averages 1 + 0.0025 + 0.0012 over whole periods
  EXPECT_NEAR(c.tube.length(), 100.37, 0.2);
}

}  // namespace
}  // namespace tendril::io::test
