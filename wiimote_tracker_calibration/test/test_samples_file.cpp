// The file of what was captured: every number comes back, and damage is refused.

#include "samples/samples_file.h"

#include "expect_says.h"
#include "german_locale.h"
#include "refusal_of.h"

#include <wiimote_tracker_msgs/error.h>
#include <wiimote_tracker_triangulation/geometry/atomic_file.h>

#include <gtest/gtest.h>

#include <unistd.h>

#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <set>
#include <string>
#include <vector>

namespace wiimote_tracker::samples {
namespace {

/// A file that is gone after the test.
class SamplesFile : public ::testing::Test {
 protected:
  SamplesFile() {
    folder_ = std::filesystem::temp_directory_path() /
              ("test_samples_file_" + std::to_string(::getpid()));
    path_ = (folder_ / "deeper" / "samples.yaml").string();
  }
  ~SamplesFile() override { std::filesystem::remove_all(folder_); }

  void write(const std::string& text) {
    std::filesystem::create_directories(std::filesystem::path(path_).parent_path());
    std::ofstream(path_, std::ios::binary) << text;
  }

  std::string refusal() {
    return refusalOf([&] { readSamplesFile(path_); });
  }

  std::filesystem::path folder_;
  std::string path_;
};

const char* const kText = R"(# What was captured to calibrate a rig; units as in doc/samples.md.
format: wiimote_tracker_samples
version: 1
world_frame: "world"
square:
  side_x: 2.5
  side_y: 2
  led_height: 0.012
  origin: [1.25, -1]
  yaw: 0.1
wand:
  length: 0.5
  stddev: 0.0002
cameras:
  - name: "wiimote_1"
    identity: "00:19:1d:5a:0b:01"
    lens:
      width: 1024
      height: 768
      fx: 1306.3
      fy: 1302.3
      cx: 535
      cy: 401.7
      distortion_model: plumb_bob
      distortion: [-0.01, 0, 0, 0, 0]
    gravity: [0.1, -9.7, -1.25]
    clock_epoch: 3
    corners:
      - [100.5, 200]
      - ~
      - [300, 400.25]
      - [1e-05, 7]
    masks:
      - {center: [10, 20], radius: 6.5}
    frames: 2
  - name: "wiimote_2"
    identity: ""
    lens:
      width: 1024
      height: 768
      fx: 700
      fy: 701
      cx: 512
      cy: 384
      distortion_model: equidistant
      distortion: [0.1, 0.2, 0.3, 0.4]
    gravity: ~
    clock_epoch: 0
    corners:
      - ~
      - ~
      - ~
      - ~
    masks:
      []
    frames: 3
--- # Images of the wave, camera by camera: time [s], then x and y [px] of every spot.
- |
  1700000000.125 512 384.5
  1700000000.1328125 513 384.5 1 2
- |
  1700000000.13
  1700000000.14 5 6
  1700000000.15
...
)";

Samples expectedSamples() {
  Samples samples;
  wave::Recording& recording = samples.recording;
  recording.square = square::SquareLayout();
  recording.square->side_x = 2.5;
  recording.square->side_y = 2.0;
  recording.square->led_height = 0.012;
  recording.square->origin = {1.25, -1.0};
  recording.square->yaw = 0.1;
  recording.wand = wave::Wand{0.5, 0.0002};
  recording.cameras.resize(2);
  wave::CameraRecording& one = recording.cameras[0];
  one.sightings.name = "wiimote_1";
  one.sightings.identity = "00:19:1d:5a:0b:01";
  one.sightings.intrinsics.cx = 535.0;
  one.sightings.intrinsics.distortion[0] = -0.01;
  one.sightings.gravity = Eigen::Vector3d(0.1, -9.7, -1.25);
  one.sightings.corners[0] = Eigen::Vector2d(100.5, 200.0);
  one.sightings.corners[2] = Eigen::Vector2d(300.0, 400.25);
  one.sightings.corners[3] = Eigen::Vector2d(1e-5, 7.0);
  one.clock_epoch = 3;
  one.frames = {{1700000000.125, {{512.0, 384.5}}},
                {1700000000.1328125, {{513.0, 384.5}, {1.0, 2.0}}}};
  wave::CameraRecording& two = recording.cameras[1];
  two.sightings.name = "wiimote_2";
  geometry::Intrinsics& lens = two.sightings.intrinsics;
  lens.fx = 700.0;
  lens.fy = 701.0;
  lens.cx = 512.0;
  lens.cy = 384.0;
  lens.distortion_model = geometry::DistortionModel::kEquidistant;
  lens.distortion = {0.1, 0.2, 0.3, 0.4, 0.0};
  two.frames = {{1700000000.13, {}}, {1700000000.14, {{5.0, 6.0}}}, {1700000000.15, {}}};
  recording.cameras[0].masks = {{Eigen::Vector2d(10.0, 20.0), 6.5}};
  return samples;
}

/// 0 is not -0.
void expectSameNumber(double a, double b) {
  EXPECT_EQ(a, b);
  EXPECT_EQ(std::signbit(a), std::signbit(b)) << a << " " << b;
}

template <typename A, typename B>
void expectSameVector(const Eigen::MatrixBase<A>& a, const Eigen::MatrixBase<B>& b) {
  for (Eigen::Index i = 0; i < a.size(); ++i)
    expectSameNumber(a(i), b(i));
}

void expectSameLens(const geometry::Intrinsics& a, const geometry::Intrinsics& b) {
  EXPECT_EQ(a.width, b.width);
  EXPECT_EQ(a.height, b.height);
  expectSameNumber(a.fx, b.fx);
  expectSameNumber(a.fy, b.fy);
  expectSameNumber(a.cx, b.cx);
  expectSameNumber(a.cy, b.cy);
  EXPECT_EQ(a.distortion_model, b.distortion_model);
  for (std::size_t i = 0; i < a.distortion.size(); ++i)
    expectSameNumber(a.distortion[i], b.distortion[i]);
}

void expectSameCamera(const wave::CameraRecording& a, const wave::CameraRecording& b) {
  EXPECT_EQ(a.sightings.name, b.sightings.name);
  EXPECT_EQ(a.sightings.identity, b.sightings.identity);
  expectSameLens(a.sightings.intrinsics, b.sightings.intrinsics);
  ASSERT_EQ(a.sightings.gravity.has_value(), b.sightings.gravity.has_value());
  if (a.sightings.gravity)
    expectSameVector(*a.sightings.gravity, *b.sightings.gravity);
  for (std::size_t c = 0; c < 4; ++c) {
    ASSERT_EQ(a.sightings.corners[c].has_value(), b.sightings.corners[c].has_value());
    if (a.sightings.corners[c])
      expectSameVector(*a.sightings.corners[c], *b.sightings.corners[c]);
  }
  EXPECT_EQ(a.clock_epoch, b.clock_epoch);
  ASSERT_EQ(a.frames.size(), b.frames.size());
  for (std::size_t i = 0; i < a.frames.size(); ++i) {
    expectSameNumber(a.frames[i].stamp, b.frames[i].stamp);
    ASSERT_EQ(a.frames[i].spots.size(), b.frames[i].spots.size());
    for (std::size_t s = 0; s < a.frames[i].spots.size(); ++s)
      expectSameVector(a.frames[i].spots[s], b.frames[i].spots[s]);
  }
  ASSERT_EQ(a.masks.size(), b.masks.size());
  for (std::size_t i = 0; i < a.masks.size(); ++i) {
    expectSameVector(a.masks[i].center, b.masks[i].center);
    expectSameNumber(a.masks[i].radius, b.masks[i].radius);
  }
}

void expectSameSamples(const Samples& a, const Samples& b) {
  EXPECT_EQ(a.world_frame, b.world_frame);
  ASSERT_EQ(a.recording.square.has_value(), b.recording.square.has_value());
  if (a.recording.square) {
    expectSameNumber(a.recording.square->side_x, b.recording.square->side_x);
    expectSameNumber(a.recording.square->side_y, b.recording.square->side_y);
    expectSameNumber(a.recording.square->led_height, b.recording.square->led_height);
    expectSameVector(a.recording.square->origin, b.recording.square->origin);
    expectSameNumber(a.recording.square->yaw, b.recording.square->yaw);
  }
  ASSERT_EQ(a.recording.wand.has_value(), b.recording.wand.has_value());
  if (a.recording.wand) {
    expectSameNumber(a.recording.wand->length, b.recording.wand->length);
    expectSameNumber(a.recording.wand->stddev, b.recording.wand->stddev);
    EXPECT_EQ(a.recording.wand->led_height, b.recording.wand->led_height);
  }
  ASSERT_EQ(a.recording.cameras.size(), b.recording.cameras.size());
  for (std::size_t i = 0; i < a.recording.cameras.size(); ++i)
    expectSameCamera(a.recording.cameras[i], b.recording.cameras[i]);
}

TEST_F(SamplesFile, IsWhatTheDocumentationShows) {
  write(kText);
  expectSameSamples(readSamplesFile(path_), expectedSamples());
  std::filesystem::remove(path_);
  writeSamplesFile(expectedSamples(), path_);
  EXPECT_EQ(geometry::readFile(path_), kText);
}

TEST_F(SamplesFile, KeepsAWandOnTheFloor) {
  Samples samples = expectedSamples();
  samples.recording.wand->led_height = 0.03;
  writeSamplesFile(samples, path_);
  expectSameSamples(readSamplesFile(path_), samples);
  samples.recording.wand->led_height = -0.03;
  EXPECT_THROW(writeSamplesFile(samples, path_), Error);
}

TEST_F(SamplesFile, KeepsKnownPlaces) {
  Samples samples = expectedSamples();
  samples.recording.square->places = {{{0.25, -1.0, 2.0}, 0.001}, {{1.0, 1.0, 1e-7}, 0.002}};
  samples.recording.cameras[0].sightings.places = {std::nullopt, Eigen::Vector2d(5.0, 6.25)};
  samples.recording.cameras[1].sightings.places = {Eigen::Vector2d(1.0, 2.0), std::nullopt};
  writeSamplesFile(samples, path_);
  const wave::Recording read = readSamplesFile(path_).recording;
  const std::vector<square::KnownPlace> places = read.square.value().places;
  ASSERT_EQ(places.size(), 2U);
  expectSameVector(places[1].position, Eigen::Vector3d(1.0, 1.0, 1e-7));
  expectSameNumber(places[1].stddev, 0.002);
  ASSERT_EQ(read.cameras[0].sightings.places.size(), 2U);
  EXPECT_FALSE(read.cameras[0].sightings.places[0]);
  expectSameVector(*read.cameras[0].sightings.places[1], Eigen::Vector2d(5.0, 6.25));
  samples.recording.square->places.pop_back();
  EXPECT_THROW(writeSamplesFile(samples, path_), Error);
}

TEST_F(SamplesFile, KeepsLengthsByTape) {
  Samples samples = expectedSamples();
  samples.recording.square->lengths = {{0, 2, 3.2015621187164243, 0.001}, {3, 1, 3.2, 0.002}};
  writeSamplesFile(samples, path_);
  const auto lengths = readSamplesFile(path_).recording.square->lengths;
  ASSERT_EQ(lengths.size(), 2U);
  EXPECT_EQ(lengths[0].from, 0U);
  EXPECT_EQ(lengths[0].to, 2U);
  expectSameNumber(lengths[0].length, 3.2015621187164243);
  expectSameNumber(lengths[0].stddev, 0.001);
  EXPECT_EQ(lengths[1].from, 3U);
  const std::string text = geometry::readFile(path_);
  for (const auto& [from, to, part] :
       {std::array<const char*, 3>{"from: 1", "from: 5", "lengths[0]/from is 5"},
        {"from: 1", "from: 3", "two different corners"},
        {"stddev: 0.001", "stddev: 0", "not above 0"}}) {
    std::string changed = text;
    changed.replace(changed.find(from), std::strlen(from), to);
    write(changed);
    EXPECT_SAYS(refusal(), part);
  }
}

TEST_F(SamplesFile, KeepsAnyNumberAndName) {
  std::mt19937_64 random(1);
  const auto any = [&random] {
    double value = 0.0;
    do {
      const std::uint64_t bits = random();
      std::memcpy(&value, &bits, sizeof value);
    } while (!std::isfinite(value));
    return value;
  };
  Samples samples = expectedSamples();
  samples.world_frame = "map: #1 \"\xc3\xbc\"\n---\n";
  samples.recording.cameras[0].sightings.name = "/room 1/wiimote";
  samples.recording.cameras[1].sightings.name = "~";
  samples.recording.cameras[0].sightings.gravity = Eigen::Vector3d(any(), any(), -0.0);
  std::set<double> stamps = {std::numeric_limits<double>::denorm_min()};
  while (stamps.size() < 2001)
    stamps.insert(any());
  samples.recording.cameras[1].frames.clear();
  for (const double stamp : stamps)
    samples.recording.cameras[1].frames.push_back({stamp, {{any(), any()}, {any(), any()}}});
  samples.recording.cameras[1].frames[1000].spots = {{-0.0, std::numeric_limits<double>::max()}};
  writeSamplesFile(samples, path_);
  expectSameSamples(readSamplesFile(path_), samples);
}

TEST_F(SamplesFile, HasADecimalPointInEveryLocale) {
  const GermanLocale german;
  if (!german.isSet())
    GTEST_SKIP() << GermanLocale::kMissing;
  writeSamplesFile(expectedSamples(), path_);
  EXPECT_EQ(geometry::readFile(path_), kText);
  expectSameSamples(readSamplesFile(path_), expectedSamples());
}

TEST_F(SamplesFile, KeepsWhatWasThereBefore) {
  Samples samples = expectedSamples();
  writeSamplesFile(samples, path_);
  samples.recording.square->side_x = 3.0;
  writeSamplesFile(samples, path_);
  EXPECT_EQ(geometry::readFile(path_ + ".bak"), kText);
  samples.recording.cameras[0].frames[0].spots[0].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(writeSamplesFile(samples, path_), Error);
  EXPECT_EQ(readSamplesFile(path_).recording.square->side_x, 3.0);
}

TEST_F(SamplesFile, CutOffAnywhereIsRefused) {
  const std::string text = kText;
  for (std::size_t length = 0; length < text.size(); ++length) {
    write(text.substr(0, length));
    EXPECT_NE(refusal(), "not refused") << length;
  }
}

TEST_F(SamplesFile, DamageIsRefusedOrHarmless) {
  const std::string text = kText;
  std::mt19937_64 random(2);
  int refused = 0;
  for (std::size_t i = 0; i < 2 * text.size(); ++i) {
    std::string damaged = text;
    const std::size_t place = i % text.size();
    if (i < text.size())
      damaged[place] = static_cast<char>(random() % 256);
    else
      damaged.erase(place, 1 + random() % 40);
    write(damaged);
    try {
      // What can be read can be written.
      writeSamplesFile(readSamplesFile(path_), path_ + ".again");
    } catch (const Error& error) {
      ++refused;
      EXPECT_GT(std::strlen(error.what()), 20U);
    }
  }
  EXPECT_GT(refused, static_cast<int>(text.size()));
}

TEST_F(SamplesFile, SaysWhatIsWrongWithIt) {
  EXPECT_SAYS(refusal(), "(No such file or directory); check its name");
  write("wiimote_tracker_rig: 1\n");
  EXPECT_SAYS(refusal(), "holds no samples");
  write(std::string(kText) + "more\n");
  EXPECT_SAYS(refusal(), "is not the last");
  const std::string text = kText;
  const std::size_t square = text.find("square:");
  const std::string square_block = text.substr(square, text.find("wand:") - square);
  for (const auto& [from, to, part] : std::vector<std::array<std::string, 3>>{
           {"version: 1", "version: 2", "version is 2, but only 1 is understood"},
           {"wiimote_tracker_samples", "wiimote_tracker_rig", "choose a file that save_samples"},
           {"equidistant", "fisheye",
            "plumb_bob (k1, k2, p1, p2, k3) or equidistant (k1, k2, k3, "},
           {"side_x: 2.5", "side_x: -2.5", "the side of the square from the first to the second"},
           {square_block, "square: ~\n", "there is no square, but wiimote_1 saw a corner of it"},
           {"frames: 2", "frames: 3", "line 61 is not an image"},
           {"512 384.5", "512 384.5 7", "line 59 is not the time of an image"},
           {"512 384.5", "nan 384.5", "line 59 is not the time of an image"},
           {"1700000000.14 5 6", "1700000000.13 5 6",
            "the images of wiimote_2 are not in the order of their times"},
           {"name: \"wiimote_2\"", "name: \"wiimote_1\"", "two cameras are called wiimote_1"},
           {"clock_epoch: 3", "clock_epoch: 3\n    colour: 4",
            "cameras[0]/colour is an unknown key"}}) {
    std::string changed = text;
    changed.replace(changed.find(from), from.size(), to);
    write(changed);
    EXPECT_SAYS(refusal(), part);
  }
}

}  // namespace
}  // namespace wiimote_tracker::samples
