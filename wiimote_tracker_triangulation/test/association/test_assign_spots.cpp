// Spots of one image to tracks, against every assignment there is.
#include "association/assign_spots.h"
#include "geometry/random_rigs.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <set>

namespace wiimote_tracker::association {
namespace {

using geometry::test::Random;

constexpr double kTooFar = std::numeric_limits<double>::infinity();

using Assignment = std::array<int, kMaximumSpots>;

double costOf(const SpotCosts& costs, const Assignment& track_of_spot) {
  double cost = 0.0;
  std::set<int> taken;
  for (std::size_t spot = 0; spot < costs.spots; ++spot) {
    const int track = track_of_spot[spot];
    if (track == kFalseDetection) {
      cost += costs.ghost[spot];
    } else {
      EXPECT_TRUE(taken.insert(track).second) << "track " << track << " has two spots";
      EXPECT_LT(track, static_cast<int>(costs.tracks));
      cost += costs.pair[spot][static_cast<std::size_t>(track)];
    }
  }
  for (std::size_t track = 0; track < costs.tracks; ++track) {
    if (taken.count(static_cast<int>(track)) == 0)
      cost += costs.miss[track];
  }
  return cost;
}

/// The least cost of the spots from `spot` on, over all assignments.
double leastCost(const SpotCosts& costs, std::size_t spot, unsigned taken) {
  if (spot == costs.spots) {
    double missed = 0.0;
    for (std::size_t track = 0; track < costs.tracks; ++track)
      missed += (taken >> track & 1u) ? 0.0 : costs.miss[track];
    return missed;
  }
  double least = costs.ghost[spot] + leastCost(costs, spot + 1, taken);
  for (std::size_t track = 0; track < costs.tracks; ++track) {
    if ((taken >> track & 1u) || costs.pair[spot][track] == kTooFar)
      continue;
    least =
        std::min(least, costs.pair[spot][track] + leastCost(costs, spot + 1, taken | 1u << track));
  }
  return least;
}

SpotCosts randomCosts(Random& random, std::size_t most) {
  SpotCosts costs;
  const auto size = [&] {
    return static_cast<std::size_t>(random.uniform(0.0, static_cast<double>(most) + 1.0));
  };
  const std::size_t spots = size();
  costs.reset(spots, size(), 0.0, 0.0);
  const double gated = random.uniform(0.0, 1.0);              // share of pairs
  const bool whole_numbers = random.uniform(0.0, 1.0) < 0.3;  // many ties
  const auto cost = [&](double low, double high) {
    const double value = random.uniform(low, high);
    return whole_numbers ? std::floor(value) : value;
  };
  for (std::size_t spot = 0; spot < costs.spots; ++spot) {
    costs.ghost[spot] = cost(-2.0, 8.0);
    for (std::size_t track = 0; track < costs.tracks; ++track) {
      if (random.uniform(0.0, 1.0) > gated)
        costs.pair[spot][track] = cost(-5.0, 10.0);
    }
  }
  for (std::size_t track = 0; track < costs.tracks; ++track)
    costs.miss[track] = cost(-2.0, 8.0);
  return costs;
}

TEST(AssignSpots, NothingToAssign) {
  SpotCosts costs;
  EXPECT_EQ(0.0, costOf(costs, assignSpots(costs)));
  costs.reset(0, 3, 5.0, 2.0);
  EXPECT_EQ(6.0, costOf(costs, assignSpots(costs)));
  costs.reset(2, 0, 5.0, 2.0);
  const Assignment ghosts = assignSpots(costs);
  EXPECT_EQ(10.0, costOf(costs, ghosts));
  EXPECT_EQ(kFalseDetection, ghosts[0]);
  EXPECT_EQ(kFalseDetection, ghosts[1]);
}

TEST(AssignSpots, TheNearestIsNotAlwaysRight) {
  // Both spots are nearest to track 0; only together it shows that spot 1 has an alternative.
  SpotCosts costs;
  costs.reset(2, 2, 20.0, 20.0);
  costs.pair[0][0] = 2.0;
  costs.pair[1][0] = 1.0;
  costs.pair[1][1] = 3.0;
  const Assignment assignment = assignSpots(costs);
  EXPECT_EQ(0, assignment[0]);
  EXPECT_EQ(1, assignment[1]);
  EXPECT_EQ(5.0, costOf(costs, assignment));
}

TEST(AssignSpots, MatchesTheBestOfAllAssignments) {
  Random random(11);
  for (int i = 0; i < 100000; ++i) {
    const SpotCosts costs = randomCosts(random, 4);
    ASSERT_NEAR(leastCost(costs, 0, 0), costOf(costs, assignSpots(costs)), 1e-12) << "case " << i;
  }
  for (int i = 0; i < 200; ++i) {
    const SpotCosts costs = randomCosts(random, 6);
    ASSERT_NEAR(leastCost(costs, 0, 0), costOf(costs, assignSpots(costs)), 1e-12) << "case " << i;
  }
}

/// An assignment of any size is optimal when no cyclic exchange of tracks costs less.
TEST(AssignSpots, IsTheOptimumAtFullSize) {
  Random random(12);
  for (int i = 0; i < 300; ++i) {
    SpotCosts costs = randomCosts(random, kMaximumSpots);
    if (i % 2 == 0) {
      costs.reset(kMaximumSpots, kMaximumTracks, 50.0, 50.0);
      for (auto& row : costs.pair) {
        for (double& cost : row)
          cost = random.uniform(0.0, 10.0);
      }
    }
    const Assignment assignment = assignSpots(costs);
    ASSERT_TRUE(std::isfinite(costOf(costs, assignment))) << "case " << i;
    // Nodes: spots, then a place for "no spot". An edge from a to b: b's track goes to a. Bellman
    // and Ford find a cycle of negative length if there is one.
    constexpr std::size_t kNodes = kMaximumSpots + 1;
    std::array<double, kNodes> distance{};
    const auto own = [&](std::size_t spot) {
      const int track = assignment[spot];
      return track == kFalseDetection ? costs.ghost[spot]
                                      : costs.pair[spot][static_cast<std::size_t>(track)];
    };
    bool improved = true;
    for (std::size_t round = 0; round <= kNodes && improved; ++round) {
      improved = false;
      for (std::size_t a = 0; a < costs.spots; ++a) {
        const auto relax = [&](std::size_t b, double length) {
          if (distance[a] + length < distance[b] - 1e-9) {
            distance[b] = distance[a] + length;
            improved = true;
          }
        };
        relax(kNodes - 1, costs.ghost[a] - own(a));
        for (std::size_t b = 0; b < costs.spots; ++b) {
          const int track = assignment[b];
          if (a != b && track != kFalseDetection)
            relax(b, costs.pair[a][static_cast<std::size_t>(track)] - own(a));
        }
        // Tracks without a spot, and spots that leave theirs without one.
        for (std::size_t track = 0; track < costs.tracks; ++track) {
          bool taken = false;
          for (std::size_t b = 0; b < costs.spots; ++b)
            taken = taken || assignment[b] == static_cast<int>(track);
          if (!taken)
            relax(kNodes - 1, costs.pair[a][track] - costs.miss[track] - own(a));
        }
      }
      for (std::size_t b = 0; b < costs.spots; ++b) {
        // "No spot" takes b's track (its miss is paid), or nothing where b is a ghost.
        const int track = assignment[b];
        const double length =
            track == kFalseDetection ? 0.0 : costs.miss[static_cast<std::size_t>(track)];
        if (distance[kNodes - 1] + length < distance[b] - 1e-9) {
          distance[b] = distance[kNodes - 1] + length;
          improved = true;
        }
      }
    }
    ASSERT_FALSE(improved) << "case " << i << ": an exchange of tracks costs less";
  }
}

}  // namespace
}  // namespace wiimote_tracker::association
