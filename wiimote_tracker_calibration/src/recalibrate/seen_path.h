#pragma once

#include "capture/image.h"
#include "capture/moving_spots.h"
#include "capture/views.h"

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <Eigen/Core>

#include <cstddef>
#include <string>
#include <vector>

namespace wiimote_tracker::recalibrate {

/// State of the LED at some time.
struct PathPoint {
  Eigen::Vector3d position;          ///< [m]
  Eigen::Vector3d velocity;          ///< [m/s]
  Eigen::Matrix3d unit_covariance;   ///< Of the position, for pixel errors of 1 px [m^2].
  std::vector<std::size_t> cameras;  ///< That saw it, as the rig counts them.
};

/// The LED's trajectory as all cameras but one see it, triangulated from their spots, which are
/// interpolated linearly between two images. Interpolation averages the errors of two images, but
/// neighbouring points share images; the covariance is therefore that of single images.
class SeenPath {
 public:
  /// Uses images with exactly one spot, not counting lamps.
  SeenPath(const geometry::Rig& rig,
           const std::vector<capture::Image>& images,
           const std::string& without);

  /// Whether the position is known, or why not.
  enum class Sight { kSeen, kNotSeen, kUndetermined, kContradictory };

  /// kNotSeen: fewer than two cameras see the LED at this time. kUndetermined: they see it nearly
  /// from opposite sides. kContradictory: their rays do not meet.
  Sight at(double time, PathPoint* point) const;

  /// Cameras that saw the LED at all.
  const std::vector<std::size_t>& cameras() const { return seeing_; }

  /// Whether a camera's time offset is known for these images.
  bool clockKnown(std::size_t camera) const { return tracks_[camera].clock_known; }

 private:
  struct Track {
    bool clock_known = false;
    std::vector<capture::Spot> spots;  // By the time of the exposure.
  };

  Sight positionAt(double time, PathPoint* point) const;

  std::vector<geometry::Camera> rays_;
  std::vector<Track> tracks_;
  std::vector<std::size_t> seeing_;
};

}  // namespace wiimote_tracker::recalibrate
