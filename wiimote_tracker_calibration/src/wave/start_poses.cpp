#include "steps.h"

#include "bundle/start.h"
#include "capture/views.h"
#include "wave/error.h"
#include "wiimote_tracker_calibration/bundle/similarity.h"
#include "wiimote_tracker_calibration/bundle/solve.h"
#include "wiimote_tracker_calibration/square/solve_square.h"

#include <wiimote_tracker_msgs/text.h>
#include <wiimote_tracker_triangulation/geometry/shared_views.h>

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::wave {

namespace {

// The views are compared at so many times or more, at most this far apart [s].
constexpr double kInstants = 400.0;
constexpr double kLongestStep = 0.05;
// Of these, so many that two cameras share suffice. More do not make the start better, only slower.
constexpr std::size_t kEnough = 200;
// Errors of pixels due to lenses off by several per cent and clocks by milliseconds; attempts
// alternate [px].
constexpr double kTolerances[] = {6.0, 12.0};
// Shift of the instants of the next attempt, in steps.
constexpr double kShift = 0.29;
// Times that two cameras must share for a relative pose: at most 1.5 s, less than coverage.cpp asks
// of a wave, since an image with a stray spot does not count here.
constexpr std::size_t kLeastCommon = 30;

/// One point per image: the LED's spot, or the middle between the wand's.
std::vector<capture::Spot> middlesOf(const std::vector<Frame>& frames, bool wand) {
  std::vector<capture::Spot> middles;
  for (const Frame& frame : frames) {
    if (frame.spots.size() == (wand ? 2U : 1U))
      middles.push_back({frame.stamp, 0.5 * (frame.spots.front() + frame.spots.back())});
  }
  return middles;
}

/// What the cameras saw at common times, each of which is one point.
bundle::Reconstruction viewsAtInstants(const Recording& recording, int attempt) {
  bundle::Reconstruction all;
  std::vector<std::vector<capture::Spot>> middles;
  for (const CameraRecording& camera : recording.cameras) {
    all.cameras.push_back(camera.sightings.camera());
    middles.push_back(middlesOf(camera.frames, recording.wand.has_value()));
  }
  const auto [start, end] = recording.span();
  const double step = std::min(kLongestStep, (end - start) / kInstants);
  for (double time = start + std::fmod(0.5 + kShift * attempt, 1.0) * step; time < end;
       time += step) {
    for (std::size_t c = 0; c < middles.size(); ++c) {
      if (const auto view = capture::viewAt(c, middles[c], time))
        all.observations.push_back({c, all.points.size(), view->pixel});
    }
    all.points.emplace_back();
  }
  return bundle::thinned(all, kEnough);
}

/// @throws WaveError: the cameras form groups that neither common views nor the square connect.
void requireConnected(const bundle::Reconstruction& views,
                      const std::vector<bool>& connected_by_square) {
  const bundle::NormalizedViews seen = bundle::normalize(views);
  std::vector<std::vector<std::size_t>> partners(seen.size());
  for (std::size_t i = 0; i < seen.size(); ++i) {
    for (std::size_t j = i + 1; j < seen.size(); ++j) {
      if (bundle::commonViews(seen[i], seen[j]).first.size() < kLeastCommon &&
          !(connected_by_square[i] && connected_by_square[j]))
        continue;
      partners[i].push_back(j);
      partners[j].push_back(i);
    }
  }
  const std::vector<std::vector<std::size_t>> groups = geometry::groupsOf(partners);
  if (groups.size() == 1)
    return;
  const auto largest =
      std::max_element(groups.begin(), groups.end(),
                       [](const auto& a, const auto& b) { return a.size() < b.size(); });
  // The name of a camera outside the largest group helps most.
  const std::size_t outside = groups[largest == groups.begin() ? 1 : 0].front();
  throw WaveError(views.cameras[outside].name +
                  " and the other cameras hardly ever saw the LED at the same time: wave where it "
                  "and another camera see the LED together");
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
/// @returns whether z points up.
bool startFromSquare(const square::SquareLayout& layout,
                     const std::vector<square::CameraSightings>& sightings,
                     const square::Uncertainty& uncertainty,
                     const bundle::Options& options,
                     bundle::Reconstruction* wave) {
  square::SolveOptions square_options;
  square_options.uncertainty = uncertainty;
  const square::Solution solution = square::solveSquare(layout, sightings, square_options);
  for (geometry::Camera& camera : wave->cameras) {
    if (const geometry::RigCamera* solved = solution.rig.find(camera.name))
      camera = solved->camera;
  }
  placeRest(options, wave);
  return solution.z_up;
}

/// Aligns a reconstruction, known up to a similarity, with the corners that two cameras saw.
/// @returns whether z points up.
bool moveOnSquare(const Recording& recording,
                  const bundle::Options& options,
                  bundle::Reconstruction* wave) {
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
  const bool z_up = height > 0.0;
  if (!z_up)
    similarity.translation().z() -= 2.0 * recording.square->led_height;
  bundle::transform(similarity, wave);
  return z_up;
}

}  // namespace

StartPoses startPoses(const Recording& recording, const WaveOptions& options, int attempt) {
  bundle::Options rough;
  rough.maximum_error = kTolerances[attempt % 2];
  rough.loss_scale = 3.0;
  rough.minimum_common_points = kLeastCommon;

  StartPoses result;
  bundle::Reconstruction wave = viewsAtInstants(recording, attempt);
  std::vector<square::CameraSightings> sightings;
  for (const CameraRecording& recorded : recording.cameras) {
    const square::CameraSightings& camera = recorded.sightings;
    wave.placed.push_back(recording.square && camera.cornersSeen() == 4);
    if (wave.placed.back())
      sightings.push_back(camera);
  }
  result.from_square = sightings.size() >= 2;
  if (!result.from_square)
    wave.placed.assign(recording.cameras.size(), false);
  requireConnected(wave, wave.placed);
  try {
    if (result.from_square) {
      result.z_up =
          startFromSquare(*recording.square, sightings, options.uncertainty, rough, &wave);
    } else {
      wave = bundle::solve(wave, rough);
      if (recording.square)
        result.z_up = moveOnSquare(recording, rough, &wave);
    }
  } catch (const bundle::BundleError& error) {
    throw WaveContradiction(std::string("the wave does not tell where the cameras stand: ") +
                            error.what());
  }
  result.cameras = wave.cameras;
  return result;
}

}  // namespace wiimote_tracker::wave
