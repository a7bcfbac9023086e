#pragma once

#include <array>
#include <cstddef>

namespace wiimote_tracker::association {

constexpr std::size_t kMaximumSpots = 16;   ///< In one image.
constexpr std::size_t kMaximumTracks = 32;  ///< In one image.

/// Costs of an assignment of the spots of one image to tracks, such as negative log likelihoods. Of
/// any sign and finite, but +infinity in `pair` for a pair outside the gate.
struct SpotCosts {
  std::size_t spots = 0;                                               ///< At most kMaximumSpots.
  std::size_t tracks = 0;                                              ///< At most kMaximumTracks.
  std::array<std::array<double, kMaximumTracks>, kMaximumSpots> pair;  ///< [spot][track]
  std::array<double, kMaximumSpots> ghost;                             ///< False detection.
  std::array<double, kMaximumTracks> miss;                             ///< Missed detection.

  /// Forbids all pairs and sets the costs of all false and missed detections.
  void reset(std::size_t spot_count, std::size_t track_count, double ghost_cost, double miss_cost);
};

constexpr int kFalseDetection = -1;

/// For each spot of an image its track, or kFalseDetection.
using TrackOfSpot = std::array<int, kMaximumSpots>;

/// The assignment of least cost in which each spot has at most one track and each track at most one
/// spot: shortest augmenting paths (Jonker and Volgenant 1987), exact. Never allocates.
/// @returns undefined from SpotCosts::spots on.
TrackOfSpot assignSpots(const SpotCosts& costs);

}  // namespace wiimote_tracker::association
