#pragma once

#include "geometry/output_file.h"
#include "ros/measurements/writer.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace wiimote_tracker::measurements {

/// Positions of all LEDs at the times start + i / rate: single ones, then those of bodies.
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

  /// Takes the LEDs of tracked bodies, also hidden ones, where the pose has them, as "BODY:LED".
  void addBodies(const wiimote_tracker_msgs::TrackedBodyArray& bodies);

  /// Linear interpolation between neighbours in time. Those further apart than 0.05 s, and more
  /// than 1.5 frames, have a gap between them. @throws Error: frames times LEDs are more than 2e8,
  /// as where a clock was set meanwhile, or reflections came and went for hours: each of their
  /// tracks is an LED of its own.
  Samples resample(double rate) const;

 private:
  struct Sample {
    std::int64_t stamp;  // [ns since 1970]
    Eigen::Vector3d position;
  };
  std::map<std::pair<bool, std::string>, std::vector<Sample>> samples_;  // by "of a body", label
};

/// A file of a format that wants all positions at one rate.
class SampledWriter : public Writer {
 public:
  /// @param rate [Hz]. @param write writes the content. @throws Error: the file cannot be created.
  SampledWriter(const std::string& path,
                double rate,
                std::function<void(const Samples&, OutputFile*)> write)
      : path_(path), file_(open(path)), rate_(rate), write_(std::move(write)) {}

  void add(const Measurement& measurement) override { table_.add(measurement); }

  void addBodies(const wiimote_tracker_msgs::TrackedBodyArray& bodies) override {
    table_.addBodies(bodies);
  }

  std::string finish() override {
    const Samples samples = table_.resample(rate_);
    write_(samples, file_);
    Writer::finish();
    return path_ + (samples.frames == 0
                        ? ": no frames, since nothing was tracked"
                        : ": frame 1 is at " + secondsOf(samples.start) + " s since 1970");
  }

 private:
  std::string path_;
  OutputFile* file_;
  double rate_;
  std::function<void(const Samples&, OutputFile*)> write_;
  SampleTable table_;
};

}  // namespace wiimote_tracker::measurements
