#ifndef WIIMOTE_TRACKER_CALIBRATION_SQUARE_SQUARE_TERMS_H
#define WIIMOTE_TRACKER_CALIBRATION_SQUARE_SQUARE_TERMS_H

#include "adjust/camera_blocks.h"
#include "adjust/corner.h"
#include "adjust/pixel.h"
#include "adjust/prior.h"
#include "wiimote_tracker_calibration/square/sightings.h"
#include "wiimote_tracker_calibration/square/square_layout.h"
#include "wiimote_tracker_calibration/square/square_model.h"

#include <ceres/problem.h>

#include <array>
#include <cstddef>
#include <vector>

namespace wiimote_tracker::square {

/// Where the LED was; must outlive the problem.
struct SquareBlocks {
  std::array<Eigen::Vector2d, 4>* corners;   ///< Displacements from the layout [m].
  std::vector<Eigen::Vector3d> places = {};  ///< Known places [m].
};

/// Adds a square to a problem: where cameras saw its corners and known places, how exactly the LED
/// lay there, and the taped lengths. @param cameras in the order of the sightings. @returns all
/// residuals.
inline std::vector<ceres::ResidualBlockId> addSquare(const SquareLayout& layout,
                                                     const Corners& nominal,
                                                     const std::vector<CameraSightings>& sightings,
                                                     const Uncertainty& stated,
                                                     std::vector<adjust::CameraBlocks>* cameras,
                                                     SquareBlocks* blocks,
                                                     ceres::Problem* problem) {
  std::vector<ceres::ResidualBlockId> residuals;
  const auto pixelError = [&](std::size_t camera, const Eigen::Vector2d& pixel) {
    return adjust::PixelError((*cameras)[camera], pixel, stated.pixel);
  };
  for (std::size_t c = 0; c < nominal.size(); ++c) {
    double* const corner = (*blocks->corners)[c].data();
    residuals.push_back(problem->AddResidualBlock(
        adjust::priorOf(Eigen::Vector2d::Zero(), Eigen::Vector2d::Constant(stated.placementOf(c))),
        nullptr, corner));
    for (std::size_t i = 0; i < sightings.size(); ++i) {
      if (const auto& seen = sightings[i].corners[c])
        residuals.push_back((*cameras)[i].addTo(
            problem, adjust::CornerPixelError{pixelError(i, *seen), nominal[c]}.cost(), nullptr,
            corner));
    }
  }
  blocks->places.resize(layout.places.size());
  for (std::size_t p = 0; p < layout.places.size(); ++p) {
    const KnownPlace& known = layout.places[p];
    Eigen::Vector3d& place = blocks->places[p] = known.position;
    residuals.push_back(problem->AddResidualBlock(
        adjust::priorOf(known.position, Eigen::Vector3d::Constant(known.stddev)), nullptr,
        place.data()));
    for (std::size_t i = 0; i < sightings.size(); ++i) {
      if (p < sightings[i].places.size() && sightings[i].places[p])
        residuals.push_back((*cameras)[i].addTo(
            problem, pixelError(i, *sightings[i].places[p]).cost(), nullptr, place.data()));
    }
  }
  for (const TapedLength& taped : layout.lengths)
    residuals.push_back(problem->AddResidualBlock(
        adjust::TapedLengthError{(nominal[taped.to] - nominal[taped.from]).head<2>(), taped.length,
                                 taped.stddev}
            .cost(),
        nullptr, (*blocks->corners)[taped.from].data(), (*blocks->corners)[taped.to].data()));
  return residuals;
}

}  // namespace wiimote_tracker::square

#endif  // WIIMOTE_TRACKER_CALIBRATION_SQUARE_SQUARE_TERMS_H
