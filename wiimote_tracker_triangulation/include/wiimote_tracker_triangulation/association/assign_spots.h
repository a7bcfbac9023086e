#ifndef WIIMOTE_TRACKER_TRIANGULATION_ASSOCIATION_ASSIGN_SPOTS_H
#define WIIMOTE_TRACKER_TRIANGULATION_ASSOCIATION_ASSIGN_SPOTS_H

#include <array>
#include <cstddef>

namespace wiimote_tracker::association {

constexpr std::size_t kMaximumSpots = 16;   ///< Of one image.
constexpr std::size_t kMaximumTracks = 32;  ///< That one image may show.

/// What each explanation of the spots of one image costs; negative log likelihoods, say. All in one
/// unit, above or below zero; +infinity in `pair` forbids a pair (a gate), the others are finite.
struct SpotCosts {
  std::size_t spots = 0;                                               ///< At most kMaximumSpots.
  std::size_t tracks = 0;                                              ///< At most kMaximumTracks.
  std::array<std::array<double, kMaximumTracks>, kMaximumSpots> pair;  ///< [spot][track]
  std::array<double, kMaximumSpots> ghost;                             ///< No track made the spot.
  std::array<double, kMaximumTracks> miss;                             ///< The track made no spot.

  /// Forbids all pairs and sets the costs of all ghosts and misses.
  void reset(std::size_t spot_count, std::size_t track_count, double ghost_cost, double miss_cost);
};

constexpr int kGhost = -1;

struct SpotAssignment {
  /// Of each spot, its track or kGhost; undefined from SpotCosts::spots on.
  std::array<int, kMaximumSpots> track_of_spot;
  double cost = 0.0;  ///< Of the pairs, the ghosts and the misses.
};

/// The assignment with the least cost of all in which each spot has at most one track and each
/// track at most one spot: shortest augmenting paths (Jonker and Volgenant 1987), exact. Never
/// allocates.
SpotAssignment assignSpots(const SpotCosts& costs);

}  // namespace wiimote_tracker::association

#endif  // WIIMOTE_TRACKER_TRIANGULATION_ASSOCIATION_ASSIGN_SPOTS_H
