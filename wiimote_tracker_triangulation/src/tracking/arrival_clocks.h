#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_ARRIVAL_CLOCKS_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_ARRIVAL_CLOCKS_H

#include "tracking/clock_agreement.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"
#include "wiimote_tracker_triangulation/tracking/camera_image.h"

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

namespace wiimote_tracker::tracking {

/// When an image was exposed and when it arrived, both with the rig's time offset [s].
struct ImageTimes {
  double exposure;
  double arrival;
};

ImageTimes timesOf(const geometry::RigCamera& camera, const CameraImage& image);

/// Judges each camera's clock by the others' (ClockAgreement), and detects that time jumped back
/// for all, as when a bag is played in a loop.
class ArrivalClocks {
 public:
  static constexpr double kJump = 0.1;  ///< Least jump back [s].

  /// @param newest_used newestUsed() of those that these follow, of other cameras. A jump
  /// back behind it is recognised when each camera had time for two images.
  explicit ArrivalClocks(std::size_t cameras,
                         double newest_used = -std::numeric_limits<double>::infinity());

  enum class Result {
    kUsable,
    kWrongClock,  ///< Do not use: its clock, or the time of this image, is not that of the others.
    kJumpedBack   ///< Usable, after a reset.
  };

  /// Checks an image, whose arrival is by the clock of its camera's computer. One whose times are
  /// not finite is of a wrong clock, too.
  Result check(std::size_t camera, const ImageTimes& times);

  /// See ClockAgreement.
  std::optional<double> ahead(std::size_t camera) const { return agreement_.ahead(camera); }

  /// Arrival of the newest image that is used [s]; before the first, as given or minus infinity.
  double newestUsed() const { return newest_used_; }

  /// Whether the last image arrived before an earlier used one.
  bool isDisordered() const { return disordered_; }

 private:
  /// How a camera's images go on beside those of the others. One in step is at most kJump behind
  /// the newest of all.
  struct Progress {
    double in_step_until;   // arrival of its newest image in step since the last jump [s]
    int images_behind = 0;  // since that one

    void add(double arrival, bool is_in_step);
  };

  bool hasJumpedBack(std::size_t camera) const;
  bool isBacklog(std::size_t camera) const;

  ClockAgreement agreement_;
  std::vector<Progress> progress_;  // per camera
  double newest_used_;              // arrival [s]
  std::size_t newest_camera_ = 0;   // whose it is
  std::size_t awaited_;             // images before a jump back is recognised
  bool disordered_ = false;
};

}  // namespace wiimote_tracker::tracking

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_ARRIVAL_CLOCKS_H
