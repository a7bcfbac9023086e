#ifndef WIIMOTE_TRACKER_TRIANGULATION_BODY_LEARN_CONSTELLATION_H
#define WIIMOTE_TRACKER_TRIANGULATION_BODY_LEARN_CONSTELLATION_H

#include "wiimote_tracker_triangulation/body/constellation.h"

#include <Eigen/Core>

#include <cstdint>
#include <string>
#include <vector>

namespace wiimote_tracker::body {

/// The LEDs that were seen at one time.
struct LedsInstant {
  struct Led {
    std::uint32_t id;          ///< Of its track; an LED may get another one after it was hidden.
    Eigen::Vector3d position;  ///< World [m].
    double stddev;             ///< Of each coordinate [m, > 0]; only their proportions matter.
  };
  double time;  ///< [s]
  std::vector<Led> leds;
};

struct LearnedConstellation {
  /// Its origin is the mean of the LEDs; its axes are the world's at the first time that all of
  /// them were seen. LEDs are in the order of their ids there.
  Constellation constellation;
  std::vector<std::uint32_t> ids;  ///< Of those LEDs then.

  /// Of each LED's place in the body, root mean square over the axes [m]: from how much the places
  /// of eight parts of the recording differ. It says nothing of the cameras' own errors.
  std::vector<double> stddev;
};

/// The shape of a rigid body from how its LEDs were seen while it was held or turned: the mean of
/// all instants after each was aligned with it (generalised Procrustes analysis, Gower 1975).
/// @param instants in the order of time.
/// Constellation::check has the last word: LEDs that blink may be given their labels first, with
/// which a symmetric shape is welcome.
/// @throws Error saying what to do: too few or too many LEDs, LEDs that move against each other
/// (by more than 10 mm, root mean square), or too short.
LearnedConstellation learnConstellation(const std::string& name,
                                        const std::vector<LedsInstant>& instants);

}  // namespace wiimote_tracker::body

#endif  // WIIMOTE_TRACKER_TRIANGULATION_BODY_LEARN_CONSTELLATION_H
