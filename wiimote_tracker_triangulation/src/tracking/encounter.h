#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_ENCOUNTER_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_ENCOUNTER_H

#include "wiimote_tracker_triangulation/association/assign_spots.h"
#include "wiimote_tracker_triangulation/geometry/camera.h"
#include "wiimote_tracker_triangulation/motion/motion_filter.h"
#include "wiimote_tracker_triangulation/motion/motion_steps.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace wiimote_tracker::tracking {

/// Two LEDs whose light fell into one spot, until it is known which is which.
///
/// While they are one spot, nothing is learned of how they lie to each other. So both motions are
/// kept as they were before, and when there are two spots again, both go on from there. Whose spot
/// is whose is open then, in each view anew: which spots of two views are of one LED, its motion
/// alone tells. So all ways to give out the spots are followed side by side, but for those that are
/// far less likely than the likeliest.
class Encounter {
 public:
  using Filters = std::array<motion::MotionFilter, 2>;

  /// An image, as far as it may show the two.
  struct View {
    const geometry::Camera* camera;
    motion::PixelNoise noise;
    double time;  // [s]
    std::size_t spot_count = 0;
    std::array<Eigen::Vector2d, association::kMaximumSpots> pixels;
  };
  using Places = std::array<std::size_t, 2>;  // of each one's spot, in a View

  /// @param before their motions, before they met.
  Encounter(std::uint32_t a, std::uint32_t b, const Filters& before);

  const std::array<std::uint32_t, 2>& ids() const { return ids_; }
  double openedAt() const { return opened_at_; }  // [s]

  /// Takes in a spot of each: which, in the likeliest way. Nothing, and nothing is taken in, where
  /// no way expects two of the spots to be theirs. Views must come in the order of their times.
  /// @param gate squared Mahalanobis distance [1] @param steps of the filters' options
  std::optional<Places> take(const View& view, double gate, motion::MotionSteps* steps);

  /// Their motions in the likeliest way, at the last view that was taken in.
  const Filters& likeliest() const { return ways_[0]->filters; }

  /// Whether some view had a spot of each just before a time [s].
  bool areApart(double time) const;

  /// Whether the likeliest way stands at a time [s]. @param doubt_time see TrackerOptions [s]
  bool isDecided(double time, double doubt_time) const;

 private:
  /// One way to give out the spots so far.
  struct Way {
    Filters filters;
    double log_likelihood;  // less that of the likeliest
  };

  /// What a way expects of a view.
  struct Outlook {
    std::array<std::optional<motion::PixelPrediction>, 2> predictions;  // of each
    std::array<std::array<double, association::kMaximumSpots>, 2> fit;  // log likelihoods
    std::array<std::array<bool, association::kMaximumSpots>, 2> within_gate;
  };
  static constexpr std::size_t kMaximumWays = 4;
  using Outlooks = std::array<Outlook, kMaximumWays>;

  Outlook lookOut(Way* way, const View& view, double gate, motion::MotionSteps* steps) const;
  std::optional<Places> likeliestPlaces(const Outlooks& outlooks, std::size_t spot_count) const;
  Places branch(const Outlooks& outlooks, const View& view, const Places& places);

  std::array<std::uint32_t, 2> ids_;
  double opened_at_;   // [s]
  double last_apart_;  // before they part: opened_at_ [s]
  bool has_parted_ = false;
  double parted_at_ = 0.0;  // last [s]
  std::size_t way_count_ = 1;
  std::array<std::optional<Way>, kMaximumWays> ways_;  // the likeliest first
};

}  // namespace wiimote_tracker::tracking

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_ENCOUNTER_H
