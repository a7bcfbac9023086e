#include "association/assign_spots.h"

#include <algorithm>
#include <limits>

namespace wiimote_tracker::association {
namespace {

constexpr double kTooFar = std::numeric_limits<double>::infinity();
constexpr int kNone = -1;

/// Spots are rows. Columns are the tracks, then each spot's own false detection. A pair costs what
/// it adds to the track's missed detection, so that a column without a spot costs nothing.
class Assignment {
 public:
  explicit Assignment(const SpotCosts& costs)
      : costs_(costs), columns_(static_cast<int>(costs.tracks + costs.spots)) {
    spot_of_column_.fill(kNone);
    spot_price_.fill(0.0);
    column_price_.fill(0.0);
  }

  std::array<int, kMaximumSpots> solve() {
    for (int spot = 0; spot < static_cast<int>(costs_.spots); ++spot)
      insert(spot);
    std::array<int, kMaximumSpots> track_of_spot;
    track_of_spot.fill(kFalseDetection);
    for (int track = 0; track < static_cast<int>(costs_.tracks); ++track) {
      if (spot_of_column_[track] != kNone)
        track_of_spot[spot_of_column_[track]] = track;
    }
    return track_of_spot;
  }

 private:
  static constexpr std::size_t kMaximumColumns = kMaximumTracks + kMaximumSpots;
  using Columns = std::array<int, kMaximumColumns>;

  double cost(int spot, int column) const {
    const int tracks = static_cast<int>(costs_.tracks);
    if (column < tracks)
      return costs_.pair[spot][column] - costs_.miss[column];
    return column - tracks == spot ? costs_.ghost[spot] : kTooFar;
  }

  /// Assigns a spot along the shortest path to a free column, over columns whose spots are
  /// reassigned: Dijkstra's algorithm on the reduced costs, of which only the new spot's may be
  /// negative.
  void insert(int new_spot) {
    std::array<bool, kMaximumColumns> reached{};
    std::array<double, kMaximumColumns> distance;  // from the columns that are reached
    distance.fill(kTooFar);
    Columns previous;  // on the shortest path; kNone: the new spot
    previous.fill(kNone);
    int last = kNone;  // the column reached last, and its spot
    int spot = new_spot;
    for (;;) {
      int nearest = kNone;
      for (int column = 0; column < columns_; ++column) {
        if (reached[column])
          continue;
        const double reduced = cost(spot, column) - spot_price_[spot] - column_price_[column];
        if (reduced < distance[column]) {
          distance[column] = reduced;
          previous[column] = last;
        }
        if (nearest == kNone || distance[column] < distance[nearest])
          nearest = column;
      }
      raisePrices(distance[nearest], new_spot, reached, &distance);
      last = nearest;
      if (spot_of_column_[last] == kNone)
        break;
      reached[last] = true;
      spot = spot_of_column_[last];
    }
    // Each column on the path gets the spot of the one before.
    for (int column = last; column != kNone; column = previous[column])
      spot_of_column_[column] =
          previous[column] == kNone ? new_spot : spot_of_column_[previous[column]];
  }

  /// Keeps the reduced costs along the paths zero, and those of all pairs at zero or more.
  void raisePrices(double step,
                   int new_spot,
                   const std::array<bool, kMaximumColumns>& reached,
                   std::array<double, kMaximumColumns>* distance) {
    spot_price_[new_spot] += step;
    for (int column = 0; column < columns_; ++column) {
      if (reached[column]) {
        spot_price_[spot_of_column_[column]] += step;
        column_price_[column] -= step;
      } else {
        (*distance)[column] -= step;
      }
    }
  }

  const SpotCosts& costs_;
  int columns_;
  Columns spot_of_column_;
  std::array<double, kMaximumSpots> spot_price_;      // dual variables
  std::array<double, kMaximumColumns> column_price_;  // at most zero
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

TrackOfSpot assignSpots(const SpotCosts& costs) {
  return Assignment(costs).solve();
}

}  // namespace wiimote_tracker::association
