#pragma once

#include "adjust/camera_blocks.h"
#include "wiimote_tracker_calibration/square/sightings.h"
#include "wiimote_tracker_calibration/square/square_layout.h"
#include "wiimote_tracker_calibration/square/square_model.h"

#include <ceres/ceres.h>

#include <array>
#include <vector>

namespace wiimote_tracker::square {

/// What is known of cameras besides a wave, as residuals: the square, the accelerometers, and
/// priors.
class KnownTerms {
 public:
  /// @param stated, cameras, problem not owned.
  KnownTerms(const Uncertainty& stated,
             std::vector<adjust::CameraBlocks>* cameras,
             ceres::Problem* problem)
      : stated_(stated), cameras_(*cameras), problem_(*problem) {}

  /// @param blocks of the residual. @param cost owned by the problem.
  template <typename... Blocks>
  void add(ceres::CostFunction* cost, Blocks*... blocks) {
    residuals_.push_back(problem_.AddResidualBlock(cost, nullptr, blocks...));
  }

  /// Where cameras saw a place. @param place block (3) [m].
  void addPixel(std::size_t camera, const Eigen::Vector2d& pixel, double* place);

  /// Priors of the lenses, and of the offset that their principal points share. Holds the higher
  /// distortion.
  /// @param shared_offset block [px].
  void addLenses(const std::vector<CameraSightings>& sightings, Eigen::Vector2d* shared_offset);

  /// Not for a wave with a square, which tell tilts better than accelerometers do: these are only
  /// checked against them (wave/checks).
  /// @param up in the world.
  void addGravity(const std::vector<CameraSightings>& sightings, const Eigen::Vector3d& up);

  /// Where cameras saw the corners and the known places, how exactly the LED lay there, and the
  /// taped lengths.
  /// @param corners blocks: displacements from the layout [m].
  /// @param places blocks: the known places [m]; those that are missing start where they should be.
  void addSquare(const SquareLayout& layout,
                 bool z_up,
                 const std::vector<CameraSightings>& sightings,
                 std::array<Eigen::Vector2d, 4>* corners,
                 std::vector<Eigen::Vector3d>* places);

  /// Sum of the squared residuals at the present values of the problem.
  double chiSquared() const;

  /// Its expectation at a solution without loss functions.
  double degreesOfFreedom() const;

 private:
  const Uncertainty& stated_;
  std::vector<adjust::CameraBlocks>& cameras_;
  ceres::Problem& problem_;
  std::vector<ceres::ResidualBlockId> residuals_;
  int surplus_ = 0;  // residuals that measure nothing
};

}  // namespace wiimote_tracker::square
