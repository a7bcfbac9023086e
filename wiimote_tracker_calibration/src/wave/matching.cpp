#include "steps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

namespace wiimote_tracker::wave {

namespace {

// Spots of two LEDs closer than this are not used: they may have merged into one [px]. Where LEDs
// farther apart merge, the spot between them is outside a gate of the last rounds.
constexpr double kRunTogether = 14.0;

/// Predicted spot of one LED in one frame.
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
    // An error of the stamp moves the spot along its path only.
    const Eigen::Vector2d along = motion.normalized();
    const double stddev = std::hypot(gate.pixel_stddev, motion.norm());
    prediction.whitening += (1.0 / stddev - 1.0 / gate.pixel_stddev) * along * along.transpose();
  }
  return prediction;
}

double errorOf(const Prediction& prediction, const Eigen::Vector2d& spot) {
  return (prediction.whitening * (prediction.pixel - spot)).norm();
}

/// The spots of the LEDs with the least sum of errors, by index; -1: none, which counts as the
/// limit.
std::array<int, 2> bestSpots(const Frame& frame,
                             const std::array<std::optional<Prediction>, 2>& predictions,
                             double limit) {
  const auto count = static_cast<int>(frame.spots.size());
  const auto error = [&](std::size_t led, int spot) {
    if (spot < 0)
      return limit;
    return predictions[led]
               ? errorOf(*predictions[led], frame.spots[static_cast<std::size_t>(spot)])
               : std::numeric_limits<double>::infinity();
  };
  std::array<int, 2> best = {-1, -1};
  double least = 2.0 * limit;
  for (int first = -1; first < count; ++first) {
    for (int second = -1; second < count; ++second) {
      const double sum = error(0, first) + error(1, second);
      if (sum < least && (first != second || first < 0)) {
        least = sum;
        best = {first, second};
      }
    }
  }
  return best;
}

/// An LED that a camera could have seen in one frame.
struct Sighting {
  Match match;  // its pixel is a prediction where the camera did not see the LED
  bool is_seen;
};

/// What one camera could have seen, and what of it it saw.
void addSightings(const CameraRecording& recording,
                  const State& state,
                  std::size_t camera,
                  const Gate& gate,
                  std::vector<Sighting>* sightings) {
  const Eigen::Index leds = state.trajectory.leds();
  for (const Frame& frame : recording.frames) {
    const auto place = state.trajectory.at(frame.stamp + state.offsets[camera]);
    if (!place || frame.spots.empty())
      continue;
    std::array<std::optional<Prediction>, 2> predictions;
    for (Eigen::Index led = 0; led < leds; ++led)
      predictions[static_cast<std::size_t>(led)] = predict(state, camera, *place, led, gate);
    if (predictions[0] && predictions[1] &&
        (predictions[0]->pixel - predictions[1]->pixel).norm() < kRunTogether)
      continue;
    const std::array<int, 2> chosen = bestSpots(frame, predictions, gate.limit);
    for (Eigen::Index led = 0; led < leds; ++led) {
      const std::optional<Prediction>& prediction = predictions[static_cast<std::size_t>(led)];
      if (!prediction)
        continue;
      const int spot = chosen[static_cast<std::size_t>(led)];
      const bool is_seen = spot >= 0;
      const Eigen::Vector2d& pixel =
          is_seen ? frame.spots[static_cast<std::size_t>(spot)] : prediction->pixel;
      if (is_seen || state.cameras[camera].intrinsics.isInImage(pixel))
        sightings->push_back(
            {{camera, led, place->first, frame.stamp, pixel, prediction->whitening}, is_seen});
    }
  }
}

/// Per knot interval: whether two cameras or more see an LED there or in a neighbouring
/// interval.
std::vector<bool> seenBySeveral(const std::vector<Sighting>& sightings,
                                Eigen::Index led,
                                Eigen::Index intervals) {
  std::vector<std::set<std::size_t>> cameras(static_cast<std::size_t>(intervals));
  for (const auto& [match, is_seen] : sightings) {
    if (!is_seen || match.led != led)
      continue;
    const Eigen::Index last = std::min(match.interval + 1, intervals - 1);
    for (Eigen::Index i = std::max<Eigen::Index>(match.interval - 1, 0); i <= last; ++i)
      cameras[static_cast<std::size_t>(i)].insert(match.camera);
  }
  std::vector<bool> several;
  for (const std::set<std::size_t>& in_interval : cameras)
    several.push_back(in_interval.size() >= 2);
  return several;
}

}  // namespace

Matching matchSpots(const Recording& recording, const State& state, const Gate& gate) {
  const std::size_t cameras = recording.cameras.size();
  std::vector<Sighting> sightings;
  for (std::size_t c = 0; c < cameras; ++c)
    addSightings(recording.cameras[c], state, c, gate, &sightings);
  std::vector<std::vector<bool>> several;
  for (Eigen::Index led = 0; led < state.trajectory.leds(); ++led)
    several.push_back(seenBySeveral(sightings, led, state.trajectory.intervals()));

  Matching result;
  result.expected.assign(cameras, 0);
  result.found.assign(cameras, 0);
  for (const auto& [match, is_seen] : sightings) {
    if (!several[static_cast<std::size_t>(match.led)][static_cast<std::size_t>(match.interval)])
      continue;
    ++result.expected[match.camera];
    if (is_seen) {
      ++result.found[match.camera];
      result.matches.push_back(match);
    }
  }
  return result;
}

}  // namespace wiimote_tracker::wave
