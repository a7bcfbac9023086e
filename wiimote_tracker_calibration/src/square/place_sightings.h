#ifndef WIIMOTE_TRACKER_CALIBRATION_SQUARE_PLACE_SIGHTINGS_H
#define WIIMOTE_TRACKER_CALIBRATION_SQUARE_PLACE_SIGHTINGS_H

#include "adjust/camera_blocks.h"
#include "adjust/pixel.h"
#include "adjust/prior.h"
#include "wiimote_tracker_calibration/square/sightings.h"
#include "wiimote_tracker_calibration/square/square_layout.h"

#include <ceres/problem.h>

#include <array>
#include <cstddef>
#include <vector>

namespace wiimote_tracker::square {

/// Blocks of the known places: where the LED was [m].
using PlaceBlocks = std::vector<std::array<double, 3>>;

/// How often cameras saw a known place.
inline int placeSightings(const std::vector<CameraSightings>& sightings) {
  int count = 0;
  for (const CameraSightings& camera : sightings) {
    for (const auto& pixel : camera.places)
      count += pixel ? 1 : 0;
  }
  return count;
}

/// Adds the known places, and where cameras saw them, to a problem.
/// @param pixel_stddev [px]. @param cameras in the order of the sightings. @param places filled;
/// must outlive the problem. @returns the residuals.
inline std::vector<ceres::ResidualBlockId> addPlaces(const SquareLayout& layout,
                                                     const std::vector<CameraSightings>& sightings,
                                                     double pixel_stddev,
                                                     std::vector<adjust::CameraBlocks>* cameras,
                                                     PlaceBlocks* places,
                                                     ceres::Problem* problem) {
  std::vector<ceres::ResidualBlockId> residuals;
  places->resize(layout.places.size());
  for (std::size_t p = 0; p < places->size(); ++p) {
    const KnownPlace& known = layout.places[p];
    std::array<double, 3>& block = (*places)[p];
    block = {known.position.x(), known.position.y(), known.position.z()};
    residuals.push_back(problem->AddResidualBlock(
        adjust::Prior<3>{block, {known.stddev, known.stddev, known.stddev}}.cost(), nullptr,
        block.data()));
    for (std::size_t i = 0; i < sightings.size(); ++i) {
      if (p >= sightings[i].places.size() || !sightings[i].places[p])
        continue;
      adjust::CameraBlocks& camera = (*cameras)[i];
      const adjust::PixelError error{
          *sightings[i].places[p], Eigen::Matrix2d::Identity() / pixel_stddev,
          camera.world_from_start, sightings[i].intrinsics.distortion_model};
      residuals.push_back(problem->AddResidualBlock(error.cost(), nullptr, camera.rotation.data(),
                                                    camera.position.data(), camera.lens.data(),
                                                    camera.distortion.data(), block.data()));
    }
  }
  return residuals;
}

}  // namespace wiimote_tracker::square

#endif  // WIIMOTE_TRACKER_CALIBRATION_SQUARE_PLACE_SIGHTINGS_H
