#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_PARAMETERS_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_PARAMETERS_H

#include "bodies/body_parameters.h"
#include "marker_builder.h"
#include "wiimote_tracker_triangulation/events/trigger.h"
#include "wiimote_tracker_triangulation/events/zone_watch.h"
#include "wiimote_tracker_triangulation/identity/identifier.h"
#include "wiimote_tracker_triangulation/tracking/make_estimator.h"

#include <wiimote_tracker_msgs/parameter_reader.h>

#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker {

/// When `points` go out.
struct OutputOptions {
  bool on_update = true;           ///< For every image, as far as it says something new.
  double rate = 0.0;               ///< At this rate [Hz]; 0: not at a rate.
  bool predict_to_now = false;     ///< For the arrival of the newest image, not its exposure.
  bool publish_predicted = false;  ///< Hidden LEDs too have their point topic and transform.
};

/// How LEDs that blink are told apart.
struct IdentityOptions {
  std::optional<identity::BlinkCodes> codes;  ///< Nothing: no LED blinks.
  double exposure = 0.002;                    ///< See identity::SnapshotSightingsOptions [s].
  identity::IdentifierOptions identifier;
};

/// Parameters of the node and of track_bag; meaning and ranges: config/triangulation.yaml.
struct TrackingParameters {
  std::vector<std::string> labels = {"led"};
  IdentityOptions identity;
  tracking::EstimatorOptions estimator;  ///< With codes: what they ask of it (see forBlinking).
  BodyParameters bodies;
  OutputOptions output;
  events::ZoneWatchOptions zones;
  events::TriggerOptions trigger;
  MarkerOptions markers;
  double clock_tolerance = 0.02;  ///< See ClockWatch [s].

  /// @throws ParameterError naming the key that is wrong or unknown.
  static TrackingParameters read(ParameterReader reader);

  /// `labels`, and those of the blink codes.
  std::vector<std::string> allLabels() const;
};

/// With blink codes: what follows from them for the tracker, in a sentence; else empty.
std::string describeIdentity(const TrackingParameters& parameters);

/// How points are computed, in a word: "track", or the triangulation method.
std::string methodWord(const tracking::EstimatorOptions& options);

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_PARAMETERS_H
