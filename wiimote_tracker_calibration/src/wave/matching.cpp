#include "matching.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace wiimote_tracker::wave {

namespace {

// Spots of two LEDs closer than this run together into one between them [px].
constexpr double kRunTogether = 14.0;

/// Where one LED should be in one frame.
struct Prediction {
  Eigen::Vector2d pixel;
  Eigen::Matrix2d whitening;
};

std::optional<Prediction> predict(const State& state,
                                  std::size_t camera,
                                  const Trajectory::Place& place,
                                  Eigen::Index led,
                                  const Gate& gate) {
  Eigen::Matrix<double, 2, 3> by_point;
  const auto pixel =
      state.cameras[camera].project(state.trajectory.position(place, led), &by_point);
  if (!pixel)
    return std::nullopt;
  Prediction prediction{*pixel, Eigen::Matrix2d::Identity() / gate.pixel_stddev};
  const Eigen::Vector2d motion =
      gate.stamp_stddev * (by_point * state.trajectory.velocity(place, led));
  if (motion.squaredNorm() > 0.0) {
    // An error of the stamp moves the spot along its way only.
    const Eigen::Vector2d along = motion.normalized();
    const double stddev = std::hypot(gate.pixel_stddev, motion.norm());
    prediction.whitening += (1.0 / stddev - 1.0 / gate.pixel_stddev) * along * along.transpose();
  }
  return prediction;
}

bool inImage(const geometry::Intrinsics& lens, const Eigen::Vector2d& pixel) {
  return pixel.x() >= 0.0 && pixel.y() >= 0.0 && pixel.x() < lens.width && pixel.y() < lens.height;
}

double errorOf(const Prediction& prediction, const Eigen::Vector2d& spot) {
  return (prediction.whitening * (prediction.pixel - spot)).norm();
}

/// Index of the spot that fits best within the limit, leaving out one; -1: none.
int bestSpot(const Frame& frame, const Prediction& prediction, double limit, int without) {
  int best = -1;
  double least = limit;
  for (int i = 0; i < static_cast<int>(frame.spots.size()); ++i) {
    const double error = errorOf(prediction, frame.spots[static_cast<std::size_t>(i)]);
    if (i != without && error < least) {
      least = error;
      best = i;
    }
  }
  return best;
}

/// Spots for both LEDs: the better of giving the first its best spot or the second its own.
std::array<int, 2> bestSpots(const Frame& frame,
                             const std::array<std::optional<Prediction>, 2>& predictions,
                             double limit) {
  std::array<int, 2> best = {-1, -1};
  double least = std::numeric_limits<double>::infinity();
  for (int leader = 0; leader < 2; ++leader) {
    std::array<int, 2> chosen = {-1, -1};
    double sum = 0.0;
    for (int turn = 0; turn < 2; ++turn) {
      const auto led = static_cast<std::size_t>(turn == 0 ? leader : 1 - leader);
      if (predictions[led])
        chosen[led] = bestSpot(frame, *predictions[led], limit, chosen[1 - led]);
      sum += chosen[led] < 0
                 ? limit
                 : errorOf(*predictions[led], frame.spots[static_cast<std::size_t>(chosen[led])]);
    }
    if (sum < least) {
      least = sum;
      best = chosen;
    }
  }
  return best;
}

}  // namespace

Matching matchSpots(const Recording& recording, const State& state, const Gate& gate) {
  const std::size_t cameras = recording.cameras.size();
  const auto intervals = static_cast<std::size_t>(state.trajectory.intervals());
  const bool wand = state.trajectory.leds() == 2;
  struct Expected {
    std::size_t camera;
    Eigen::Index led;
    std::size_t interval;
    std::optional<Match> match;
  };
  std::vector<Expected> all;
  // Per LED and knot interval: the cameras that see it there, as the last of them and whether there
  // is another.
  struct Seen {
    std::size_t camera = std::numeric_limits<std::size_t>::max();
    bool by_several = false;
    void add(std::size_t other) {
      by_several =
          by_several || (camera != std::numeric_limits<std::size_t>::max() && camera != other);
      camera = other;
    }
  };
  std::array<std::vector<Seen>, 2> seen;
  seen.fill(std::vector<Seen>(intervals));

  for (std::size_t c = 0; c < cameras; ++c) {
    for (const Frame& frame : recording.cameras[c].frames) {
      const auto place = state.trajectory.at(frame.stamp + state.offsets[c]);
      if (!place || frame.spots.empty())
        continue;
      std::array<std::optional<Prediction>, 2> predictions;
      for (Eigen::Index led = 0; led < state.trajectory.leds(); ++led)
        predictions[static_cast<std::size_t>(led)] = predict(state, c, *place, led, gate);
      std::array<int, 2> chosen = {-1, -1};
      if (!wand) {
        if (predictions[0])
          chosen[0] = bestSpot(frame, *predictions[0], gate.limit, -1);
      } else {
        if (predictions[0] && predictions[1] &&
            (predictions[0]->pixel - predictions[1]->pixel).norm() < kRunTogether)
          continue;
        chosen = bestSpots(frame, predictions, gate.limit);
      }
      for (Eigen::Index led = 0; led < state.trajectory.leds(); ++led) {
        const auto l = static_cast<std::size_t>(led);
        if (!predictions[l])
          continue;
        Expected expected{c, led, static_cast<std::size_t>(place->first), std::nullopt};
        if (chosen[l] >= 0) {
          expected.match =
              Match{c, led, frame.stamp, frame.spots[static_cast<std::size_t>(chosen[l])],
                    predictions[l]->whitening};
          seen[l][expected.interval].add(c);
        } else if (!inImage(state.cameras[c].intrinsics, predictions[l]->pixel)) {
          continue;
        }
        all.push_back(expected);
      }
    }
  }

  Matching result;
  result.expected.assign(cameras, 0);
  result.found.assign(cameras, 0);
  for (const Expected& expected : all) {
    const std::vector<Seen>& of_led = seen[static_cast<std::size_t>(expected.led)];
    Seen around;
    for (std::size_t i = std::max<std::size_t>(expected.interval, 1) - 1;
         i <= std::min(expected.interval + 1, intervals - 1); ++i) {
      if (of_led[i].camera != std::numeric_limits<std::size_t>::max())
        around.add(of_led[i].camera);
      around.by_several = around.by_several || of_led[i].by_several;
    }
    if (!around.by_several)
      continue;
    ++result.expected[expected.camera];
    if (expected.match) {
      ++result.found[expected.camera];
      result.matches.push_back(*expected.match);
    }
  }
  return result;
}

}  // namespace wiimote_tracker::wave
