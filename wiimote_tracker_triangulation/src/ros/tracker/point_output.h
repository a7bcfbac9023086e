#pragma once

#include "events/refusals.h"
#include "events/trigger.h"
#include "events/zone_watch.h"
#include "identity/led_labels.h"
#include "message_sink.h"
#include "parameters.h"
#include "volume_correction.h"
#include "wiimote_tracker_triangulation/tracking/estimator.h"

#include <std_msgs/Header.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker {

/// Makes messages of the estimator's snapshots, corrected by the rig's correction of the volume:
/// points after images or at a fixed rate, points at triggers, and events of zones.
class PointOutput {
 public:
  /// `labels`: of the snapshots' LEDs. It and `sink` must live longer.
  PointOutput(const TrackingParameters& parameters,
              const identity::LedLabels* labels,
              MessageSink* sink);

  /// Takes effect at once. `estimator`: with that rig; must live longer.
  /// @returns whether the correction of the volume changed.
  bool setRig(const geometry::Rig& rig, const std::string& rig_id, tracking::Estimator* estimator);

  const VolumeCorrection& correction() const { return correction_; }

  /// Publishes the points at a fixed rate that are due when an image arrives, which the estimator
  /// gets next. @param arrival [s]
  void takeArrival(std::size_t camera, double arrival);

  /// Whether the estimator used that image.
  void noteUse(std::size_t camera, double arrival, bool is_used);

  /// Time begins anew.
  void restart();

  void takeSnapshot(const tracking::Snapshot& snapshot);

  /// See MessageTracker.
  void takeTrigger(const std_msgs::Header& trigger);
  void finish();

 private:
  void publishZoneEvents();
  void answerTriggers();
  void reportRefusals(double now);
  void publishAt(double time);
  void publish(const tracking::Snapshot& corrected);
  wiimote_tracker_msgs::TrackedPointArray messageOf(const tracking::Snapshot& corrected) const;

  OutputOptions options_;
  std::string method_;  // as in TrackedPointArray
  const identity::LedLabels* labels_;
  MessageSink* sink_;
  geometry::Rig rig_;
  std::string rig_id_;
  tracking::Estimator* estimator_ = nullptr;  // null before the first rig
  VolumeCorrection correction_;
  events::ZoneWatch zones_;
  events::Trigger trigger_;  // requests: their times [ns]
  events::Refusals refusals_;

  tracking::Snapshot newest_;     // corrected; time -infinity before the first
  tracking::Snapshot corrected_;  // reused
  double newest_output_ = -std::numeric_limits<double>::infinity();   // [s]
  double newest_arrival_ = -std::numeric_limits<double>::infinity();  // of used images [s]
  std::vector<bool> is_used_;                // per camera: its last image, or it had none yet
  std::optional<std::int64_t> newest_tick_;  // [1 / rate]
  std::vector<wiimote_tracker_msgs::TrackedPoint> lost_;  // LOST, not yet published
};

}  // namespace wiimote_tracker
