#pragma once

#include "group_state.h"
#include "offset_regression.h"
#include "wiimote_tracker_triangulation/tracking/estimator.h"

#include <boost/container/flat_map.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace wiimote_tracker::tracking {

/// By how much the times of the images of a group's cameras are too late. Each offset is a Kalman
/// filter of what the motion shows after the correction so far: so a clock that drifts is followed.
/// A camera pulls the tracks to its wrong times, which hides a part of its offset until the next
/// correction.
///
/// Motion tells differences of clocks only: the median of the known ones is 0.
class ClockOffsets {
 public:
  /// @param members the group's cameras
  explicit ClockOffsets(const std::vector<std::size_t>& members);

  /// @param turn_stddevs of each camera of the rig, see OffsetRegression::estimate().
  void setTurnStddevs(std::vector<double> turn_stddevs) { turn_stddevs_ = std::move(turn_stddevs); }

  /// The camera's images are of this epoch of its clock from now on.
  /// @param is_known whether the rig's time offset holds in it
  void enterEpoch(std::size_t camera, std::uint32_t epoch, bool is_known);

  /// To be subtracted from the times of a camera's images in an epoch, which need not be the
  /// present one; its variance is for their deviation.
  ClockError correctionIn(std::size_t camera, std::uint32_t epoch, bool is_known) const {
    return clocks_.at(camera).in(epoch, is_known).correction();
  }

  /// By how much the times of a camera are corrected though the rig knows its time offset [s].
  double correctionOfKnown(std::size_t camera) const {
    const Clock& clock = clocks_.at(camera);
    return clock.is_known ? clock.correction().offset : 0.0;
  }

  /// Corrects the offsets once LEDs have moved enough since the last time.
  /// @param cameras of the group, after images with the corrections so far
  void update(const CameraStates& cameras);

  /// Changes with the corrections.
  std::uint32_t version() const { return version_; }

 private:
  struct Clock {
    std::uint32_t epoch = 0;
    bool is_known = true;  // by the rig's time offset
    ClockError error;
    bool is_corrected = false;  // by the error: it is not known, or the error is large
    std::optional<OffsetRegression::Estimate> remainder = {};  // left with it at the last update()

    ClockError correction() const { return is_corrected ? error : ClockError(); }
    Clock in(std::uint32_t other_epoch, bool is_known_there) const;
    void updateError(const ClockError& common);
    void setOffset(double seconds);
  };

  bool isReference(const Clock& clock) const;
  ClockError commonRemainder();
  double medianOffset();  // [s]

  std::vector<double> turn_stddevs_;                       // per camera of the rig
  boost::container::flat_map<std::size_t, Clock> clocks_;  // by camera
  std::vector<double> offsets_;                            // reused [s]
  std::uint32_t version_ = 0;
};

}  // namespace wiimote_tracker::tracking
