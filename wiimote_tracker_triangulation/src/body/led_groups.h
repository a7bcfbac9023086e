#pragma once

#include "body/constellation.h"
#include "wiimote_tracker_triangulation/body/pose_state.h"
#include "wiimote_tracker_triangulation/geometry/camera.h"

#include <Eigen/Core>
#include <boost/container/static_vector.hpp>

#include <array>
#include <cstddef>
#include <optional>

namespace wiimote_tracker::body {

/// One LED, or several neighbouring LEDs of one body, that may cause one spot of an image.
struct LedGroup {
  using Leds = boost::container::static_vector<std::size_t, kMaximumLeds>;

  Leds leds;
  LedPrediction prediction;  // of the mean of their pixels; noisier for several LEDs

  /// Squared Mahalanobis distance of a spot.
  double misfit(const Eigen::Vector2d& pixel) const;

  /// -2 log likelihood of a spot without its constant, plus a penalty for each further LED, since
  /// merged spots are rarer; infinity where its misfit is beyond the gate.
  double cost(const Eigen::Vector2d& pixel, double gate) const;
};

/// All groups of a body's LEDs in one image, without LEDs whose prediction is too uncertain.
class LedGroups {
 public:
  /// @param merging_distance LEDs closer than this may merge into one spot [px].
  LedGroups(const PoseState& state,
            const Constellation& constellation,
            const geometry::Camera& camera,
            const geometry::PixelNoise& noise,
            double merging_distance,
            double gate);

  /// The prediction of one LED, unless it is too uncertain.
  const std::optional<LedPrediction>& single(std::size_t led) const { return singles_[led]; }

  /// Least cost of a pixel over the groups with this LED; infinity where none fits.
  double cost(std::size_t led, const Eigen::Vector2d& pixel) const;

  /// The group of least cost, without groups that contain other LEDs with a spot of their own. Null
  /// where none fits.
  const LedGroup* best(std::size_t led,
                       const Eigen::Vector2d& pixel,
                       const std::array<bool, kMaximumLeds>& has_spot) const;

 private:
  void add(const PoseState& state, const LedGroup::Leds& leds);

  double gate_;
  std::array<std::optional<LedPrediction>, kMaximumLeds> singles_;
  // One of each LED, one of each pair, one of each LED with all of its neighbours.
  boost::container::static_vector<LedGroup, kMaximumLeds*(kMaximumLeds + 3) / 2> groups_;
};

}  // namespace wiimote_tracker::body
