#include "steps.h"

#include "start.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace wiimote_tracker::bundle {

namespace {

// Prior of the focal length of a start, relative: other focal lengths, a factor of 1.4 apart, have
// starts of their own.
constexpr double kFocalOfStart = 0.2;

Options roughly(const Options& options) {
  Options rough = options;
  rough.rough = true;
  rough.lens.focal_length = kFocalOfStart;
  rough.lens.focal_about = 0.0;
  return rough;
}

/// Mean over the observations of points that two placed cameras saw.
double costOf(const Reconstruction& reconstruction, double maximum_error) {
  std::vector<int> views(reconstruction.points.size(), 0);
  for (const Observation& observation : reconstruction.observations)
    views[observation.point] += reconstruction.placed[observation.camera] ? 1 : 0;
  const double worst = std::pow(2.0 * maximum_error, 2);
  double sum = 0.0;
  std::size_t count = 0;
  for (const Observation& observation : reconstruction.observations) {
    if (!reconstruction.placed[observation.camera] || views[observation.point] < 2)
      continue;
    const auto error = reprojectionError(reconstruction, observation);
    sum += error ? std::min(*error * *error, worst) : worst;
    ++count;
  }
  return count == 0 ? std::numeric_limits<double>::infinity() : sum / static_cast<double>(count);
}

/// Lenses to try for a camera that is added: the others' if all have the same, else each focal
/// length.
std::vector<geometry::Intrinsics> lensesToTry(const SelfCalibrationOptions& options,
                                              const geometry::Intrinsics& present) {
  if (options.bundle.one_lens)
    return {present};
  std::vector<geometry::Intrinsics> lenses;
  for (const double focal_length : options.focal_lengths)
    lenses.push_back(guessedLens(present.width, present.height, focal_length));
  return lenses;
}

}  // namespace

geometry::Intrinsics guessedLens(int width, int height, double focal_length) {
  geometry::Intrinsics lens;
  lens.width = width;
  lens.height = height;
  lens.fx = lens.fy = focal_length * width;
  lens.cx = 0.5 * (width - 1);
  lens.cy = 0.5 * (height - 1);
  lens.distortion = {};
  return lens;
}

void adjustPlaced(const Options& options, double maximum_error, Attempt* attempt) {
  Options now = options;
  now.maximum_error = maximum_error;
  triangulatePoints(&attempt->reconstruction, maximum_error, attempt->reconstruction.placed);
  adjust(&attempt->reconstruction, now);
  attempt->cost = costOf(attempt->reconstruction, options.maximum_error);
}

Attempt attemptPair(const Reconstruction& observed,
                    const CameraPair& pair,
                    const Options& options) {
  Attempt attempt;
  attempt.reconstruction = observed;
  attempt.reconstruction.placed.assign(observed.cameras.size(), false);
  if (!placePair(options, pair, &attempt.reconstruction))
    return attempt;
  try {
    adjustPlaced(roughly(options), kStartTolerance * options.maximum_error, &attempt);
  } catch (const BundleError&) {
    // The cost stays infinite.
  }
  return attempt;
}

void grow(const SelfCalibrationOptions& options, std::size_t camera_count, Attempt* attempt) {
  Reconstruction& reconstruction = attempt->reconstruction;
  const Options rough = roughly(options.bundle);
  std::vector<bool>& placed = reconstruction.placed;
  while (static_cast<std::size_t>(std::count(placed.begin(), placed.end(), true)) < camera_count) {
    const std::size_t next = nextToResect(rough, reconstruction);
    geometry::Camera best;
    std::size_t most = 0;
    std::string reason;
    for (const geometry::Intrinsics& lens :
         lensesToTry(options, reconstruction.cameras[next].intrinsics)) {
      reconstruction.cameras[next].intrinsics = lens;
      try {
        const std::size_t inliers = resect(rough, next, &reconstruction);
        if (inliers > most) {
          most = inliers;
          best = reconstruction.cameras[next];
        }
      } catch (const BundleError& error) {
        reason = error.what();
      }
    }
    if (most == 0)
      throw BundleError(reason);
    reconstruction.cameras[next] = best;
    adjustPlaced(rough, kStartTolerance * options.bundle.maximum_error, attempt);
  }
}

}  // namespace wiimote_tracker::bundle
