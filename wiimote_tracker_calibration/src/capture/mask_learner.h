#pragma once

#include "capture/image.h"

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace wiimote_tracker::capture {

struct MaskOptions {
  /// Least share of the images that show a light [0..1]; lamps may flicker.
  double share = 0.02;
  double margin = 8.0;  ///< Radius of a mask beyond the farthest position of its light [px].
};

/// What was learned of one camera.
struct LearnedMasks {
  std::vector<geometry::ImageMask> masks;
  std::string problem;  ///< Why it could not be learned, and what to do; empty when it was.
};

/// Learns the lights of the room while the LED is off. Lights are distinguished by position.
class MaskLearner {
 public:
  MaskLearner(const std::vector<std::string>& cameras, const MaskOptions& options);

  /// Present masks have no effect. Ignored for unknown cameras.
  void add(const Image& image);

  /// Of every camera.
  std::map<std::string, LearnedMasks> result() const;

 private:
  /// One light, and the range of its positions.
  struct Light {
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();  // [px]
    Eigen::Vector2d lower = Eigen::Vector2d::Zero();
    Eigen::Vector2d upper = Eigen::Vector2d::Zero();
    std::size_t images = 0;
  };
  struct Camera {
    std::size_t images = 0;
    std::vector<Light> lights;
  };

  static void addSpot(const Eigen::Vector2d& spot, Camera* camera);
  LearnedMasks learned(const Camera& camera) const;

  MaskOptions options_;
  std::map<std::string, Camera> cameras_;
};

}  // namespace wiimote_tracker::capture
