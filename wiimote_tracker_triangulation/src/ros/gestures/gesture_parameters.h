#pragma once

#include "gesture/recognizer.h"
#include "gesture/segmenter.h"
#include "gesture/spotter.h"

#include <wiimote_tracker_msgs/parameter_reader.h>
#include <wiimote_tracker_msgs/ros_home.h>

#include <string>
#include <vector>

namespace wiimote_tracker {

/// Parameters of the node; meaning and ranges: config/gestures.yaml.
struct GestureParameters {
  std::string file;                 ///< Never empty once read.
  std::vector<std::string> labels;  ///< Of the LEDs that draw; empty: all.
  bool continuous = false;
  int button = 2;  ///< Index in joy; 2 is A of a Wii Remote.
  gesture::RecognizerOptions recognizer;
  gesture::SegmenterOptions segmenter;
  gesture::SpotterOptions spotter;

  /// @throws ParameterError naming the key that is wrong or unknown.
  static GestureParameters read(ParameterReader* reader) {
    GestureParameters p;
    reader->read("file", &p.file);
    if (p.file.empty())
      p.file = rosHome() + "/wiimote_tracker/gestures.yaml";
    reader->read("labels", &p.labels);

    const std::string boundary =
        reader->choice("boundary", "rest", {"rest", "light", "button", "continuous"});
    p.continuous = boundary == "continuous";
    if (boundary == "light")
      p.segmenter.boundary = gesture::Boundary::kLight;
    if (boundary == "button")
      p.segmenter.boundary = gesture::Boundary::kButton;
    reader->read("button", &p.button, 0, 31);

    gesture::RecognizerOptions& recognizer = p.recognizer;
    reader->read("any_heading", &recognizer.any_heading);
    reader->read("rejection_distance", &recognizer.rejection_distance, 0.01, 10.0);
    reader->read("minimum_length", &recognizer.shape.minimum_length, 0.0, 10.0);
    reader->read("smoothing", &recognizer.shape.smoothing, 0.001, 0.5);

    gesture::SegmenterOptions& segmenter = p.segmenter;
    reader->read("dark_time", &segmenter.dark_time, 0.02, 5.0);
    reader->read("rest_time", &segmenter.rest_time, 0.05, 5.0);
    reader->read("rest_radius", &segmenter.rest_radius, 0.001, 0.5);
    reader->read("minimum_duration", &segmenter.minimum_duration, 0.05, 10.0);
    reader->read("maximum_duration", &segmenter.maximum_duration, segmenter.minimum_duration, 60.0);

    gesture::SpotterOptions& spotter = p.spotter;
    reader->read("continuous/shortest", &spotter.shortest, 0.1, 10.0);
    reader->read("continuous/longest", &spotter.longest, spotter.shortest, 20.0);
    reader->read("continuous/interval", &spotter.interval, 0.01, 1.0);
    reader->read("continuous/minimum_score", &spotter.minimum_score, 0.5, 1.0);
    reader->read("continuous/straight", &spotter.straight, 0.0, 1.0);
    spotter.rest_time = segmenter.rest_time;
    spotter.rest_radius = segmenter.rest_radius;
    spotter.longest_gap = segmenter.dark_time;
    reader->refuseUnknown();
    return p;
  }

  static GestureParameters read(ParameterReader reader) { return read(&reader); }
};

}  // namespace wiimote_tracker
