#include "clock_step.h"

#include <algorithm>
#include <optional>

namespace wiimote_tracker::wave {

namespace {

/// A spot as a measurement of its own stamp's error.
struct Lag {
  double stamp;        // [s]
  double information;  // |v|^2, v: velocity of the spot [px^2/s^2]
  double score;        // how late the spot is, times the information [px^2/s]
  double squared;      // of the residual [px^2]
};

std::optional<Lag> lagOf(const State& state, const Match& match) {
  const double kStep = 1e-4;  // [s]
  const double time = match.stamp + state.offsets[match.camera];
  const auto pixelAt = [&](double when) {
    return state.cameras[match.camera].project(
        state.trajectory.position(state.trajectory.in(match.interval, when), match.led));
  };
  const auto pixel = pixelAt(time);
  const auto later = pixelAt(time + kStep);
  if (!pixel || !later)
    return std::nullopt;
  const Eigen::Vector2d velocity = (*later - *pixel) / kStep;
  const Eigen::Vector2d residual = match.pixel - *pixel;
  return Lag{match.stamp, velocity.squaredNorm(), -residual.dot(velocity), residual.squaredNorm()};
}

}  // namespace

std::vector<ClockStep> clockSteps(const State& state, const std::vector<Match>& matches) {
  std::vector<std::vector<Lag>> cameras(state.cameras.size());
  for (const Match& match : matches) {
    if (const auto lag = lagOf(state, match))
      cameras[match.camera].push_back(*lag);
  }
  std::vector<ClockStep> result;
  for (std::vector<Lag>& lags : cameras) {
    std::sort(lags.begin(), lags.end(),
              [](const Lag& a, const Lag& b) { return a.stamp < b.stamp; });
    Lag all{};
    for (const Lag& lag : lags) {
      all.information += lag.information;
      all.score += lag.score;
      all.squared += lag.squared;
    }
    ClockStep best;
    best.squared = all.squared;
    Lag before{};
    for (const Lag& lag : lags) {
      before.information += lag.information;
      before.score += lag.score;
      const double after = all.information - before.information;
      const double size = (all.score - before.score) / after - before.score / before.information;
      const double explained = size * size * before.information * after / all.information;
      if (explained > best.explained)  // false for the NaN after the last spot
        best = {lag.stamp, size, explained, all.squared};
    }
    result.push_back(best);
  }
  return result;
}

}  // namespace wiimote_tracker::wave
