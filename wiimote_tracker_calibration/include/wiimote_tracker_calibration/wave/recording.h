#pragma once

#include "wiimote_tracker_calibration/square/sightings.h"
#include "wiimote_tracker_calibration/square/square_layout.h"

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <Eigen/Core>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace wiimote_tracker::wave {

/// What a camera reported at one time: the LED's spot, reflections, lamps, in any order.
struct Frame {
  double stamp = 0.0;                  ///< By the camera's own clock [s].
  std::vector<Eigen::Vector2d> spots;  ///< Distorted [px]; empty when it saw nothing.
};

/// All that one camera saw: the square (some corners, all of them or none), then the wave.
struct CameraRecording {
  square::CameraSightings sightings;
  std::uint32_t clock_epoch = 0;  ///< Of the stamps; a later one has another time offset.
  std::vector<Frame> frames;      ///< In the order of their stamps.
  /// Regions of the images whose light was left out. The solvers do without them; a rig has them.
  std::vector<geometry::ImageMask> masks;
};

/// Two LEDs on a stick.
struct Wand {
  double length = 0.0;     ///< Between the LEDs [m, > 0, at most kMaximumLength].
  double stddev = 0.0002;  ///< Of the length as it was measured [m, > 0].
  /// Height of its LEDs above the floor, if it lies there still when the recording begins
  /// [m, >= 0].
  std::optional<double> led_height = {};

  /// Why one on the floor is refused, if no accelerometer is there or may be used.
  static constexpr char kNoUp[] =
      "no camera has an accelerometer that tells where up is: capture a square, or begin the wave "
      "without laying the wand on the floor";

  /// Nobody waves a longer one; it was given in centimetres [m].
  static constexpr double kMaximumLength = 5.0;

  /// @throws WaveError naming the value that is out of range.
  void check() const;
};

/// One calibration session.
struct Recording {
  std::vector<CameraRecording> cameras;
  std::optional<square::SquareLayout> square;  ///< Nothing: no corners were captured.
  std::optional<Wand> wand;                    ///< Nothing: one LED was waved.

  bool hasFrames() const {
    return std::any_of(cameras.begin(), cameras.end(),
                       [](const CameraRecording& camera) { return !camera.frames.empty(); });
  }

  /// Stamps of the first image and of the last one, of any camera [s]; infinite without images.
  std::pair<double, double> span() const {
    double start = std::numeric_limits<double>::infinity();
    double end = -start;
    for (const CameraRecording& camera : cameras) {
      if (camera.frames.empty())
        continue;
      start = std::min(start, camera.frames.front().stamp);
      end = std::max(end, camera.frames.back().stamp);
    }
    return {start, end};
  }

  std::vector<square::CameraSightings> sightings() const {
    std::vector<square::CameraSightings> result;
    for (const CameraRecording& camera : cameras)
      result.push_back(camera.sightings);
    return result;
  }
};

}  // namespace wiimote_tracker::wave
