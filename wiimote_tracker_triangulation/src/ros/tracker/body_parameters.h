#pragma once

#include "body/body_tracker.h"
#include "body/constellation.h"
#include "wiimote_tracker_triangulation/tracking/tracker_options.h"

#include <wiimote_tracker_msgs/parameter_reader.h>

#include <string>
#include <vector>

namespace wiimote_tracker {

/// The group `bodies` of the parameters; meaning and ranges: config/triangulation.yaml.
struct BodyParameters {
  std::string file;  ///< Empty: no bodies.
  body::BodyTrackerOptions options;
  std::vector<body::Constellation> known;  ///< Of the file; empty when it does not exist.

  /// @param images used for bodies too.
  /// @param labels names that a body must not have.
  /// @throws ParameterError naming the key, or the file and what is wrong with it.
  static BodyParameters read(ParameterReader* reader,
                             const tracking::ImageOptions& images,
                             const std::vector<std::string>& labels);
};

/// Says that the file of bodies does not exist and what to do; empty when it exists or none is
/// named. That is no error: the service learn_body creates it.
std::string describeMissingFile(const std::string& file);

/// What is wrong with bodies that are nearly symmetric, have LEDs close together, or the shape of
/// another one.
std::vector<std::string> shapeWarnings(const std::vector<body::Constellation>& bodies);

/// Which labels of bodies no LED can have, since only LEDs that blink are identified for a body.
/// @param codes labels of the blink codes.
std::vector<std::string> labelWarnings(const std::vector<body::Constellation>& bodies,
                                       const std::vector<std::string>& codes);

}  // namespace wiimote_tracker
