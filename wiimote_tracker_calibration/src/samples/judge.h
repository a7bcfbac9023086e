#pragma once

#include "samples/samples.h"
#include "samples/verdict.h"
#include "wiimote_tracker_calibration/square/solve_square.h"

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <Eigen/Core>

#include <string>
#include <vector>

namespace wiimote_tracker::samples {

/// Asks whether the lengths are in metres, if a camera is too far from the LED for a Wii Remote, or
/// too near; else empty. @param led where it was seen, world [m].
std::string scaleQuestion(const wave::Recording& recording,
                          const geometry::Rig& rig,
                          const std::vector<Eigen::Vector3d>& led);

/// The verdict of a rig that was loaded: without predictions for points, which its file lacks.
Verdict verdictOf(const geometry::Rig& rig);

/// Grades a solution, as of solveRecording(). @param found the verdict of its rig, which is the
/// solver's, and its warnings are appended. @param pixel standard deviation of a still LED, per
/// axis [px].
Verdict judge(const Samples& samples,
              const square::Solution& found,
              double pixel = square::Uncertainty().pixel);

}  // namespace wiimote_tracker::samples
