#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_GESTURES_GESTURE_PARAMETERS_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_GESTURES_GESTURE_PARAMETERS_H

#include "gesture/recognizer.h"
#include "gesture/segmenter.h"
#include "gesture/spotter.h"

#include <wiimote_tracker_msgs/parameter_reader.h>

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
  static GestureParameters read(ParameterReader* reader);
  static GestureParameters read(ParameterReader reader) { return read(&reader); }
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_GESTURES_GESTURE_PARAMETERS_H
