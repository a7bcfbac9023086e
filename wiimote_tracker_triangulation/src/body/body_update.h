#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_BODY_BODY_UPDATE_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_BODY_BODY_UPDATE_H

#include "association/assign_spots.h"
#include "body/body_state.h"
#include "tracking/track.h"
#include "wiimote_tracker_triangulation/body/pose_state.h"
#include "wiimote_tracker_triangulation/geometry/sight.h"
#include "wiimote_tracker_triangulation/tracking/camera_image.h"

#include <Eigen/Core>
#include <boost/container/static_vector.hpp>

#include <array>
#include <cstddef>
#include <optional>
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

  /// How the image fits the bodies that other cameras see; each counts as one LED, since a wrong
  /// pose moves all of its LEDs.
  const tracking::LedFit& fit() const { return fit_; }

 private:
  /// An LED that the image may show.
  struct Candidate : SpotLed {
    std::optional<LedPrediction> prediction;  // unless it is too uncertain
  };

  void assign(const BodyImage& image);
  void leaveToSearch(double time);
  void measureFit(const BodyImage& image);
  bool isInView(const Candidate& led, std::size_t camera) const;
  bool hasSpot(const SpotLed& led) const;
  tracking::CameraList othersSeeing(const SpotLed& led, const BodyImage& image) const;
  bool isExplained(const Candidate& led,
                   const tracking::CameraList& others,
                   const BodyImage& image) const;
  bool take(std::size_t spot, const BodyImage& image);
  std::array<bool, kMaximumLeds> ledsWithSpot(std::size_t body) const;
  bool hasMerged(const LedGroups& groups,
                 const BodyImage& image,
                 std::size_t spot,
                 const std::array<bool, kMaximumLeds>& has_spot) const;
  void update(std::size_t body,
              const LedGroup& group,
              const Eigen::Vector2d& pixel,
              const BodyImage& image);
  bool isSeen(std::size_t body, const LastImage& image);
  LedGroups groupsOf(std::size_t body, const BodyImage& image, double spots) const;
  geometry::PixelNoise noiseOf(const BodyImage& image, double spots) const;

  const BodySetup& setup_;
  BodyState& state_;
  boost::container::static_vector<Candidate, association::kMaximumTracks> candidates_;
  std::vector<std::optional<SpotLed>> led_of_spot_;  // nothing: free
  std::vector<bool> taken_;
  tracking::LedFit fit_;
  std::vector<geometry::Sight> sights_;  // of isSeen(), reused
};

}  // namespace wiimote_tracker::body

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_BODY_BODY_UPDATE_H
