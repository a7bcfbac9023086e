#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker::body {

constexpr std::size_t kMaximumLeds = 8;  ///< Of one body.

/// An IMU on a body.
struct ImuMount {
  std::string topic;  ///< sensor_msgs/Imu
  Eigen::Isometry3d body_from_imu = Eigen::Isometry3d::Identity();
  double clock_offset = 0.0;  ///< Added to its stamps gives the clock of the images [s].
};

/// The LEDs of a rigid body.
struct Constellation {
  /// Also its TF frame: a letter, then letters, digits, _; not led_ with a number, the name of an
  /// LED without a label.
  std::string name;

  std::vector<Eigen::Vector3d> leds;  ///< In the body's frame [m]; 3 to kMaximumLeds.

  /// One per LED, if they blink, or empty. They identify the LEDs of a symmetric shape.
  std::vector<std::string> labels = {};

  std::optional<ImuMount> imu = {};

  /// Label of an LED, or its number.
  std::string labelOf(std::size_t led) const;

  /// @throws Error naming what is wrong: the name, the number of LEDs, two LEDs closer than 1 mm or
  /// farther than 3 m apart, all LEDs on one line, positions that are not finite, labels that are
  /// not one per LED and distinct, or a symmetric shape without labels.
  void check() const;
};

/// Whether all values are the same.
bool operator==(const ImuMount& a, const ImuMount& b);
bool operator==(const Constellation& a, const Constellation& b);

/// From one LED to the nearest other one [m].
double distanceToNearest(const std::vector<Eigen::Vector3d>& leds, std::size_t led);

/// Nearest match of a body with itself after a rotation.
struct Symmetry {
  /// LED i moves near the former position of LED permutation[i].
  std::vector<std::size_t> permutation;

  /// RMS distance that remains [m]; infinity when there is no other permutation.
  double residual = std::numeric_limits<double>::infinity();
};

/// The rotation that maps a body onto itself best, with at least two LEDs exchanged. A small
/// residual makes orientations hard to distinguish, zero impossible.
Symmetry nearestSymmetry(const Constellation& constellation);

/// Residuals [m] below which two orientations are indistinguishable, or distinguishable in good
/// views only. Positions of LEDs have errors of some millimetres.
constexpr double kSymmetric = 0.004;
constexpr double kNearlySymmetric = 0.015;

/// A sentence for the user: which LEDs would be confused, and what to do.
std::string describe(const Constellation& constellation, const Symmetry& symmetry);

/// A sentence for the user about two bodies whose shapes are equal within kNearlySymmetric, or
/// nothing. A mirrored shape is a different one. Labels tell only symmetric bodies apart, since all
/// others are found by shape.
std::optional<std::string> describeTwins(const Constellation& a, const Constellation& b);

/// Distance of two LEDs [m] below which their spots often merge, some metres from the camera.
constexpr double kMerging = 0.03;

/// A sentence for the user about the two LEDs that are nearest to each other, or nothing if they
/// are kMerging apart.
std::optional<std::string> describeMergingLeds(const Constellation& constellation);

}  // namespace wiimote_tracker::body
