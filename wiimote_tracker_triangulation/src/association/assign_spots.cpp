#include "association/assign_spots.h"

#include <algorithm>
#include <limits>

namespace wiimote_tracker::association {
namespace {

constexpr double kTooFar = std::numeric_limits<double>::infinity();
constexpr int kNobody = -1;

/// Spots are rows, tracks are columns. The false detection is one more column, which any number of
/// rows may share. A pair costs what it adds to the track's missed detection, so that free columns
/// cost nothing.
class Assignment {
 public:
  explicit Assignment(const SpotCosts& costs) : costs_(costs) {
    track_of_spot_.fill(kFalseDetection);
    spot_of_track_.fill(kNobody);
    spot_price_.fill(0.0);
    track_price_.fill(0.0);
  }

  const std::array<int, kMaximumSpots>& solve() {
    for (std::size_t spot = 0; spot < costs_.spots; ++spot)
      insert(spot);
    return track_of_spot_;
  }

 private:
  double extra(std::size_t spot, std::size_t track) const {
    return costs_.pair[spot][track] - costs_.miss[track];
  }

  void give(std::size_t spot, int track) {
    track_of_spot_[spot] = track;
    if (track != kFalseDetection)
      spot_of_track_[track] = static_cast<int>(spot);
  }

  /// Assigns a spot along the shortest path, by reduced costs, over tracks that are reassigned to a
  /// free track or a false detection.
  void insert(std::size_t spot) {
    constexpr int kStart = -2;  // before the spot itself
    std::array<bool, kMaximumTracks> reached{};
    std::array<double, kMaximumTracks> distance;  // from the tree of reached tracks
    std::array<int, kMaximumTracks> previous;     // the reached track before
    distance.fill(kTooFar);
    double ghost_distance = kTooFar;
    int ghost_previous = kStart;

    int last = kStart;  // the track reached last
    std::size_t owner = spot;
    int end = kStart;
    int end_previous = kStart;
    for (;;) {
      const double ghost = costs_.ghost[owner] - spot_price_[owner];
      if (ghost < ghost_distance) {
        ghost_distance = ghost;
        ghost_previous = last;
      }
      double step = ghost_distance;
      int nearest = kFalseDetection;
      for (std::size_t track = 0; track < costs_.tracks; ++track) {
        if (reached[track])
          continue;
        const double cost = extra(owner, track) - spot_price_[owner] - track_price_[track];
        if (cost < distance[track]) {
          distance[track] = cost;
          previous[track] = last;
        }
        if (distance[track] < step) {
          step = distance[track];
          nearest = static_cast<int>(track);
        }
      }
      spot_price_[spot] += step;
      for (std::size_t track = 0; track < costs_.tracks; ++track) {
        if (reached[track]) {
          spot_price_[spot_of_track_[track]] += step;
          track_price_[track] -= step;
        } else {
          distance[track] -= step;
        }
      }
      ghost_distance -= step;
      if (nearest == kFalseDetection || spot_of_track_[nearest] == kNobody) {
        end = nearest;
        end_previous = nearest == kFalseDetection ? ghost_previous : previous[nearest];
        break;
      }
      reached[nearest] = true;
      last = nearest;
      owner = spot_of_track_[nearest];
    }
    // Along the path, each track is reassigned to the owner of the track before it.
    for (int track = end, before = end_previous;; track = before, before = previous[before]) {
      if (before == kStart) {
        give(spot, track);
        return;
      }
      give(spot_of_track_[before], track);
    }
  }

  const SpotCosts& costs_;
  std::array<int, kMaximumSpots> track_of_spot_;
  std::array<int, kMaximumTracks> spot_of_track_;
  std::array<double, kMaximumSpots> spot_price_;    // dual variables
  std::array<double, kMaximumTracks> track_price_;  // at most zero
};

}  // namespace

void SpotCosts::reset(std::size_t spot_count,
                      std::size_t track_count,
                      double ghost_cost,
                      double miss_cost) {
  spots = spot_count;
  tracks = track_count;
  for (std::size_t spot = 0; spot < spots; ++spot)
    std::fill_n(pair[spot].begin(), tracks, kTooFar);
  std::fill_n(ghost.begin(), spots, ghost_cost);
  std::fill_n(miss.begin(), tracks, miss_cost);
}

std::array<int, kMaximumSpots> assignSpots(const SpotCosts& costs) {
  return Assignment(costs).solve();
}

}  // namespace wiimote_tracker::association
