#include "body_parameters.h"

#include "../parameter_group.h"
#include "body/bodies_file.h"
#include "wiimote_tracker_triangulation/geometry/error.h"

#include <algorithm>
#include <filesystem>

namespace wiimote_tracker {
namespace {

std::vector<body::Constellation> readKnown(const std::string& file,
                                           const std::vector<std::string>& labels) {
  if (file.empty() || !std::filesystem::exists(file))
    return {};
  std::vector<body::Constellation> bodies = body::readBodies(file);
  for (const body::Constellation& body : bodies) {
    if (std::find(labels.begin(), labels.end(), body.name) != labels.end())
      throw Error("body '" + body.name + "' of " + file +
                  " has the name of an LED; rename one of them");
  }
  return bodies;
}

}  // namespace

BodyParameters BodyParameters::read(ParameterReader* reader,
                                    const tracking::TrackerOptions& tracks,
                                    const std::vector<std::string>& labels) {
  BodyParameters p;
  const ParameterGroup group(reader, "bodies");
  group.read("file", &p.file);
  try {
    p.known = readKnown(p.file, labels);
  } catch (const geometry::Error& error) {
    throw ParameterError(reader->nameOf("bodies/file") + ": " + error.what());
  }
  body::BodyTrackerOptions& o = p.options;
  o.pixel_stddev = tracks.pixel_stddev;
  o.merging_distance = tracks.merging_distance;
  o.history = tracks.history;
  o.maximum_range = tracks.maximum_range;
  group.read("gate", &o.gate, 4.0, 100.0);
  group.read("tracked_time", &o.tracked_time, 0.001, 1.0);
  group.read("prediction_time", &o.prediction_time, 0.01, 10.0);
  group.read("window", &o.window, 0.001, 0.2);
  group.read("window_motion", &o.window_motion, 1e-5, 0.1);
  group.read("minimum_margin", &o.minimum_margin, 0.0, 1000.0);
  body::PoseFilterOptions& motion = o.motion;
  group.read("acceleration_density", &motion.acceleration_density, 0.0, 1000.0);
  group.read("angular_acceleration_density", &motion.angular_acceleration_density, 0.0, 1000.0);
  group.read("initial_speed", &motion.initial_speed, 0.001, 1000.0);
  group.read("initial_angular_speed", &motion.initial_angular_speed, 0.001, 1000.0);
  return p;
}

std::vector<std::string> ambiguities(const std::vector<body::Constellation>& bodies) {
  std::vector<std::string> sentences;
  for (const body::Constellation& body : bodies) {
    const body::Symmetry symmetry = body::nearestSymmetry(body);
    if (symmetry.residual < body::kNearlySymmetric && body.labels.empty())
      sentences.push_back(body::describe(body, symmetry));
  }
  return sentences;
}

}  // namespace wiimote_tracker
