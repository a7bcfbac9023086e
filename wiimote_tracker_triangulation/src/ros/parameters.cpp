#include "parameters.h"

#include <wiimote_tracker_msgs/parameter_reader.h>

#include <algorithm>
#include <vector>

namespace wiimote_tracker {
namespace {

// In the order of geometry::TriangulationMethod.
const std::vector<std::string>& methodNames() {
  static const std::vector<std::string> names = {"mean_closest", "least_squares",
                                                 "maximum_likelihood"};
  return names;
}

std::string checkedLabel(const std::string& key, const std::string& label) {
  const auto isLetter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  const bool good =
      !label.empty() && isLetter(label[0]) && std::all_of(label.begin(), label.end(), [&](char c) {
        return isLetter(c) || (c >= '0' && c <= '9') || c == '_';
      });
  if (!good)
    throw ParameterError(key + " is '" + label +
                         "', but must be a letter, then letters, digits and underscores");
  return label;
}

}  // namespace

std::string methodName(geometry::TriangulationMethod method) {
  return methodNames()[static_cast<std::size_t>(method)];
}

TriangulationParameters TriangulationParameters::read(const ros::NodeHandle& nh) {
  TriangulationParameters p;
  ParameterReader reader(nh);
  p.label = checkedLabel(nh.resolveName("label"), reader.optional("label", p.label));

  geometry::TriangulationOptions& triangulation = p.fuser.triangulation;
  const std::string method =
      reader.choice("method", methodName(triangulation.method), methodNames());
  triangulation.method = static_cast<geometry::TriangulationMethod>(
      std::find(methodNames().begin(), methodNames().end(), method) - methodNames().begin());
  triangulation.pixel_stddev =
      reader.bounded("pixel_stddev", triangulation.pixel_stddev, 0.001, 100.0);
  triangulation.minimum_angle =
      reader.bounded("minimum_angle", triangulation.minimum_angle, 0.001, 1.0);

  p.fuser.maximum_reprojection_error =
      reader.bounded("maximum_reprojection_error", p.fuser.maximum_reprojection_error, 0.1, 1000.0);
  p.fuser.camera_timeout = reader.bounded("camera_timeout", p.fuser.camera_timeout, 0.01, 10.0);
  p.fuser.maximum_gap =
      reader.bounded("maximum_gap", p.fuser.maximum_gap, 0.001, p.fuser.camera_timeout);

  p.markers.rate = reader.bounded("markers/rate", p.markers.rate, 0.1, 100.0);
  p.markers.image_plane_distance =
      reader.bounded("markers/image_plane_distance", p.markers.image_plane_distance, 0.01, 10.0);
  p.markers.trail_duration =
      reader.bounded("markers/trail_duration", p.markers.trail_duration, 0.0, 600.0);

  reader.allow("diagnostic_period");  // read by diagnostic_updater
  reader.refuseUnknown();
  return p;
}

}  // namespace wiimote_tracker
