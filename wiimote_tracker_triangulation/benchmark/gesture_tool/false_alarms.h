#ifndef WIIMOTE_TRACKER_TRIANGULATION_BENCHMARK_GESTURE_TOOL_FALSE_ALARMS_H
#define WIIMOTE_TRACKER_TRIANGULATION_BENCHMARK_GESTURE_TOOL_FALSE_ALARMS_H

#include "dataset.h"
#include "gesture/recognizer.h"
#include "gesture/segmenter.h"

#include <cstddef>
#include <string>
#include <vector>

namespace wiimote_tracker::gesture_tool {

/// Gestures found in motion that contains none, summed over all markers.
struct FalseAlarms {
  double minutes = 0.0;           ///< Of motion, summed over the markers [min].
  std::size_t continuous = 0;     ///< Found by the spotter.
  std::size_t between_rests = 0;  ///< Found in segments between rests.
};

/// @param motion  CSV with a header line: time [s], then x, y, z [mm] of each marker.
/// @throws Error.
FalseAlarms countFalseAlarms(const std::vector<Person>& teachers,
                             const std::string& motion,
                             const gesture::RecognizerOptions& options);

}  // namespace wiimote_tracker::gesture_tool

#endif  // WIIMOTE_TRACKER_TRIANGULATION_BENCHMARK_GESTURE_TOOL_FALSE_ALARMS_H
