#ifndef WIIMOTE_TRACKER_CALIBRATION_ROS_INPUT_QUEUE_H
#define WIIMOTE_TRACKER_CALIBRATION_ROS_INPUT_QUEUE_H

#include "camera_inputs.h"

#include <Eigen/Core>

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace wiimote_tracker {

/// An image, or a reading of a camera's accelerometer.
struct Input {
  capture::Image image;                           ///< Of a reading: camera and stamp only.
  std::optional<Eigen::Vector3d> specific_force;  ///< In the camera's optical frame [m/s^2].
};

/// What all cameras sent since it was taken last, for work that takes longer than an image may
/// wait. What a slow computer cannot take in time is left out.
class InputQueue {
 public:
  /// Before inputs->start() only. @param is_wanted whether there is use for inputs now.
  InputQueue(CameraInputs* inputs, std::function<bool(const Lock&)> is_wanted)
      : is_wanted_(std::move(is_wanted)) {
    inputs->subscribeImages([this](const capture::Image& image, const Lock& lock) {
      add({image, std::nullopt}, lock);
    });
    inputs->subscribeGravity([this](const std::string& camera, double stamp,
                                    const Eigen::Vector3d& specific_force, const Lock& lock) {
      Input input{{}, specific_force};
      input.image.camera = camera;
      input.image.stamp = stamp;
      add(std::move(input), lock);
    });
  }
  InputQueue(const InputQueue&) = delete;
  InputQueue& operator=(const InputQueue&) = delete;

  std::vector<Input> take(const Lock&) { return std::exchange(waiting_, {}); }

 private:
  static constexpr std::size_t kMostWaiting = 20000;  // A minute of four cameras.

  void add(Input input, const Lock& lock) {
    if (waiting_.size() < kMostWaiting && is_wanted_(lock))
      waiting_.push_back(std::move(input));
  }

  std::function<bool(const Lock&)> is_wanted_;
  std::vector<Input> waiting_;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_CALIBRATION_ROS_INPUT_QUEUE_H
