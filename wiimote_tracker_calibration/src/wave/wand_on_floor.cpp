#include "steps.h"

#include "wave/error.h"

#include <wiimote_tracker_msgs/text.h>
#include <wiimote_tracker_triangulation/geometry/triangulate.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

namespace wiimote_tracker::wave {

namespace {

const char kAgain[] = ", and begin again";
/// How far the wand may seem to be from what it must be.
struct Limits {
  double spot;    ///< Error of a spot at rest [px].
  double length;  ///< Error of its length, as a share of it [1].
  double tilt;    ///< From level, beyond what is uncertain [rad].
};
constexpr Limits kByStart = {9.0, 0.1, 0.1};
constexpr Limits kBySolution = {3.0, 0.05, 0.0};
// Least difference of its ends' distances from the first camera, as a share of its length: a person
// sees which end is nearer.
constexpr double kNearerShare = 0.2;
// Angle from level that is refused [standard deviations].
constexpr double kLevelLimit = 5.0;

/// The wand by what some cameras saw of it.
struct Measured {
  std::array<Eigen::Vector3d, 2> leds;
  double length = 0.0;    ///< [m]
  double error_px = 0.0;  ///< Larger of the LEDs' reprojection errors.
  double error_over_limit =
      0.0;  ///< Larger of the errors, of spots and length, over kBySolution's limit.
};

/// Nothing where the spots have no common point.
std::optional<Measured> measure(const std::vector<geometry::Camera>& cameras,
                                const FloorSpots& spots,
                                double length) {
  Measured result;
  for (std::size_t led = 0; led < 2; ++led) {
    std::vector<geometry::Observation> observations;
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      if (spots[i])
        observations.push_back({&cameras[i], (*spots[i])[led]});
    }
    const auto point = geometry::triangulate(observations, {});
    if (!point)
      return std::nullopt;
    result.leds[led] = point->position;
    result.error_px = std::max(result.error_px, point->reprojection_error);
  }
  result.length = (result.leds[1] - result.leds[0]).norm();
  result.error_over_limit =
      std::max(result.error_px / kBySolution.spot,
               std::abs(result.length - length) / (kBySolution.length * length));
  return result;
}

/// Puts each camera's spots into the order of the first's.
FloorSpots inOneOrder(const std::vector<geometry::Camera>& cameras,
                      const FloorSpots& seen,
                      double length) {
  FloorSpots spots(seen.size());
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (!seen[i])
      continue;
    FloorSpots swapped = spots;
    spots[i] = seen[i];
    swapped[i] = {(*seen[i])[1], (*seen[i])[0]};
    const auto other = measure(cameras, swapped, length);
    const auto as_is = measure(cameras, spots, length);
    if (other && (!as_is || other->error_over_limit < as_is->error_over_limit))
      spots = swapped;
  }
  return spots;
}

/// Mean up of the accelerometers and how many there are.
std::pair<Eigen::Vector3d, int> meanUp(const Recording& recording, const State& state) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  for (std::size_t i = 0; i < recording.cameras.size(); ++i) {
    if (const auto& gravity = recording.cameras[i].sightings.gravity) {
      sum += state.cameras[i].world_from_camera.linear() * gravity->normalized();
      ++count;
    }
  }
  if (!(sum.norm() > 0.5 * count))
    throw WaveContradiction(
        "the accelerometers contradict one another: check that no image is mirrored or turned, and "
        "that no camera was moved");
  return {sum.normalized(), count};
}

/// @throws WandMislaid: the spots are not those of the wand, or do not tell its ends apart.
void requireWand(const std::optional<Measured>& wand,
                 const geometry::Camera& first,
                 double length,
                 const Limits& limits) {
  if (!wand || wand->error_px > limits.spot ||
      std::abs(wand->length - length) > limits.length * length)
    throw WandMislaid(format("what the cameras saw at rest is not the wand of %.2f m", length) +
                      (wand ? format(": its ends would be %.2f m apart, and %.0f px off",
                                     wand->length, wand->error_px)
                            : std::string()) +
                      "; switch other lights off, lay both its LEDs where the cameras see them" +
                      kAgain);
  const double farther =
      (wand->leds[1] - first.center()).norm() - (wand->leds[0] - first.center()).norm();
  if (std::abs(farther) < kNearerShare * length)
    throw WandMislaid("both ends of the wand were about as far from " + first.name +
                      ", but the nearer one is the origin: turn the wand towards that camera" +
                      kAgain);
}

/// @param rise sine of the wand's angle from level.
/// @throws WandMislaid: by the accelerometers the wand was not level.
void requireLevel(const Recording& recording,
                  const square::Uncertainty& uncertainty,
                  double rise,
                  int accelerometers,
                  const Limits& limits) {
  const double limit =
      limits.tilt +
      kLevelLimit * std::hypot(uncertainty.gravity / std::sqrt(static_cast<double>(accelerometers)),
                               uncertainty.placement / recording.wand->length);
  const double angle = std::asin(std::clamp(rise, -1.0, 1.0));
  if (std::abs(angle) > limit)
    throw WandMislaid(
        format("by the accelerometers the wand lay %.0f degrees from level: lay both its LEDs on "
               "the floor",
               std::abs(angle) * 180.0 / M_PI) +
        kAgain);
}

struct Found {
  WandOnFloor floor;  // the end nearer to the first camera first
  Eigen::Vector3d up;
};

/// @throws WandMislaid: it cannot be used. WaveContradiction.
Found findWand(const Task& task, const State& state, const Limits& limits) {
  const double length = state.wand_length;
  WandOnFloor floor;
  floor.spots = inOneOrder(state.cameras, task.floor, length);
  const geometry::Camera& first = state.cameras.front();
  const auto wand = measure(state.cameras, floor.spots, length);
  requireWand(wand, first, length, limits);
  floor.leds = wand->leds;
  if ((floor.leds[1] - first.center()).norm() < (floor.leds[0] - first.center()).norm()) {
    std::swap(floor.leds[0], floor.leds[1]);
    for (auto& pair : floor.spots) {
      if (pair)
        std::swap((*pair)[0], (*pair)[1]);
    }
  }
  const auto [up, accelerometers] = meanUp(task.recording, state);
  const Eigen::Vector3d along = (floor.leds[1] - floor.leds[0]).normalized();
  requireLevel(task.recording, task.options.uncertainty, along.dot(up), accelerometers, limits);
  return {floor, up};
}

void moveState(const Eigen::Isometry3d& to_from, State* state) {
  moveCameras(to_from, &state->cameras);
  // The weights of a spline's control points add up to one: it moves as they do.
  Eigen::MatrixXd& controls = state->trajectory.controls();
  for (Eigen::Index led = 0; led < state->trajectory.leds(); ++led) {
    auto path = controls.middleRows<3>(3 * led);
    path = ((to_from.linear() * path).colwise() + to_from.translation()).eval();
  }
}

}  // namespace

FloorSpots takeFloor(Recording* recording) {
  if (!recording->wand || !recording->wand->led_height)
    return {};
  FloorSpots spots;
  double end = -std::numeric_limits<double>::infinity();
  bool has_gravity = false;
  for (const CameraRecording& camera : recording->cameras) {
    WandRest rest;
    for (const Frame& frame : camera.frames)
      rest.add(frame);
    if (rest.spots() && rest.end() == camera.frames.back().stamp)
      throw WaveError(camera.sightings.name +
                      " saw two lights at rest to the end: switch other lights off, and lift the "
                      "wand to wave it" +
                      kAgain);
    spots.push_back(rest.spots());
    end = rest.spots() ? std::max(end, rest.end()) : end;
    has_gravity = has_gravity || camera.sightings.gravity;
  }
  const auto seen = std::count_if(spots.begin(), spots.end(), [](const auto& s) { return !!s; });
  if (seen < 2)
    throw WaveError("only " + counted(static_cast<std::size_t>(seen), "camera") +
                    " saw both LEDs of the wand, and no other light, at rest for 2 s: lay "
                    "it on the floor where two cameras see both" +
                    kAgain);
  if (!has_gravity)
    throw WaveError(Wand::kNoUp);
  for (CameraRecording& camera : recording->cameras) {
    std::vector<Frame>& frames = camera.frames;
    frames.erase(frames.begin(),
                 std::find_if(frames.begin(), frames.end(),
                              [end](const Frame& frame) { return frame.stamp > end; }));
  }
  return spots;
}

void checkStart(const Task& task, const State& state) {
  try {
    findWand(task, state, kByStart);
  } catch (const WandMislaid& error) {
    throw WaveError(error.what());  // another start may tell otherwise
  }
}

void useFloorAsWorld(const Task& task, State* state) {
  auto [floor, up] = findWand(task, *state, kBySolution);
  const Eigen::Vector3d along = (floor.leds[1] - floor.leds[0]).normalized();
  const Eigen::Vector3d x = (along - along.dot(up) * up).normalized();
  Eigen::Isometry3d floor_from_state = Eigen::Isometry3d::Identity();
  floor_from_state.linear() << x.transpose(), up.cross(x).transpose(), up.transpose();
  floor_from_state.translation() = Eigen::Vector3d(0.0, 0.0, *task.recording.wand->led_height) -
                                   floor_from_state.linear() * floor.leds[0];
  for (Eigen::Vector3d& led : floor.leds)
    led = floor_from_state * led;
  moveState(floor_from_state, state);
  state->floor = floor;
}

}  // namespace wiimote_tracker::wave
