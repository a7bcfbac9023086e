#pragma once

#include "association/assign_spots.h"
#include "group_state.h"
#include "motion/pixel_prediction.h"

#include <Eigen/Core>
#include <boost/container/static_vector.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace wiimote_tracker::tracking {

/// A track that an image may show.
struct Candidate {
  Track* track;
  motion::PixelPrediction prediction;
  CameraList others;  // that saw its LED lately
  bool in_view;
  bool expected;                    // without a spot, it is a missed detection
  std::optional<std::size_t> spot;  // that it takes
  bool updated;                     // by its MergedPair

  const Eigen::Vector2d& pixel() const { return prediction.pixel(); }  // predicted [px]
};

/// An image, and which track takes which of its spots. Never allocates.
struct ImageAssignment {
  const geometry::Rig& rig;
  const TrackerCamera& camera;
  const StoredImage& image;
  const TrackerOptions& options;
  geometry::PixelNoise noise;
  boost::container::static_vector<Candidate, association::kMaximumTracks> candidates;

  /// Whether no track takes the spot.
  bool isUnassigned(std::size_t spot) const;

  /// The unassigned spot that is nearest to a pixel, and nearer than this distance [px].
  std::optional<std::size_t> nearestUnassigned(const Eigen::Vector2d& pixel, double distance) const;

  Candidate* find(std::uint32_t id);
};

/// Predicts each track to the image's time and into the image, and assigns the spots to the tracks
/// by maximum likelihood. A track takes only a spot in its gate.
ImageAssignment assignImage(const GroupSetup& setup,
                            const StoredImage& image,
                            std::vector<Track>* tracks);

}  // namespace wiimote_tracker::tracking
