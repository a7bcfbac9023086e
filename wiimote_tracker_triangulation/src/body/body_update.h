#pragma once

#include "body/body_fit.h"
#include "body/body_setup.h"
#include "body/body_state.h"
#include "wiimote_tracker_triangulation/geometry/sight.h"
#include "wiimote_tracker_triangulation/tracking/camera_image.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <vector>

namespace wiimote_tracker::body {

struct LedGroup;
class LedGroups;

/// A spot that a search gives to an LED of a body.
struct MatchedSpot {
  std::size_t led;
  std::size_t camera;
  Eigen::Vector2d pixel;
};

/// Updates known bodies with the spots of an image.
class BodyUpdate {
 public:
  /// @param setup, state not owned.
  BodyUpdate(const BodySetup& setup, BodyState* state) : setup_(setup), state_(*state) {}

  /// Predicts the bodies to the time of the image, and updates each with its spots, unless the
  /// image is doubtful.
  void follow(const BodyImage& image);

  /// A search after follow() finds a body where it is predicted: updates it with spots of this
  /// image that it did not take because the prediction is too uncertain to tell its LEDs apart.
  /// @returns whether it is seen.
  bool followMatch(std::size_t body, const std::vector<MatchedSpot>& spots, const BodyImage& image);

  /// For each spot of the image: whether a body took it.
  const std::vector<bool>& taken() const { return taken_; }

  /// See fitOf().
  const tracking::LedFit& fit() const { return fit_; }

 private:
  void assign(const BodyImage& image);
  void leaveToSearch(double time);
  bool take(std::size_t spot, const BodyImage& image);
  bool hasMerged(const LedGroups& groups,
                 const BodyImage& image,
                 std::size_t spot,
                 const std::array<bool, kMaximumLeds>& has_spot) const;
  void update(std::size_t body,
              const LedGroup& group,
              const Eigen::Vector2d& pixel,
              const BodyImage& image);
  LedGroups groupsOf(std::size_t body, const BodyImage& image, double spots) const;
  geometry::PixelNoise noiseOf(const BodyImage& image, double spots) const;

  const BodySetup& setup_;
  BodyState& state_;
  LedAssignment assignment_;
  std::vector<bool> taken_;
  tracking::LedFit fit_;
  std::vector<geometry::Sight> sights_;  // of isSeen()
};

}  // namespace wiimote_tracker::body
