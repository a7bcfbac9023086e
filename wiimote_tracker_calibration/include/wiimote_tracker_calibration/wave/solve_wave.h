#pragma once

#include "wiimote_tracker_calibration/square/solve_square.h"
#include "wiimote_tracker_calibration/wave/recording.h"

#include <functional>
#include <string>

namespace wiimote_tracker::wave {

/// What moves, and how it is seen: standard deviations, unless stated otherwise.
struct WaveModel {
  double pixel = 0.5;          ///< Of a moving spot, per axis [px, > 0]; estimated from here.
  double stamp = 0.0;          ///< Independent error of each stamp [s, >= 0].
  double wander = 0.0003;      ///< Error of a camera's stamps, correlated over 2 s [s, >= 0].
  double offset = 0.05;        ///< Prior of a time offset [s, > 0].
  double knot_spacing = 0.05;  ///< Of the LED's path, a cubic spline [s, 0.005 to 0.05].
  double acceleration = 20.0;  ///< Of the LED; bridges times when no camera sees it [m/s^2, > 0].
  double maximum_offset_stddev = 0.0005;  ///< A result less certain of an offset is refused [s].
};

struct WaveOptions : WaveModel {
  /// Of starting intrinsics and corners. Its `pixel` is that of a corner.
  square::Uncertainty uncertainty;
};

/// Called a few times per second or more with what is being done, in words, and the share of the
/// work that is done [0..1], which grows. What it throws ends the work, unless it is a WaveError.
using ProgressCallback = std::function<void(const std::string& step, double fraction)>;

/// One bundle adjustment over all that was recorded: poses, focal lengths, principal points, k1,
/// time offsets (the first camera's is 0), placement of the corners, length of the wand, and the
/// LED's path as a uniform cubic B-spline that each camera sees at its own times. Wrong spots are
/// left out. Scale and world come from the square. Without one, scale comes from the wand, and the
/// world from the wand on the floor if it lay there before: its LED that is nearer to the first
/// camera lies at x = y = 0, the other one at y = 0, both exact; z is up by all accelerometers.
/// Without either, the first camera is the origin, exact; its accelerometer's up is z, or its
/// optical frame is the world.
/// @returns with a wave part; its rig has time offsets, too, in the order of the recording:
/// exposure time = stamp + time offset.
/// @throws WaveError: fewer than two cameras; cameras that share too little; neither square nor
/// wand; an LED that hardly moved, or on a line or a plane only; images that contradict one another
/// (mirrored, moved, other order of corners); a time offset less certain than the options ask for;
/// a wand on the floor that moved, was not level, or of which two cameras did not see both LEDs; no
/// accelerometer for it. square::SquareError: the corners contradict the
/// layout.
square::Solution solveWave(const Recording& recording,
                           const WaveOptions& options,
                           const ProgressCallback& progress = nullptr);

}  // namespace wiimote_tracker::wave
