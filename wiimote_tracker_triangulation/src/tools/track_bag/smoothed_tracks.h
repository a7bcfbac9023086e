#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_TOOLS_TRACK_BAG_SMOOTHED_TRACKS_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_TOOLS_TRACK_BAG_SMOOTHED_TRACKS_H

#include "motion/smoother.h"
#include "ros/tracker/message_sink.h"
#include "wiimote_tracker_triangulation/geometry/calibration_uncertainty.h"
#include "wiimote_tracker_triangulation/tracking/tracker_options.h"

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <vector>

namespace wiimote_tracker {

/// Collects the spots of each LED while a recording is tracked, then smooths each LED's motion. The
/// same recording, tracked again, gets the smoothed states.
class SmoothedTracks : public SnapshotFilter {
 public:
  explicit SmoothedTracks(const tracking::TrackerOptions& options) : options_(options) {}

  void setRig(const geometry::Rig& rig) override;

  /// Before smooth(): the same snapshot. Then that with smoothed positions, velocities and their
  /// covariances; all else stays.
  const tracking::Snapshot& apply(const tracking::Snapshot& snapshot) override;

  /// Call it when the recording was tracked once.
  void smooth();

 private:
  struct Track {
    std::vector<motion::Observation> observations;
    std::vector<motion::Place> places;
    std::vector<motion::KinematicState> states;  // one per place
    tracking::TrackedLed last;                   // that was smoothed
  };

  void collect(const tracking::Snapshot& snapshot);
  void collectSpots(std::size_t camera, tracking::SpotUse use, const tracking::Snapshot& snapshot);
  bool mayBeMerged(const tracking::SeenSpot& spot,
                   std::size_t camera,
                   const tracking::Snapshot& snapshot) const;

  tracking::TrackerOptions options_;
  std::deque<std::vector<geometry::Camera>> cameras_;  // of each rig; observations refer to them
  std::vector<double> noises_;                         // of a pixel coordinate, per camera [px]
  std::vector<double> newest_;             // image of each camera that was collected [s]
  std::map<std::uint32_t, Track> tracks_;  // by id
  std::optional<geometry::CalibrationUncertainty> uncertainty_;
  bool is_smoothed_ = false;
  tracking::Snapshot smoothed_;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_TOOLS_TRACK_BAG_SMOOTHED_TRACKS_H
