#pragma once

#include "association/assign_spots.h"

#include <Eigen/Core>

#include <algorithm>
#include <limits>
#include <vector>

// A crowd: more lights than the cameras of a group can report. An LED that they do not report has
// no track, but it may be merged with one that has: the spot is then between both, at most half of
// merging_distance from either. Residuals do not always show that, nor does a third camera, which
// may face another LED.

namespace wiimote_tracker::tracking {

class TrackerCamera;
struct GroupSetup;
struct GroupState;
struct StoredImage;
struct TrackedLed;

/// What a camera's newest image tells of a crowd.
struct NewestImage {
  double time = -std::numeric_limits<double>::infinity();  // [s]
  bool full = false;                                       // StoredImage::full
  bool has_unknown = false;                                // it shows a light of no confirmed LED
};

/// Since when there has been a crowd about one track's LED.
class CrowdMemory {
 public:
  /// An image shows a crowd. False detections can look like one, but for a few images only.
  void note(double time) {
    constexpr double kLongestGap = 0.05;  // [s]
    if (time - last_ > kLongestGap)
      since_ = time;
    last_ = time;
  }

  /// Whether there is one, or lately was: the filter forgets merged spots with some delay.
  bool isCrowded(double time) const {
    constexpr double kMemory = 0.2;  // [s]
    return time - last_ <= std::min(last_ - since_, kMemory);
  }

 private:
  double since_ = 0.0;                                      // [s]
  double last_ = -std::numeric_limits<double>::infinity();  // [s]
};

/// Notes in the confirmed tracks what an image tells of crowds about their LEDs.
/// @returns whether there is a crowd about some LED.
bool noteCrowds(const StoredImage& image,
                const association::TrackOfSpot& track_of_spot,
                const GroupSetup& setup,
                GroupState* state);

/// Covariance of a crowded LED's position [m^2]: unknown LEDs may be merged with it.
/// @param merging_distance see ImageOptions [px]
Eigen::Matrix3d mergingCovariance(const TrackedLed& led,
                                  const std::vector<TrackerCamera>& cameras,
                                  double merging_distance);

}  // namespace wiimote_tracker::tracking
