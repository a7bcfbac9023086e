#include "steps.h"

#include "adjustment.h"
#include "wave/error.h"

#include <wiimote_tracker_msgs/text.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <vector>

namespace wiimote_tracker::wave {

namespace {

// Images before or after a jump may be this far off [px].
constexpr double kFarOff = 40.0;
// Least jump of a clock [s]: more than clocks wander during a wave.
constexpr double kLeastJump = 0.004;
// Least share of the squared residuals that a jump explains, and the largest that is left without
// it.
constexpr double kLeastExplained = 0.1;
constexpr double kMostLeft = 0.9;
// Rounds in which the size of a jump is found.
constexpr int kJumpRounds = 4;
// Least factor by which a true jump grows in these rounds: by 2 where two cameras share the path,
// by 1.02 where 64 do.
constexpr double kLeastGrowth = 1.01;

/// A spot as a measurement of its own stamp's error.
struct Lag {
  double stamp;        // [s]
  double information;  // |v|^2, v: velocity of the spot [px^2/s^2]
  double score;        // how late the spot is, times the information [px^2/s]
  double squared;      // of the residual [px^2]
};

std::optional<Lag> lagOf(const State& state, const Match& match) {
  const Trajectory::Place place =
      state.trajectory.in(match.interval, match.stamp + state.offsets[match.camera]);
  Eigen::Matrix<double, 2, 3> by_point;
  const auto pixel =
      state.cameras[match.camera].project(state.trajectory.position(place, match.led), &by_point);
  if (!pixel)
    return std::nullopt;
  const Eigen::Vector2d velocity = by_point * state.trajectory.velocity(place, match.led);
  const Eigen::Vector2d residual = match.pixel - *pixel;
  return Lag{match.stamp, velocity.squaredNorm(), -residual.dot(velocity), residual.squaredNorm()};
}

/// A jump of one camera's clock during the wave.
struct ClockJump {
  double after = 0.0;      ///< Stamp of the last image before the jump [s].
  double size = 0.0;       ///< How much too late the stamps after it are [s].
  double explained = 0.0;  ///< Part of the squared residuals that it explains [px^2].
  double squared = 0.0;    ///< Sum of the camera's squared residuals [px^2].
};

/// For each camera the jump that explains the residuals along the motion of its spots best (the
/// change point of a mean, Hinkley 1970). The path follows a jump in part, so that the size is too
/// small.
std::vector<ClockJump> clockJumps(const State& state, const std::vector<Match>& matches) {
  std::vector<std::vector<Lag>> cameras(state.cameras.size());
  for (const Match& match : matches) {
    if (const auto lag = lagOf(state, match))
      cameras[match.camera].push_back(*lag);
  }
  std::vector<ClockJump> result;
  for (std::vector<Lag>& lags : cameras) {
    std::sort(lags.begin(), lags.end(),
              [](const Lag& a, const Lag& b) { return a.stamp < b.stamp; });
    Lag all{};
    for (const Lag& lag : lags) {
      all.information += lag.information;
      all.score += lag.score;
      all.squared += lag.squared;
    }
    ClockJump best;
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

double sumOfSquares(const std::vector<ClockJump>& jumps) {
  return std::accumulate(jumps.begin(), jumps.end(), 0.0,
                         [](double sum, const ClockJump& jump) { return sum + jump.squared; });
}

Recording withoutJump(Recording recording, std::size_t camera, const ClockJump& jump) {
  for (Frame& frame : recording.cameras[camera].frames)
    frame.stamp -= frame.stamp > jump.after ? jump.size : 0.0;
  return recording;
}

}  // namespace

// The path follows a clock that jumps and hides a part of the jump. So the largest jump is removed,
// the path is fitted again, and the jump is measured again: a true one grows.
void checkClocks(const Task& task,
                 const Gate& gate,
                 const std::function<void()>& report,
                 State state) {
  Gate wide = gate;
  wide.limit = kFarOff / gate.pixel_stddev;
  const auto jumpsOf = [&](const Recording& waved) {
    return clockJumps(state, matchSpots(waved, state, wide).matches);
  };
  std::vector<ClockJump> jumps = jumpsOf(task.recording);
  const double before = sumOfSquares(jumps);
  const auto worst = std::max_element(
      jumps.begin(), jumps.end(),
      [](const ClockJump& a, const ClockJump& b) { return a.explained < b.explained; });
  const auto camera = static_cast<std::size_t>(worst - jumps.begin());
  const double apparent = std::abs(worst->size);
  if (worst->explained < kLeastExplained * before || apparent < kLeastJump)
    return;
  Task corrected = task;
  Matching matching;
  for (int round = 0; round < kJumpRounds; ++round) {
    corrected.recording = withoutJump(task.recording, camera, jumps[camera]);
    matching = matchSpots(corrected.recording, state, gate);
    if (std::count(matching.found.begin(), matching.found.end(), 0) > 0)
      return;  // not a jump: the camera would fit nowhere
    refine(corrected, matching.matches, std::numeric_limits<double>::infinity(), report, &state);
    jumps = jumpsOf(task.recording);
  }
  if (std::abs(jumps[camera].size) < kLeastGrowth * apparent ||
      sumOfSquares(jumpsOf(corrected.recording)) > kMostLeft * before ||
      agreementOf(corrected, matching.matches, state).isContradiction())
    return;
  const auto name = [&](std::size_t i) { return task.recording.cameras[i].sightings.name; };
  // Of two cameras either clock may have jumped.
  const bool two = task.recording.cameras.size() == 2;
  throw WaveError("the clock of " + (two ? name(0) + " or " + name(1) : name(camera)) +
                  format(" jumped by about %.0f ms during the wave: check the time of its computer "
                         "and its driver, and wave again",
                         1e3 * std::abs(jumps[camera].size)));
}

}  // namespace wiimote_tracker::wave
