#pragma once

#include "association/assign_spots.h"
#include "body/body_setup.h"
#include "body/body_state.h"
#include "wiimote_tracker_triangulation/body/pose_state.h"
#include "wiimote_tracker_triangulation/geometry/sight.h"
#include "wiimote_tracker_triangulation/tracking/camera_image.h"

#include <boost/container/static_vector.hpp>

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace wiimote_tracker::body {

/// An LED that an image may show.
struct LedCandidate : SpotLed {
  std::optional<LedPrediction> prediction;  ///< Unless it is too uncertain.
};

/// Which LEDs the spots of an image are assigned to.
struct LedAssignment {
  boost::container::static_vector<LedCandidate, association::kMaximumTracks> candidates;
  std::vector<std::optional<SpotLed>> led_of_spot;  ///< Nothing: free.

  /// Which LEDs of a body have a spot.
  std::array<bool, kMaximumLeds> ledsWithSpot(std::size_t body) const;
};

/// How an image fits the bodies that other cameras see; each counts as one LED, since a wrong pose
/// moves all of its LEDs. LEDs that a body hides, or that merge, leave no free spots: only as many
/// are missing as there are such.
/// @param state before the image updates the bodies.
tracking::LedFit fitOf(const BodyImage& image,
                       const LedAssignment& assignment,
                       const BodySetup& setup,
                       const BodyState& state);

/// Whether a camera's newest image shows a body. The newest images of all cameras must fit its
/// prediction: other lights have another shape. One spot alone could be any light, unless those
/// images show three of the body's LEDs, with rays that do not all meet in one light (moved with
/// the body to now). @param sights buffer, so that it does not allocate.
bool isSeen(std::size_t body,
            std::size_t camera,
            const BodySetup& setup,
            const BodyState& state,
            std::vector<geometry::Sight>* sights);

}  // namespace wiimote_tracker::body
