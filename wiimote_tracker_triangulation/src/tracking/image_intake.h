#pragma once

#include "tracking/computer_clocks.h"
#include "tracking/timed_image.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"
#include "wiimote_tracker_triangulation/tracking/camera_image.h"
#include "wiimote_tracker_triangulation/tracking/estimator.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace wiimote_tracker::tracking {

/// Takes in the images of a rig: gives each its time, judges each camera's clock by the others'
/// (ComputerClocks), and detects that time jumped back for all, as when a bag is played in a loop.
class ImageIntake {
 public:
  static constexpr double kJump = 0.1;  ///< Least jump back [s].

  /// @param stamp_stddev of images without one of their own [s].
  explicit ImageIntake(double stamp_stddev) : stamp_stddev_(stamp_stddev) {}

  /// The clocks are judged anew unless the cameras and, nearly, their time offsets are the same: a
  /// jump back is then recognised when each camera had time for two images.
  /// @returns whether images before and after it can be combined: in the present epoch of its clock
  /// each camera has nearly the same time offset as before.
  bool setRig(const geometry::Rig& rig);

  enum class Result {
    kUsable,
    kWrongClock,  ///< Do not use: its clock, or the time of this image, is not that of the others.
    kJumpedBack   ///< Usable, after a reset.
  };

  /// Judges an image by its arrival, and writes when it was exposed. One whose times are not finite
  /// is of a wrong clock, too. @param clock see Estimator::clockError().
  Result take(std::size_t camera,
              const CameraImage& image,
              const ClockError& clock,
              TimedImage* timed);

  /// See ComputerClocks.
  std::optional<double> ahead(std::size_t camera) const { return clocks_.ahead(camera); }

  /// Whether the last image arrived before an earlier used one.
  bool isDisordered() const { return disordered_; }

 private:
  static constexpr double kNever = -std::numeric_limits<double>::infinity();

  /// How a camera's images go on beside those of the others. One in step is at most kJump behind
  /// the newest of all.
  struct Progress {
    double in_step_until;   // arrival of its newest image in step since the last jump [s]
    int images_behind = 0;  // since that one
    std::optional<std::uint32_t> clock_epoch = {};  // of its last image

    void add(double arrival, bool is_in_step);
  };

  bool keepsTimes(const geometry::Rig& rig) const;
  Result judge(std::size_t camera, double arrival);
  bool hasJumpedBack(std::size_t camera) const;
  bool isBacklog(std::size_t camera) const;

  double stamp_stddev_;
  geometry::Rig rig_;
  ComputerClocks clocks_{0};
  std::vector<Progress> progress_;  // per camera
  double newest_used_ = kNever;     // arrival of the newest image that is used [s]
  std::size_t newest_camera_ = 0;   // whose it is
  std::size_t awaited_ = 0;         // images before a jump back is recognised
  bool disordered_ = false;
};

}  // namespace wiimote_tracker::tracking
