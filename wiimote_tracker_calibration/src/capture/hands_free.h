#pragma once

#include "capture/corner_capture.h"
#include "capture/image.h"

#include <Eigen/Core>

#include <map>
#include <string>
#include <vector>

namespace wiimote_tracker::capture {

struct HandsFreeOptions {
  double hold = 2.0;        ///< Time for which the LED must be still [s].
  double distance = 30.0;   ///< From a corner that was captured, in one image at least [px].
  int minimum_cameras = 2;  ///< That see it still.
};

/// Detects that the LED has been put down at a new place: it is still when the only spot of each
/// camera that sees it stays where it is.
class HandsFree {
 public:
  HandsFree(const std::vector<std::string>& cameras, const HandsFreeOptions& options);

  /// One image; images in the order of their stamps. After a jump back it starts anew.
  /// @returns whether the LED has been still for long enough, at none of the captured corners.
  bool add(const Image& image, const std::vector<CapturedCorner>& captured);

  /// Forgets the images: the LED must be still from the next one on.
  void restart();

 private:
  struct Camera {
    bool seen = false;                                // exactly one spot, lately
    double latest = 0.0;                              // stamp of the latest such image [s]
    double since = 0.0;                               // stays within kStill of `pixel` [s]
    Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  // where it came to rest [px]
  };

  bool isNew(const CapturedCorner& corner) const;

  HandsFreeOptions options_;
  std::map<std::string, Camera> cameras_;
};

}  // namespace wiimote_tracker::capture
