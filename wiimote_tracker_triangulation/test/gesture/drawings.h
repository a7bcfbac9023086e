#pragma once

#include "gesture/recognizer.h"
#include "wiimote_tracker_triangulation/gesture/shape.h"

#include <Eigen/Geometry>

#include <cmath>
#include <functional>

/// Gestures drawn with an LED.
namespace wiimote_tracker::gesture::test {

using Curve = std::function<Eigen::Vector3d(double)>;  // of a share of the way [0..1]

inline Eigen::Vector3d circle(double s) {
  return {0.2 * std::cos(2 * M_PI * s), 0.0, 0.2 * std::sin(2 * M_PI * s)};
}

inline Eigen::Vector3d zigzag(double s) {
  const double t = 4.0 * s;
  const double up = std::fmod(t, 2.0) < 1.0 ? std::fmod(t, 1.0) : 1.0 - std::fmod(t, 1.0);
  return {0.1 * t, 0.02 * t, 0.3 * up};
}

inline Eigen::Vector3d hook(double s) {
  return s < 0.7 ? Eigen::Vector3d(0.0, 0.4 * s, 0.0)
                 : Eigen::Vector3d(0.4 * (s - 0.7), 0.28, 0.3 * (s - 0.7));
}

struct Drawing {
  double start = 0.0;
  double duration = 1.5;
  double rate = 100.0;
  double scale = 1.0;
  double heading = 0.0;                             // about z [rad]
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  // [m]
  std::function<double(double)> pace = [](double s) { return s; };
};

inline Path draw(const Curve& curve, const Drawing& drawing) {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(drawing.heading, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const int steps = static_cast<int>(std::lround(drawing.duration * drawing.rate));
  Path path;
  for (int i = 0; i <= steps; ++i) {
    const double s = static_cast<double>(i) / steps;
    path.push_back({drawing.start + s * drawing.duration,
                    drawing.place + drawing.scale * (turn * curve(drawing.pace(s)))});
  }
  return path;
}

inline Recognizer threeGestures(const RecognizerOptions& options = {}) {
  Recognizer recognizer(options);
  recognizer.add({"circle", "", draw(circle, {})});
  recognizer.add({"zigzag", "", draw(zigzag, {})});
  recognizer.add({"hook", "", draw(hook, {})});
  return recognizer;
}

}  // namespace wiimote_tracker::gesture::test
