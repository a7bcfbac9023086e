#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_ENCOUNTER_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_ENCOUNTER_H

#include "wiimote_tracker_triangulation/geometry/camera.h"
#include "wiimote_tracker_triangulation/motion/motion_filter.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>

namespace wiimote_tracker::tracking {

/// Two LEDs whose light fell into one spot, until it is known which is which.
///
/// While they are one spot, nothing is learned of how they lie to each other. So both motions are
/// kept as they were before, and when there are two spots again, both go on from there. Which spot
/// is whose is left open for a while: the other way to give them out is followed beside, and the
/// likelihoods of all spots since decide.
class Encounter {
 public:
  using Filters = std::array<motion::MotionFilter, 2>;
  using Pixels = std::array<Eigen::Vector2d, 2>;

  Encounter(std::uint32_t a, std::uint32_t b, const Filters& before)
      : ids_{a, b}, opened_at_(before[0].time()), other_way_(before) {}

  const std::array<std::uint32_t, 2>& ids() const { return ids_; }
  double openedAt() const { return opened_at_; }  // [s]
  bool hasParted() const { return has_parted_; }

  /// How they would go on from before they met, at a time [s]; before they have parted.
  motion::MotionFilter motionOf(std::size_t which, double time) const;

  /// An image with a spot of each. @param filters of the tracks, predicted to the image's time;
  /// their updates are made here.
  void take(const geometry::Camera& camera,
            const motion::PixelNoise& noise,
            const Pixels& pixels,
            const std::array<motion::MotionFilter*, 2>& filters);

  /// Whether it is over at a time [s]; then the tracks' filters are those of the likelier way.
  bool decide(double time, const std::array<motion::MotionFilter*, 2>& filters) const;

 private:
  std::array<std::uint32_t, 2> ids_;
  double opened_at_;
  Filters other_way_;  // until they part: before they met
  bool has_parted_ = false;
  double parted_at_ = 0.0;  // [s]
  double gain_ = 0.0;       // log likelihood of the other way less that of the tracks' own
};

}  // namespace wiimote_tracker::tracking

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_ENCOUNTER_H
