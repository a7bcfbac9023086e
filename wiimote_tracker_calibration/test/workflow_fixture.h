#pragma once

#include "samples/solve_samples.h"
#include "workflow/calibration.h"

#include "expect_says.h"
#include "simulated_square.h"

#include <wiimote_tracker_msgs/error.h>

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker::workflow {

/// A calibration of the paper's rig, with the LED where a person would put it.
class Workflow : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto poses = square::paperRig();
    for (std::size_t i = 0; i < poses.size(); ++i) {
      geometry::Camera camera;
      camera.name = "camera_" + std::to_string(i + 1);
      camera.world_from_camera = poses[i];
      cameras_.push_back(camera);
      names_.push_back(camera.name);
      facts_[camera.name].identity = "00:00:00:00:00:0" + std::to_string(i);
    }
  }

  /// Captures with the LED at a place that goes along with `speed` [m/s].
  Reply capture(const Eigen::Vector3d& led,
                std::optional<std::size_t> retake = std::nullopt,
                double speed = 0.0) {
    const Reply begun = calibration_.beginCapture(retake, now_);
    if (!begun.success)
      return begun;
    const double start = now_;
    for (; now_ < start + 20.0; now_ += 0.01) {
      const Eigen::Vector3d place = led + (now_ - start) * speed * Eigen::Vector3d::UnitX();
      for (const geometry::Camera& camera : cameras_)
        calibration_.addImage({camera.name, now_, 0, {camera.project(place).value()}, {}});
      calibration_.update(now_);
      if (calibration_.square().outcome())
        return *calibration_.square().outcome();
    }
    return {false, "never ended"};
  }

  void captureAll() {
    ASSERT_TRUE(calibration_.start(2.5, 2.5, names_).success);
    for (const Eigen::Vector3d& corner : kCorners)
      ASSERT_TRUE(capture(corner).success);
  }

  Reply solve(double time) {
    const Reply begun = calibration_.begin(Step::kSolving, "solving");
    if (!begun.success)
      return begun;
    try {
      samples::Solution solution =
          samples::solveSamples(calibration_.samples(facts_, {}), samples::SolveOptions());
      solution.rig.solved_at = time;
      const Reply reply = calibration_.takeSolution(solution.rig);
      calibration_.end();
      return reply;
    } catch (const samples::WrongCorner& error) {
      calibration_.end();
      calibration_.refuseSolution({error.corner});
      return refusal(error.what());
    } catch (const Error& error) {
      calibration_.end();
      calibration_.refuseSolution({});
      return refusal(error.what());
    }
  }

  /// A smooth way through the volume, seen for `duration`; each camera at times of its own.
  void wave(double duration, std::uint32_t epoch_of_first = 0) {
    for (const double end = now_ + duration; now_ < end; now_ += 0.01) {
      for (std::size_t i = 0; i < cameras_.size(); ++i) {
        const double t = now_ + 0.002 * static_cast<double>(i);
        const Eigen::Vector3d led(1.25 + 0.9 * std::sin(1.3 * t), 1.25 + 0.9 * std::cos(1.7 * t),
                                  1.0 + 0.7 * std::sin(2.1 * t));
        calibration_.addImage(
            {names_[i], t, i == 0 ? epoch_of_first : 0U, {cameras_[i].project(led).value()}, {}});
      }
    }
  }

  /// A wand of 0.5 m that lies on the floor, or is waved.
  void waveWand(double duration, bool waves) {
    for (const double end = now_ + duration; now_ < end; now_ += 0.01) {
      const double t = waves ? now_ : 0.0;
      const Eigen::Vector3d led(1.25 + 0.9 * std::sin(1.3 * t), 1.25 + 0.9 * std::sin(1.7 * t),
                                waves ? 1.0 + 0.7 * std::sin(2.1 * t) : 0.0);
      const Eigen::Vector3d other = led + 0.5 * Eigen::Vector3d(std::cos(t), std::sin(t), 0.0);
      for (std::size_t i = 0; i < cameras_.size(); ++i)
        calibration_.addImage(
            {names_[i],
             now_,
             0,
             {cameras_[i].project(led).value(), cameras_[i].project(other).value()},
             {}});
    }
  }

  const std::vector<Eigen::Vector3d> kCorners = {{0.0, 0.0, 0.0},
                                                 {2.5, 0.0, 0.0},
                                                 {2.5, 2.5, 0.0},
                                                 {0.0, 2.5, 0.0}};
  std::vector<geometry::Camera> cameras_;
  std::vector<std::string> names_;
  CameraFacts facts_;
  Calibration calibration_{CalibrationOptions()};
  double now_ = 100.0;
};

}  // namespace wiimote_tracker::workflow
