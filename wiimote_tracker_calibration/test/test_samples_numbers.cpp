// The numbers of a samples file are the same in every locale.
#include "expect_says.h"

#include "samples/samples_file.h"

#include <wiimote_tracker_triangulation/geometry/atomic_file.h>

#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>
#include <locale>
#include <string>

namespace wiimote_tracker::samples {
namespace {

/// Whatever locales are installed.
class DecimalComma : public std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
};

std::string written(const Samples& samples) {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() /
                                       ("test_samples_numbers_" + std::to_string(::getpid()));
  const std::string path = (folder / "samples.yaml").string();
  writeSamplesFile(samples, path);
  const std::string text = geometry::readFile(path);
  std::filesystem::remove_all(folder);
  return text;
}

TEST(SamplesNumbers, HaveADecimalPointWhereAProgramSetsAComma) {
  Samples samples;
  samples.recording.square = square::SquareLayout();
  samples.recording.square->side_x = 2.5;
  samples.recording.square->side_y = 1.5;
  samples.recording.cameras.resize(1);
  samples.recording.cameras[0].sightings.name = "camera_1";
  samples.recording.cameras[0].frames = {{1700000000.125, {{512.5, 384.25}}}};
  std::locale::global(std::locale(std::locale::classic(), new DecimalComma));
  const std::string text = written(samples);
  std::locale::global(std::locale::classic());
  EXPECT_SAYS(text, "side_x: 2.5\n");
  EXPECT_SAYS(text, "  1700000000.125 512.5 384.25\n");
  EXPECT_EQ(text, written(samples));
}

}  // namespace
}  // namespace wiimote_tracker::samples
