// Errors of positions in the whole cube after a calibration, and the errors that it predicts.
#include "calibrations.h"
#include "program.h"

#include "wiimote_tracker_triangulation/geometry/calibration_uncertainty.h"

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

namespace wiimote_tracker::monte_carlo {
namespace {

/// The covariance of a measured position, from the calibration and the pixels' noise [m^2].
Eigen::Matrix3d predicted(const PaperSession& session,
                          const geometry::Rig& rig,
                          const geometry::CalibrationUncertainty& calibration,
                          const StillLed& led,
                          const geometry::TriangulatedPoint& point) {
  std::vector<std::size_t> cameras;  // of the rig, which may lack some
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    for (std::size_t j = 0; j < led.pixels.size(); ++j) {
      if (led.pixels[j] && session.wave.cameras[j].name == rig.cameras[i].camera.name)
        cameras.push_back(i);
    }
  }
  const auto systematic = calibration.covarianceOf(point.position, cameras.data(), cameras.size());
  return systematic ? Eigen::Matrix3d(*systematic + point.covariance)
                    : Eigen::Matrix3d::Constant(std::nan(""));
}

void measurePlaces(const PaperSession& session,
                   const geometry::Rig& rig,
                   double pixel_stddev,
                   int number,
                   const std::string& method,
                   Table* table) {
  const geometry::CalibrationUncertainty calibration(rig);
  geometry::TriangulationOptions options;
  options.pixel_stddev = pixel_stddev;
  for (const StillLed& led : session.known_places) {
    const auto point = measure(session, rig, led, options);
    if (!point)
      continue;
    const Eigen::Vector3d error = point->position - led.truth;
    const Eigen::Matrix3d covariance = predicted(session, rig, calibration, led, *point);
    *table << number << method << led.nominal.x() << led.nominal.y() << led.nominal.z()
           << 1e3 * error.norm() << 1e3 * std::sqrt(covariance.trace())
           << error.dot(covariance.inverse() * error) / 3.0;
  }
}

void measureMap(const simulation::Description& description, const Session& session, Table* table) {
  std::vector<std::size_t> cameras;
  for (std::size_t i = 0; i < description.cameras.size(); ++i)
    cameras.push_back(i);
  const double pixel_stddev = stillPixelStddev(description);
  const PaperSession drawn = drawPaperSession(description, cameras, session.seed);
  measurePlaces(drawn, solveJointSquare(drawn), pixel_stddev, session.number, "square", table);
  measurePlaces(drawn, solveWaved(drawn.wave), pixel_stddev, session.number, "wave", table);
}

}  // namespace
}  // namespace wiimote_tracker::monte_carlo

int main(int argc, char** argv) {
  return wiimote_tracker::monte_carlo::runProgram(
      argc, argv,
      "Errors at 27 positions in the whole cube after "
      "a calibration by the square, and by square and waved LED, and the predicted errors.",
      {"session", "method", "x_m", "y_m", "z_m", "error_mm", "predicted_mm",
       "normalised_squared_error"},
      wiimote_tracker::monte_carlo::measureMap);
}
