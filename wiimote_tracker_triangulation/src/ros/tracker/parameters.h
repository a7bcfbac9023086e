#pragma once

#include "body_parameters.h"
#include "events/trigger.h"
#include "events/zone_watch.h"
#include "wiimote_tracker_triangulation/estimators/make_estimator.h"
#include "wiimote_tracker_triangulation/identity/identifier.h"

#include <wiimote_tracker_msgs/parameter_reader.h>

#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker {

/// When to publish `points`.
struct OutputOptions {
  bool on_update = true;           ///< For every image that adds information.
  double interval = 0.0;           ///< Least time from one message of points to the next [s].
  double rate = 0.0;               ///< At this rate [Hz]; 0: not at a fixed rate.
  bool predict_to_now = false;     ///< Predict to the newest image's arrival, not its exposure.
  bool publish_predicted = false;  ///< Topics and transforms of predicted LEDs and bodies too.
  bool led_odometry = false;       ///< Publish <label>/odometry.
  bool body_transforms = true;     ///< Publish the transforms of bodies.
};

/// See MarkerBuilder.
struct MarkerOptions {
  double rate = 20.0;                 ///< Most arrays per second [Hz, > 0].
  double image_plane_distance = 0.5;  ///< Along the optical axis [m, > 0].
  double trail_duration = 10.0;       ///< [s, >= 0].
};

/// How LEDs that blink are identified.
struct IdentityOptions {
  std::optional<identity::BlinkCodes> codes;  ///< Nothing: no LED blinks.
  double exposure = 0.002;                    ///< See identity::SnapshotSightingsOptions [s].
  identity::IdentifierOptions identifier;
};

/// Parameters of the node and of track_bag; meaning and ranges: config/triangulation.yaml.
struct TrackingParameters {
  std::vector<std::string> labels = {"led"};
  std::string label_places;  ///< For identity::placesFile; empty: none. Only the node uses it.
  IdentityOptions identity;
  estimators::EstimatorOptions estimator;  ///< With codes: adapted by forBlinking.
  BodyParameters bodies;
  OutputOptions output;
  events::ZoneWatchOptions zones;
  events::TriggerOptions trigger;
  MarkerOptions markers;
  double clock_tolerance = 0.02;  ///< See HostClockCheck [s].

  /// @throws ParameterError naming the key that is wrong or unknown.
  static TrackingParameters read(ParameterReader* reader);
  static TrackingParameters read(ParameterReader reader) { return read(&reader); }

  std::vector<std::string> blinkingLabels() const;  ///< Of the blink codes.
  std::vector<std::string> allLabels() const;       ///< `labels`, and those of the blink codes.
};

/// With blink codes: the tracker's parameters that they change, in a sentence; else empty.
std::string describeIdentity(const TrackingParameters& parameters);

/// Names a camera that sees no LED with another, since it is too far from all others or
/// maximum_range is too small: what to do; else empty.
std::string describeLoneCamera(const geometry::Rig& rig,
                               const estimators::EstimatorOptions& options);

/// "track", or the triangulation method.
std::string methodWord(const estimators::EstimatorOptions& options);

}  // namespace wiimote_tracker
