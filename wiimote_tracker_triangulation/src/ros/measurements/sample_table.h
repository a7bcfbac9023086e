#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_MEASUREMENTS_SAMPLE_TABLE_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_MEASUREMENTS_SAMPLE_TABLE_H

#include "ros/measurements/writer.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace wiimote_tracker::measurements {

/// Positions of all LEDs at the times start + i / rate.
struct Samples {
  double rate = 0.0;       ///< [Hz]
  std::int64_t start = 0;  ///< [ns since 1970]
  std::size_t frames = 0;
  std::vector<std::string> labels;

  /// Per label, one a frame [m]; NaN in gaps.
  std::vector<std::vector<Eigen::Vector3d>> positions;
};

/// Collects the positions of tracked LEDs, for formats that want all of them at one rate.
class SampleTable {
 public:
  /// Takes it unless the LED is not tracked, or it answers a trigger.
  void add(const Measurement& measurement);

  /// Linear interpolation between neighbours in time. Those further apart than 0.05 s, and more
  /// than 1.5 frames, have a gap between them. @throws Error: more than 1e8 frames, as where a
  /// clock was set meanwhile.
  Samples resample(double rate) const;

 private:
  struct Sample {
    std::int64_t stamp;  // [ns since 1970]
    Eigen::Vector3d position;
  };
  std::map<std::string, std::vector<Sample>> samples_;  // by label
};

}  // namespace wiimote_tracker::measurements

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_MEASUREMENTS_SAMPLE_TABLE_H
