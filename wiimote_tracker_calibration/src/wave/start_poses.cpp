#include "start_poses.h"

#include "bundle/start.h"
#include "capture/image.h"
#include "wave/error.h"
#include "wiimote_tracker_calibration/bundle/error.h"
#include "wiimote_tracker_calibration/bundle/similarity.h"
#include "wiimote_tracker_calibration/bundle/solve.h"
#include "wiimote_tracker_calibration/square/solve_square.h"

#include <wiimote_tracker_msgs/text.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

namespace wiimote_tracker::wave {

namespace {

// Times at which the views are compared. More do not make the start better, only slower.
constexpr std::size_t kInstants = 200;
// Frames farther apart than this are not joined [s].
constexpr double kLongestFrameGap = 0.035;
// Errors of pixels due to lenses off by several per cent and clocks by milliseconds; attempts
// alternate [px].
constexpr double kTolerances[] = {6.0, 12.0};
// Shift of the instants of the next attempt, in intervals.
constexpr double kShift = 0.29;
// Times that two cameras must share for a relative pose.
constexpr std::size_t kLeastCommon = 20;
// Interval of the instants for a camera that shares too few of kInstants [s].
constexpr double kSharedStep = 0.05;
// Time that it must share with one other camera [s]: less than coverage.cpp asks of a wave, since
// an image with a stray spot does not count here.
constexpr double kLeastShared = 1.5;

/// One point per frame: the LED's spot, or the middle between the wand's.
std::optional<Eigen::Vector2d> middle(const Frame& frame, bool wand) {
  if (frame.spots.size() != (wand ? 2U : 1U))
    return std::nullopt;
  return wand ? Eigen::Vector2d(0.5 * (frame.spots[0] + frame.spots[1])) : frame.spots[0];
}

/// The same, interpolated between two frames; nothing where the camera does not see it.
std::optional<Eigen::Vector2d> middleAt(const std::vector<Frame>& frames, double time, bool wand) {
  const auto after = std::lower_bound(frames.begin(), frames.end(), time,
                                      [](const Frame& frame, double t) { return frame.stamp < t; });
  if (after == frames.begin() || after == frames.end())
    return std::nullopt;
  const auto before = after - 1;
  const double gap = after->stamp - before->stamp;
  const auto first = middle(*before, wand);
  const auto second = middle(*after, wand);
  if (!first || !second || !(gap > 0.0) || gap > kLongestFrameGap ||
      (*second - *first).norm() > capture::kLongestJump)
    return std::nullopt;
  return *first + (time - before->stamp) / gap * (*second - *first);
}

/// What the cameras saw at one time.
using Views = std::vector<bundle::Observation>;

Views viewsAt(const Recording& recording, double time) {
  Views instant;
  for (std::size_t c = 0; c < recording.cameras.size(); ++c) {
    if (const auto pixel = middleAt(recording.cameras[c].frames, time, recording.wand.has_value()))
      instant.push_back({c, 0, *pixel});
  }
  return instant;
}

/// Appends about kInstants of them, each as one more point.
void appendThinned(std::vector<Views> instants, std::vector<bundle::Observation>* observations) {
  std::size_t point = observations->empty() ? 0 : observations->back().point + 1;
  const std::size_t stride = std::max<std::size_t>(1, instants.size() / kInstants);
  for (std::size_t i = 0; i < instants.size(); i += stride) {
    for (bundle::Observation& observation : instants[i]) {
      observation.point = point;
      observations->push_back(observation);
    }
    ++point;
  }
}

/// Of the instants of an attempt, in intervals.
double shiftOf(int attempt) {
  return std::fmod(0.5 + kShift * attempt, 1.0);
}

/// What the cameras saw at common times.
std::vector<bundle::Observation> commonViews(const Recording& recording, int attempt) {
  const auto [start, end] = recording.span();
  const std::size_t count = 4 * kInstants;
  std::vector<Views> instants;
  for (std::size_t i = 0; i < count; ++i) {
    const double time = start + (end - start) * (static_cast<double>(i) + shiftOf(attempt)) /
                                    static_cast<double>(count);
    const Views instant = viewsAt(recording, time);
    if (instant.size() >= 2)
      instants.push_back(instant);
  }
  std::vector<bundle::Observation> observations;
  appendThinned(std::move(instants), &observations);
  return observations;
}

/// The cameras outside of the largest group that common views or the square connect.
std::vector<std::size_t> unconnectedCameras(const std::vector<bundle::Observation>& observations,
                                            const std::vector<bool>& connected_by_square) {
  const std::size_t cameras = connected_by_square.size();
  std::vector<std::vector<std::size_t>> common(cameras, std::vector<std::size_t>(cameras, 0));
  for (std::size_t i = 0; i < observations.size(); ++i) {
    for (std::size_t j = i + 1;
         j < observations.size() && observations[j].point == observations[i].point; ++j)
      ++common[observations[i].camera][observations[j].camera];
  }
  std::vector<std::size_t> group(cameras);
  std::iota(group.begin(), group.end(), std::size_t{0});
  for (std::size_t i = 0; i < cameras; ++i) {
    for (std::size_t j = i + 1; j < cameras; ++j) {
      if (common[i][j] < kLeastCommon && !(connected_by_square[i] && connected_by_square[j]))
        continue;
      const std::size_t joined = group[j];
      std::replace(group.begin(), group.end(), joined, group[i]);
    }
  }
  const auto size = [&](std::size_t g) { return std::count(group.begin(), group.end(), g); };
  std::size_t largest = group[0];
  for (std::size_t g : group)
    largest = size(g) > size(largest) ? g : largest;
  std::vector<std::size_t> unconnected;
  for (std::size_t i = 0; i < cameras; ++i) {
    if (group[i] != largest)
      unconnected.push_back(i);
  }
  return unconnected;
}

/// Adds what an unconnected camera saw together with that camera of the group with which it shares
/// most: in a long wave kInstants are too far apart for the few seconds that may take.
void addSharedViews(const Recording& recording,
                    int attempt,
                    const std::vector<std::size_t>& unconnected,
                    std::size_t camera,
                    std::vector<bundle::Observation>* observations) {
  const auto [start, end] = recording.span();
  std::vector<std::vector<Views>> shared(recording.cameras.size());
  for (double time = start + kSharedStep * shiftOf(attempt); time < end; time += kSharedStep) {
    const Views instant = viewsAt(recording, time);
    const auto sees = [camera](const bundle::Observation& seen) { return seen.camera == camera; };
    if (std::none_of(instant.begin(), instant.end(), sees))
      continue;
    for (const bundle::Observation& seen : instant) {
      if (std::find(unconnected.begin(), unconnected.end(), seen.camera) == unconnected.end())
        shared[seen.camera].push_back(instant);
    }
  }
  auto most = std::max_element(shared.begin(), shared.end(),
                               [](const auto& a, const auto& b) { return a.size() < b.size(); });
  if (static_cast<double>(most->size()) * kSharedStep >= kLeastShared)
    appendThinned(std::move(*most), observations);
}

/// @throws WaveError: the cameras form groups without common views.
void connectCameras(const Recording& recording,
                    int attempt,
                    const std::vector<bool>& connected_by_square,
                    std::vector<bundle::Observation>* observations) {
  const std::vector<std::size_t> unconnected =
      unconnectedCameras(*observations, connected_by_square);
  for (const std::size_t camera : unconnected)
    addSharedViews(recording, attempt, unconnected, camera, observations);
  const std::vector<std::size_t> left = unconnectedCameras(*observations, connected_by_square);
  // The name of a camera outside the largest group helps most.
  if (!left.empty())
    throw WaveError(recording.cameras[left.front()].sightings.name +
                    " and the other cameras hardly ever saw the LED at the same time: wave "
                    "where it and another camera see the LED together");
}

/// Poses of the cameras that the square did not place, from the others.
void placeRest(const bundle::Options& options, bundle::Reconstruction* reconstruction) {
  const std::vector<bool>& placed = reconstruction->placed;
  while (std::find(placed.begin(), placed.end(), false) != placed.end()) {
    bundle::triangulatePoints(reconstruction, options.maximum_error, placed);
    bundle::resect(options, bundle::nextToResect(options, *reconstruction), reconstruction);
  }
}

/// Places the cameras that saw the whole square by it, and the others by the wave.
void startFromSquare(const square::SquareLayout& layout,
                     const std::vector<square::CameraSightings>& sightings,
                     const square::Uncertainty& uncertainty,
                     const bundle::Options& options,
                     bundle::Reconstruction* wave,
                     StartPoses* result) {
  square::SolveOptions square_options;
  square_options.uncertainty = uncertainty;
  const square::Solution solution = square::solveSquare(layout, sightings, square_options);
  for (geometry::Camera& camera : wave->cameras) {
    if (const geometry::RigCamera* solved = solution.rig.find(camera.name))
      camera = solved->camera;
  }
  placeRest(options, wave);
  result->metric = true;
  result->from_square = true;
  result->z_up = solution.z_up;
}

/// Aligns a reconstruction, known up to a similarity, with the corners that two cameras saw.
void moveOnSquare(const Recording& recording,
                  const bundle::Options& options,
                  bundle::Reconstruction* wave,
                  StartPoses* result) {
  bundle::Reconstruction corners;
  corners.cameras = wave->cameras;
  corners.points.resize(4);
  for (std::size_t c = 0; c < 4; ++c) {
    for (std::size_t i = 0; i < recording.cameras.size(); ++i) {
      if (const auto& pixel = recording.cameras[i].sightings.corners[c])
        corners.observations.push_back({i, c, *pixel});
    }
  }
  bundle::triangulatePoints(&corners, options.maximum_error);
  const square::Corners nominal = recording.square->corners(true);
  std::vector<Eigen::Vector3d> from;
  std::vector<Eigen::Vector3d> to;
  for (std::size_t c = 0; c < 4; ++c) {
    if (!corners.points[c])
      continue;
    from.push_back(*corners.points[c]);
    to.push_back(nominal[c]);
  }
  if (from.size() < 3)
    throw WaveError("two cameras agree on only " + counted(from.size(), "corner") +
                    " of the square, but three tell where the world is: capture the corners where "
                    "two cameras see them");
  Eigen::Affine3d similarity = bundle::fitSimilarity(from, to);
  double side = 0.0;
  double error = 0.0;
  for (std::size_t k = 0; k < from.size(); ++k) {
    error = std::max(error, (similarity * from[k] - to[k]).norm());
    side = std::max(side, (to[k] - to[0]).norm());
  }
  const double kLargestShare = 0.15;
  if (error > kLargestShare * side)
    throw WaveContradiction(
        "the corners as the cameras saw them do not have the shape of the square: check its "
        "sides and the order of the corners, and capture them again");
  double height = 0.0;
  for (const geometry::Camera& camera : wave->cameras)
    height += (similarity * camera.center()).z();
  // All cameras are above the floor, as the LED is: with z down it has the opposite height.
  result->z_up = height > 0.0;
  if (!result->z_up)
    similarity.translation().z() -= 2.0 * recording.square->led_height;
  bundle::transform(similarity, wave);
  result->metric = true;
}

}  // namespace

StartPoses startPoses(const Recording& recording, const WaveOptions& options, int attempt) {
  bundle::Options rough;
  rough.maximum_error = kTolerances[attempt % 2];
  rough.loss_scale = 3.0;
  rough.minimum_common_points = kLeastCommon;

  StartPoses result;
  bundle::Reconstruction wave;
  std::vector<square::CameraSightings> sightings;
  for (const CameraRecording& recorded : recording.cameras) {
    const square::CameraSightings& camera = recorded.sightings;
    wave.placed.push_back(recording.square && camera.cornersSeen() == 4);
    if (wave.placed.back())
      sightings.push_back(camera);
    wave.cameras.push_back(camera.camera());
  }
  if (sightings.size() < 2)
    wave.placed.assign(recording.cameras.size(), false);

  wave.observations = commonViews(recording, attempt);
  connectCameras(recording, attempt, wave.placed, &wave.observations);
  wave.points.resize(wave.observations.empty() ? 0 : wave.observations.back().point + 1);
  try {
    if (sightings.size() >= 2) {
      startFromSquare(*recording.square, sightings, options.uncertainty, rough, &wave, &result);
    } else {
      wave = bundle::solve(wave, rough);
      if (recording.square)
        moveOnSquare(recording, rough, &wave, &result);
    }
  } catch (const bundle::BundleError& error) {
    throw WaveContradiction(std::string("the wave does not tell where the cameras stand: ") +
                            error.what());
  }
  result.cameras = wave.cameras;
  return result;
}

}  // namespace wiimote_tracker::wave
