#pragma once

#include "motion/smoother.h"
#include "ros/tracker/message_sink.h"
#include "wiimote_tracker_triangulation/geometry/calibration_uncertainty.h"
#include "wiimote_tracker_triangulation/tracking/tracker_options.h"

#include <wiimote_tracker_msgs/interruption.h>

#include <algorithm>
#include <cstdint>
#include <deque>
#include <limits>
#include <map>
#include <optional>
#include <vector>

namespace wiimote_tracker {

/// Collects the spots of each LED while a recording is tracked, then smooths each LED's motion. The
/// same recording, tracked again, gets the smoothed states.
class SmoothedTracks : public SnapshotFilter {
  using Snapshot = tracking::Snapshot;
  using SpotUse = tracking::SpotUse;
  using TrackedLed = tracking::TrackedLed;
  using TrackState = tracking::TrackState;

 public:
  explicit SmoothedTracks(const tracking::TrackerOptions& options) : options_(options) {}

  void setRig(const geometry::Rig& rig) override {
    cameras_.push_back(rig.rayCameras());
    noises_.clear();
    for (const geometry::RigCamera& camera : rig.cameras)
      noises_.push_back(geometry::pixelNoise(camera, options_.learnt_noise, options_.pixel_stddev));
    uncertainty_.emplace(rig);
    newest_.resize(rig.cameras.size(), -std::numeric_limits<double>::infinity());
  }

  /// Before smooth(): the same snapshot. Then that with smoothed positions, velocities and their
  /// covariances; all else stays.
  const Snapshot& apply(const Snapshot& snapshot) override {
    if (!is_smoothed_) {
      collect(snapshot);
      return snapshot;
    }
    smoothed_ = snapshot;
    for (TrackedLed& led : smoothed_.leds) {
      Track& track = tracks_.at(led.id);
      if (led.state != TrackState::kLost) {  // a lost LED stays where it was last
        const auto place =
            std::lower_bound(track.places.begin(), track.places.end(), snapshot.time,
                             [](const motion::Place& p, double time) { return p.time < time; });
        const motion::KinematicState& state = track.states.at(place - track.places.begin());
        track.last.position = state.position();
        track.last.position_covariance = state.positionCovariance();
        track.last.velocity = state.velocity();
        track.last.velocity_covariance = state.velocityCovariance();
        if (const auto calibration = uncertainty_->covarianceNear(
                led.position, led.located_by.data(), led.located_by.size()))
          track.last.position_covariance += *calibration;
      }
      led.position = track.last.position;
      led.position_covariance = track.last.position_covariance;
      led.velocity = track.last.velocity;
      led.velocity_covariance = track.last.velocity_covariance;
    }
    return smoothed_;
  }

  /// Call it when the recording was tracked once.
  void smooth() {
    is_smoothed_ = true;
    for (auto& [id, track] : tracks_) {
      throwIfInterrupted();
      std::stable_sort(track.observations.begin(), track.observations.end(),
                       [](auto& a, auto& b) { return a.time < b.time; });
      track.states = motion::smooth(options_.motion, track.observations, track.places);
      track.observations = {};
    }
  }

 private:
  struct Track {
    std::vector<motion::Observation> observations;
    std::vector<motion::Place> places;
    std::vector<motion::KinematicState> states;  // one per place
    TrackedLed last;                             // that was smoothed
  };

  void collect(const Snapshot& snapshot) {
    for (std::size_t camera = 0; camera < snapshot.views.size(); ++camera) {
      const std::optional<double>& time = snapshot.views[camera].time;
      if (!time)
        continue;
      collectSpots(camera, SpotUse::kStart, snapshot);
      if (*time != newest_[camera])
        collectSpots(camera, SpotUse::kAssigned, snapshot);
      newest_[camera] = *time;
    }
    for (const TrackedLed& led : snapshot.leds) {
      if (led.state != TrackState::kLost)
        tracks_[led.id].places.push_back({snapshot.time, led.position});
    }
  }

  /// Adds the spots of a camera's newest image that are used so to their LEDs. Those that began a
  /// track may be of an older image, and are added before the track has its first place.
  void collectSpots(std::size_t camera, SpotUse use, const Snapshot& snapshot) {
    const tracking::CameraView& view = snapshot.views[camera];
    for (const tracking::SeenSpot& spot : view.spots) {
      if (spot.use != use || mayBeMerged(spot, camera, snapshot))
        continue;
      Track& track = tracks_[spot.led];
      if (use == SpotUse::kAssigned || track.places.empty())
        track.observations.push_back({*view.time,
                                      &cameras_.back()[camera],
                                      spot.pixel,
                                      {noises_[camera], view.stamp_stddev}});
    }
  }

  /// Whether another LED that is seen, but not here, is so close that the spot may be of both.
  bool mayBeMerged(const tracking::SeenSpot& spot,
                   std::size_t camera,
                   const Snapshot& snapshot) const {
    const auto& spots = snapshot.views[camera].spots;
    return std::any_of(snapshot.leds.begin(), snapshot.leds.end(), [&](const TrackedLed& led) {
      if (led.id == spot.led || led.cameras.empty() || led.state == TrackState::kLost ||
          led.state == TrackState::kTentative)
        return false;
      const auto pixel = cameras_.back()[camera].project(led.position);
      return pixel && (*pixel - spot.pixel).norm() < options_.merging_distance &&
             std::none_of(spots.begin(), spots.end(), [&](const tracking::SeenSpot& other) {
               return other.use == SpotUse::kAssigned && other.led == led.id;
             });
    });
  }

  tracking::TrackerOptions options_;
  std::deque<std::vector<geometry::Camera>> cameras_;  // of each rig; observations refer to them
  std::vector<double> noises_;                         // of a pixel coordinate, per camera [px]
  std::vector<double> newest_;             // image of each camera that was collected [s]
  std::map<std::uint32_t, Track> tracks_;  // by id
  std::optional<geometry::CalibrationUncertainty> uncertainty_;
  bool is_smoothed_ = false;
  Snapshot smoothed_;
};

}  // namespace wiimote_tracker
