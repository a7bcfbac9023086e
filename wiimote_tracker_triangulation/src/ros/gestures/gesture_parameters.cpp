#include "gesture_parameters.h"

#include <wiimote_tracker_msgs/parameter_reader.h>

#include <cstdlib>

namespace wiimote_tracker {
namespace {

std::string defaultFile() {
  const char* ros_home = std::getenv("ROS_HOME");
  if (ros_home != nullptr && *ros_home != '\0')
    return std::string(ros_home) + "/wiimote_tracker/gestures.yaml";
  const char* home = std::getenv("HOME");
  return std::string(home != nullptr ? home : "") + "/.ros/wiimote_tracker/gestures.yaml";
}

}  // namespace

GestureParameters GestureParameters::read(const ros::NodeHandle& nh) {
  GestureParameters p;
  ParameterReader reader(nh);
  p.file = reader.optional<std::string>("file", "");
  if (p.file.empty())
    p.file = defaultFile();
  p.labels = reader.optional<std::vector<std::string>>("labels", p.labels);

  const std::string boundary =
      reader.choice("boundary", "rest", {"rest", "light", "button", "continuous"});
  p.continuous = boundary == "continuous";
  if (boundary == "light")
    p.segmenter.boundary = gesture::Boundary::kLight;
  if (boundary == "button")
    p.segmenter.boundary = gesture::Boundary::kButton;
  p.button = reader.bounded("button", p.button, 0, 31);

  gesture::RecognizerOptions& recognizer = p.recognizer;
  recognizer.any_heading = reader.optional("any_heading", recognizer.any_heading);
  recognizer.rejection_distance =
      reader.bounded("rejection_distance", recognizer.rejection_distance, 0.01, 10.0);
  recognizer.shape.minimum_length =
      reader.bounded("minimum_length", recognizer.shape.minimum_length, 0.0, 10.0);
  recognizer.shape.smoothing = reader.bounded("smoothing", recognizer.shape.smoothing, 0.001, 0.5);

  gesture::SegmenterOptions& segmenter = p.segmenter;
  segmenter.dark_time = reader.bounded("dark_time", segmenter.dark_time, 0.02, 5.0);
  segmenter.rest_time = reader.bounded("rest_time", segmenter.rest_time, 0.05, 5.0);
  segmenter.rest_radius = reader.bounded("rest_radius", segmenter.rest_radius, 0.001, 0.5);
  segmenter.minimum_duration =
      reader.bounded("minimum_duration", segmenter.minimum_duration, 0.05, 10.0);
  segmenter.maximum_duration = reader.bounded("maximum_duration", segmenter.maximum_duration,
                                              segmenter.minimum_duration, 60.0);

  gesture::SpotterOptions& spotter = p.spotter;
  spotter.shortest = reader.bounded("continuous/shortest", spotter.shortest, 0.1, 10.0);
  spotter.longest = reader.bounded("continuous/longest", spotter.longest, spotter.shortest, 20.0);
  spotter.interval = reader.bounded("continuous/interval", spotter.interval, 0.01, 1.0);
  spotter.minimum_score =
      reader.bounded("continuous/minimum_score", spotter.minimum_score, 0.5, 1.0);
  spotter.straight = reader.bounded("continuous/straight", spotter.straight, 0.0, 1.0);
  spotter.rest_time = segmenter.rest_time;
  spotter.rest_radius = segmenter.rest_radius;
  spotter.longest_hole = segmenter.dark_time;
  reader.refuseUnknown();
  return p;
}

}  // namespace wiimote_tracker
