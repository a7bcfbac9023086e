// Mistakes of a person who calibrates: each must be named, with its size.
#include "expect_says.h"
#include "simulated_square.h"
#include "wave_trial.h"
#include "wiimote_tracker_calibration/simulation/simulated_wave.h"

#include "samples/clock_lag.h"
#include "samples/diagnose.h"
#include "samples/solve_samples.h"

#include <wiimote_tracker_msgs/error.h>

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>

namespace wiimote_tracker::samples {
namespace {

/// The refusal, or else the verdict.
std::string outcomeOf(const wave::Recording& recording, const SolveOptions& options) {
  Samples samples;
  samples.recording = recording;
  try {
    return solveSamples(samples, options).rig.verdict;
  } catch (const Error& error) {
    return std::string("refused: ") + error.what();
  }
}

TEST(ClockLag, IsFoundBesideCamerasThatSeeALampOrNothing) {
  wave::Recording recording;
  recording.cameras.resize(4);
  for (int k = 0; k < 1000; ++k) {
    const double t = 0.01 * k;
    const Eigen::Vector2d led(500.0 + 200.0 * std::sin(2.3 * t + 1.5 * std::sin(0.9 * t)), 400.0);
    recording.cameras[0].frames.push_back({t + 0.5, {led}});
    recording.cameras[1].frames.push_back({t, {led}});
    recording.cameras[2].frames.push_back({t, {Eigen::Vector2d(100.0, 100.0)}});
  }
  const auto lag = clockLag(recording, 0);
  ASSERT_TRUE(lag);
  EXPECT_NEAR(*lag, 0.5, 0.03);
  EXPECT_NEAR(clockLag(recording, 1).value_or(0.0), -0.5, 0.03);
  EXPECT_FALSE(clockLag(recording, 3));
}

/// The paper's square, without a wave.
class SquareMistake : public ::testing::Test {
 protected:
  SquareMistake() {
    const square::SquareLayout layout = square::paperSquare();
    square::Uncertainty errors = square::noErrors();
    errors.pixel = 0.2;
    errors.placement = 0.005;
    square::Random random(3);
    const auto simulated =
        square::simulateSquare(square::paperRig(), layout, true, errors, true, random);
    truth_ = simulated.truth;
    recording_.square = layout;
    for (const square::CameraSightings& sightings : simulated.sightings) {
      recording_.cameras.emplace_back();
      recording_.cameras.back().sightings = sightings;
    }
  }

  square::CameraSightings& seenBy(std::size_t camera) {
    return recording_.cameras[camera].sightings;
  }
  std::string outcome() const { return outcomeOf(recording_, SolveOptions()); }

  std::vector<geometry::Camera> truth_;
  wave::Recording recording_;
};

TEST_F(SquareMistake, NoneIsNoWarning) {
  const std::string text = outcome();
  EXPECT_EQ(text.find("refused: "), std::string::npos) << text;
  EXPECT_EQ(text.find("most likely"), std::string::npos) << text;
}

TEST_F(SquareMistake, CornerFarFromItsPlace) {
  for (std::size_t corner = 0; corner < 4; ++corner) {
    const wave::Recording good = recording_;
    const Eigen::Vector3d place =
        recording_.square->corners(true)[corner] + Eigen::Vector3d(0.16, -0.12, 0.0);
    for (std::size_t i = 0; i < 4; ++i)
      seenBy(i).corners[corner] = *truth_[i].project(place);
    const std::string text = outcome();
    EXPECT_SAYS(text, "corner " + std::to_string(corner + 1) + " was captured ");
    const std::size_t size = text.find("was captured ") + 13;
    EXPECT_NEAR(std::atof(text.substr(size).c_str()), 200.0, 40.0) << text;
    recording_ = good;
  }
}

TEST_F(SquareMistake, CameraMovedBetweenTheCorners) {
  for (const Eigen::Vector2d& moved :
       {Eigen::Vector2d(60.0, 25.0), Eigen::Vector2d(-60.0, 25.0), Eigen::Vector2d(25.0, 60.0),
        Eigen::Vector2d(-25.0, -60.0), Eigen::Vector2d(0.0, -150.0), Eigen::Vector2d(0.0, 40.0)}) {
    const wave::Recording good = recording_;
    for (std::size_t c = 1; c < 4; ++c)
      *seenBy(1).corners[c] += moved;
    EXPECT_SAYS(outcome(), "camera_2 alone contradicts") << moved.transpose();
    EXPECT_SAYS(outcome(), "then capture all again");
    recording_ = good;
  }
}

TEST_F(SquareMistake, SignificantMisfitIsAWarning) {
  // Each accelerometer alone is within its limit, all together are not: chi-squared is 56 for 16
  // degrees of freedom.
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d axis =
        Eigen::Vector3d::Unit(static_cast<Eigen::Index>(i)).cross(*seenBy(i).gravity);
    *seenBy(i).gravity =
        Eigen::AngleAxisd(13.0 * M_PI / 180.0, axis.normalized()) * *seenBy(i).gravity;
  }
  const std::string text = outcome();
  EXPECT_SAYS(text, "usable");
  EXPECT_SAYS(text, "the cameras disagree 1.");
}

TEST_F(SquareMistake, SidesOfAnotherRatio) {
  recording_.square->side_y = 2.0;
  EXPECT_SAYS(outcome(), "the sides of the square are not 2.5 m and 2 m: the second would be 2.");
}

TEST_F(SquareMistake, AccelerometerWithTurnedAxes) {
  Eigen::Vector3d& gravity = *seenBy(3).gravity;
  gravity = Eigen::AngleAxisd(M_PI / 2.0, Eigen::Vector3d::UnitZ()) * gravity;
  EXPECT_SAYS(outcome(), "the accelerometer of camera_4 contradicts");
}

TEST_F(SquareMistake, WhatAgreesHasNone) {
  const auto mistake = diagnose(recording_, {}, true, {});
  EXPECT_FALSE(mistake) << mistake->text;
}

/// Three of the paper's cameras, square and wave.
class ExtensiveWaveMistake : public ::testing::Test {
 protected:
  ExtensiveWaveMistake() {
    scene_.camera_count = 3;
    scene_.duration = 5.0;
    scene_.rate = 50.0;
    simulate();
  }

  void simulate() {
    const wave::SimulatedWave simulated = wave::simulateWave(scene_, 4);
    truth_ = simulated.cameras;
    corners_ = simulated.corners;
    recording_ = simulated.recording;
  }

  std::string outcome() const {
    SolveOptions options;
    options.wave = wave::optionsFor(scene_);
    options.square.uncertainty = scene_.uncertainty;
    return outcomeOf(recording_, options);
  }

  wave::WaveScene scene_;
  std::vector<geometry::Camera> truth_;
  square::Corners corners_ = square::zeroCorners();
  wave::Recording recording_;
};

TEST_F(ExtensiveWaveMistake, CornerFarFromItsPlace) {
  for (std::size_t i = 0; i < 3; ++i)
    recording_.cameras[i].sightings.corners[1] =
        *truth_[i].project(corners_[1] + Eigen::Vector3d(-0.12, 0.16, 0.0));
  const std::string text = outcome();
  EXPECT_SAYS(text, "corner 2 was captured ");
  EXPECT_NEAR(std::atof(text.substr(text.find("was captured ") + 13).c_str()), 200.0, 40.0);
}

TEST_F(ExtensiveWaveMistake, CameraMovedAfterTheCorners) {
  wave::WaveScene moved = scene_;
  moved.cameras = scene_.poses();
  moved.cameras.resize(3);
  moved.cameras[1].linear() = moved.cameras[1].linear() *
                              Eigen::AngleAxisd(0.06, Eigen::Vector3d::UnitY()).toRotationMatrix();
  recording_.cameras[1].frames = wave::simulateWave(moved, 4).recording.cameras[1].frames;
  const std::string text = outcome();
  EXPECT_SAYS(text, "camera_2 moved by ");
  EXPECT_SAYS(text, "and 3.4 degrees between the corners and the wave");
}

TEST_F(ExtensiveWaveMistake, ClockThatIsWrong) {
  for (wave::Frame& frame : recording_.cameras[2].frames)
    frame.stamp += 1.0;
  EXPECT_NEAR(clockLag(recording_, 2).value_or(0.0), 1.0, 0.05);
  const std::string text = outcome();
  EXPECT_SAYS(text, "the clock of camera_3 is ");
  EXPECT_NEAR(std::atof(text.substr(text.find("camera_3 is ") + 12).c_str()), 1.0, 0.03) << text;
  EXPECT_SAYS(text, "s ahead of the others");
}

TEST_F(ExtensiveWaveMistake, ClockOfAFourthCamera) {
  // Where few images coincide, they correlate by chance.
  scene_.camera_count = 4;
  scene_.duration = 6.0;
  scene_.uncertainty = square::Uncertainty();
  simulate();
  for (wave::Frame& frame : recording_.cameras[2].frames)
    frame.stamp += 1.0;
  EXPECT_NEAR(clockLag(recording_, 2).value_or(0.0), 1.0, 0.05);
}

TEST_F(ExtensiveWaveMistake, ClockThatJumps) {
  for (wave::Frame& frame : recording_.cameras[1].frames)
    frame.stamp += frame.stamp > recording_.cameras[1].frames.front().stamp + 2.0 ? 0.02 : 0.0;
  const std::string text = outcome();
  EXPECT_SAYS(text, "the clock of camera_2 jumped by about ");
  EXPECT_NEAR(std::atof(text.substr(text.find("about ") + 6).c_str()), 20.0, 5.0) << text;
}

TEST_F(ExtensiveWaveMistake, LengthOfTheWand) {
  scene_.length = 0.5;
  scene_.camera_count = 2;
  scene_.duration = 3.0;
  simulate();
  recording_.wand->length = 0.6;
  const std::string text = outcome();
  EXPECT_SAYS(text, "by the square the wand is ");
  EXPECT_NEAR(std::atof(text.substr(text.find("the wand is ") + 12).c_str()), 0.5, 0.005) << text;
}

TEST_F(ExtensiveWaveMistake, LengthByTape) {
  const double length = (corners_[2] - corners_[0]).norm();
  recording_.square->lengths = {{0, 1, (corners_[1] - corners_[0]).norm()}, {0, 2, length + 0.06}};
  const std::string text = outcome();
  EXPECT_SAYS(text, "the length from corner 1 to corner 3 is ");
  EXPECT_NEAR(std::atof(text.substr(text.find("corner 3 is ") + 12).c_str()), length, 0.01) << text;
}

TEST_F(ExtensiveWaveMistake, ExchangedDrivers) {
  std::swap(recording_.cameras[0].frames, recording_.cameras[2].frames);
  EXPECT_SAYS(outcome(), "camera_1 and camera_3 were exchanged");
}

TEST_F(ExtensiveWaveMistake, MirroredImage) {
  for (wave::Frame& frame : recording_.cameras[0].frames) {
    for (Eigen::Vector2d& spot : frame.spots)
      spot.x() = 1023.0 - spot.x();
  }
  EXPECT_SAYS(outcome(), "the image of camera_1 is mirrored");
}

TEST_F(ExtensiveWaveMistake, SidesInCentimetres) {
  recording_.square->side_x = recording_.square->side_y = 250.0;
  EXPECT_SAYS(outcome(), "is the square really 250 m by 250 m");
}

}  // namespace
}  // namespace wiimote_tracker::samples
