#ifndef WIIMOTE_TRACKER_TRIANGULATION_BODY_CONSTELLATION_H
#define WIIMOTE_TRACKER_TRIANGULATION_BODY_CONSTELLATION_H

#include <Eigen/Core>

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace wiimote_tracker::body {

constexpr std::size_t kMaximumLeds = 8;  ///< Of one body.

/// The LEDs of a rigid body.
struct Constellation {
  std::string name;                   ///< Also its TF frame: a letter, then letters, digits, _.
  std::vector<Eigen::Vector3d> leds;  ///< In the body's frame [m]; 3 to kMaximumLeds.

  /// Of LEDs that blink, one for each, by which they are told apart where the shape does not tell;
  /// or none.
  std::vector<std::string> labels = {};

  /// Label of an LED, or its number.
  std::string labelOf(std::size_t led) const;

  /// @throws Error naming what is wrong: its name, too few or too many LEDs, two closer than
  /// 1 mm, all on one line, positions that are not finite, labels that are not one for each and all
  /// different, or a symmetric shape without labels.
  void check() const;
};

/// How a body resembles itself when it is turned.
struct Symmetry {
  /// LED i then lies nearly where LED permutation[i] was.
  std::vector<std::size_t> permutation;

  /// Root mean square distance that is left over [m]; infinity when there is no other permutation.
  double residual = std::numeric_limits<double>::infinity();
};

/// The turned position in which a body resembles itself most, with at least two LEDs exchanged.
/// Small residuals make orientations hard to tell apart; zero makes it impossible.
Symmetry nearestSymmetry(const Constellation& constellation);

/// Below this residual two orientations cannot be told apart; below the other one only when the
/// view is good [m]. Points are known to some millimetres.
constexpr double kSymmetric = 0.004;
constexpr double kNearlySymmetric = 0.015;

/// The sentence about a symmetry: which LEDs would be confused, and what to do.
std::string describe(const Constellation& constellation, const Symmetry& symmetry);

}  // namespace wiimote_tracker::body

#endif  // WIIMOTE_TRACKER_TRIANGULATION_BODY_CONSTELLATION_H
