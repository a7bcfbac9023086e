#pragma once

#include "capture/image.h"
#include "health/turned_camera.h"

#include <wiimote_tracker_triangulation/geometry/rig.h>
#include <wiimote_tracker_triangulation/tracking/tracker.h>

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <vector>

namespace wiimote_tracker::health {

/// Follows one LED while several are seen. Each image keeps the spot of this LED, or none where the
/// spot is ambiguous. A tracker locates the LEDs, with the estimated orientations of the cameras
/// (TurnedCamera). The moving LED that most cameras show is followed; between two LEDs images keep
/// no spot for a while. An image over 0.2 s older than the newest keeps none. While no camera sees
/// several LEDs, images are unchanged, as are those of a rig with RayModel::kImageCenter, which is
/// not judged. A deterministic function of the images.
class LedSelection {
 public:
  explicit LedSelection(const geometry::Rig& rig);

  /// Whether it may go on with this rig (geometry::isSameCamera), as after a step of continuous
  /// calibration, or with other masks.
  bool suits(const geometry::Rig& rig) const;

  /// One image of any camera; of one camera in the order of their stamps.
  /// @returns it, or the same with at most one spot. Valid until the next call.
  const capture::Image& select(const capture::Image& image);

 private:
  struct Led {
    std::uint32_t id;
    Eigen::Vector3d position;  // World [m].
    Eigen::Vector3d velocity;  // [m/s]
  };
  /// The tracked LEDs at a time [s].
  struct Moment {
    double time;
    std::vector<Led> leds;
  };
  struct Camera {
    TurnedCamera turned;
    int several_in_a_row = 0;                 // Successive images with several spots.
    std::map<std::uint32_t, double> shown{};  // When it last showed LEDs clearly, by their ids [s].
  };

  bool noteSeveral(const capture::Image& image, Camera* camera);
  void track(std::size_t camera, const capture::Image& image);
  void useTurnOf(std::size_t camera, double time);
  void forget(double time);
  void startAnew(bool are_several, double time);
  std::vector<Led> ledsAt(double time) const;
  std::size_t worthOf(const Led& led, double time) const;
  void follow(const std::vector<Led>& leds, double time);
  std::optional<std::uint32_t> followedAt(double time) const;
  bool isSilent(double time) const { return std::abs(time - silence_) < capture::kLongestGap; }

  geometry::Rig rig_;
  geometry::Rig tracked_rig_;    // With the estimated orientations.
  std::vector<Camera> cameras_;  // Of the rig.
  double last_several_ = -std::numeric_limits<double>::infinity();  // [s]
  std::unique_ptr<tracking::Tracker> tracker_;                      // Null while there is one LED.
  std::deque<Moment> moments_;                                      // Of the tracker, the latest.
  std::optional<std::uint32_t> followed_;
  double followed_since_ = 0.0;                   // [s]
  std::optional<std::uint32_t> followed_before_;  // Until then.
  double last_best_ = 0.0;                        // No other one was shown by more cameras [s].
  // Images within kLongestGap of this time keep no spot [s].
  double silence_ = -std::numeric_limits<double>::infinity();
  capture::Image selected_;
};

}  // namespace wiimote_tracker::health
