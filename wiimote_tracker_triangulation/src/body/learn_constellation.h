#pragma once

#include "body/constellation.h"

#include <Eigen/Core>

#include <cstdint>
#include <string>
#include <vector>

namespace wiimote_tracker::body {

/// The LEDs seen at one time.
struct LedsInstant {
  struct Led {
    std::uint32_t id;          ///< Of its track; may change after the LED was hidden.
    Eigen::Vector3d position;  ///< World [m].
    double stddev;             ///< Per coordinate [m, > 0]; only ratios matter.
  };
  double time;  ///< [s]
  std::vector<Led> leds;
};

struct LearnedConstellation {
  /// The origin is the mean of the LEDs. The axes are those of the world at the first instant that
  /// shows all LEDs; the LEDs are in the order of their ids there.
  Constellation constellation;
  std::vector<std::uint32_t> ids;  ///< Of the tracks at that instant.

  /// Of each LED's position in the body, RMS over the axes [m], from the differences between eight
  /// parts of the recording. Does not include errors of the calibration.
  std::vector<double> stddev;
};

/// Estimates the shape of a rigid body from a recording of it held or turned: the mean of all
/// instants, each aligned with it (generalised Procrustes analysis, Gower 1975). The caller adds
/// labels of blinking LEDs, with which a symmetric shape is allowed, and calls
/// Constellation::check.
/// @param instants sorted by time.
/// @throws Error saying what to do: too few or too many LEDs, LEDs that move relative to each other
/// (RMS above 10 mm), or a recording that is too short.
LearnedConstellation learnConstellation(const std::string& name,
                                        const std::vector<LedsInstant>& instants);

}  // namespace wiimote_tracker::body
