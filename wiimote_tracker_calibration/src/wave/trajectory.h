#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_TRAJECTORY_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_TRAJECTORY_H

#include <Eigen/Core>

#include <cmath>
#include <optional>

namespace wiimote_tracker::wave {

/// Paths of one or more LEDs: uniform cubic B-splines on common knots. Between two knots a path is
/// a weighted mean of four neighbouring control points.
class Trajectory {
 public:
  /// The four control points that shape the path at one time.
  struct Place {
    Eigen::Index first;     ///< Of the four, also the number of the knot interval.
    Eigen::Vector4d value;  ///< Weights of the position; their sum is 1.
    Eigen::Vector4d rate;   ///< Weights of the velocity [1/s].
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
  const Eigen::MatrixXd& controls() const { return controls_; }

  /// Nothing outside the times it is defined for.
  std::optional<Place> at(double time) const {
    const double knots = (time - start_) / spacing_;
    if (!(knots >= 0.0) || !(knots < static_cast<double>(intervals())))
      return std::nullopt;
    Place place;
    place.first = static_cast<Eigen::Index>(knots);
    const double u = knots - static_cast<double>(place.first);
    const double v = 1.0 - u;
    place.value << v * v * v, 3.0 * u * u * u - 6.0 * u * u + 4.0,
        3.0 * v * v * v - 6.0 * v * v + 4.0, u * u * u;
    place.value /= 6.0;
    place.rate << -v * v, 3.0 * u * u - 4.0 * u, -3.0 * v * v + 4.0 * v, u * u;
    place.rate /= 2.0 * spacing_;
    return place;
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

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_TRAJECTORY_H
