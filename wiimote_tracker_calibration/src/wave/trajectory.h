#pragma once

#include "adjust/cubic_spline.h"

#include <Eigen/Core>

#include <cmath>
#include <optional>

namespace wiimote_tracker::wave {

/// Paths of one or more LEDs: uniform cubic B-splines on common knots. Between two knots a path is
/// a weighted mean of four neighbouring control points.
class Trajectory {
 public:
  /// The four control points that shape the path at one time, and their weights.
  struct Place {
    Eigen::Vector4d value;  ///< Of the position.
    Eigen::Vector4d rate;   ///< Of the velocity [1/s].
    Eigen::Index first;     ///< Of the four, also the number of the knot interval.
  };

  Trajectory() = default;

  /// Defined from start to end or a little longer [s]; everything at the origin.
  Trajectory(double start, double end, double spacing, Eigen::Index leds)
      : start_(start), spacing_(spacing), leds_(leds) {
    const auto intervals = static_cast<Eigen::Index>(std::ceil((end - start) / spacing)) + 1;
    controls_ = Eigen::MatrixXd::Zero(3 * leds, intervals + 3);
  }

  Eigen::Index leds() const { return leds_; }
  double spacing() const { return spacing_; }
  Eigen::Index intervals() const { return controls_.cols() - 3; }
  /// Begin of a knot interval [s].
  double timeOf(Eigen::Index interval) const {
    return start_ + spacing_ * static_cast<double>(interval);
  }

  /// One column per control point, LED below LED [m].
  Eigen::MatrixXd& controls() { return controls_; }
  double* control(Eigen::Index index, Eigen::Index led) { return &controls_(3 * led, index); }
  const Eigen::MatrixXd& controls() const { return controls_; }

  /// A time in a knot interval, whose polynomial is extrapolated beyond its two knots.
  Place in(Eigen::Index interval, double time) const {
    const double u = (time - timeOf(interval)) / spacing_;
    return {adjust::splineWeights(u), adjust::splineRates(u) / spacing_, interval};
  }

  /// Nothing outside the times it is defined for.
  std::optional<Place> at(double time) const {
    const double knots = (time - start_) / spacing_;
    if (!(knots >= 0.0) || !(knots < static_cast<double>(intervals())))
      return std::nullopt;
    return in(static_cast<Eigen::Index>(knots), time);
  }

  Eigen::Vector3d position(const Place& place, Eigen::Index led) const {
    return controls_.block<3, 4>(3 * led, place.first) * place.value;
  }

  /// [m/s]
  Eigen::Vector3d velocity(const Place& place, Eigen::Index led) const {
    return controls_.block<3, 4>(3 * led, place.first) * place.rate;
  }

 private:
  double start_ = 0.0;
  double spacing_ = 1.0;
  Eigen::Index leds_ = 1;
  Eigen::MatrixXd controls_;
};

}  // namespace wiimote_tracker::wave
