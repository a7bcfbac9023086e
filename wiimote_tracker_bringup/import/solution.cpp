#include "solution.h"

#include "wiimote_tracker_calibration/import/pinhole.h"
#include "wiimote_tracker_calibration/import/recording.h"

#include "wiimote_tracker_calibration/bundle/similarity.h"
#include "wiimote_tracker_calibration/bundle/solve.h"
#include "wiimote_tracker_calibration/bundle/statistics.h"

#include <wiimote_tracker_msgs/text.h>

#include <algorithm>

namespace wiimote_tracker::import {

namespace {

using bundle::Reconstruction;

bool hasCenters(const Recording& recording) {
  return std::all_of(recording.cameras.begin(), recording.cameras.end(),
                     [](const RecordedCamera& camera) { return camera.center.has_value(); });
}

void alignToCenters(const Recording& recording, Reconstruction* reconstruction) {
  std::vector<Eigen::Vector3d> from;
  std::vector<Eigen::Vector3d> to;
  for (std::size_t i = 0; i < recording.cameras.size(); ++i) {
    from.push_back(reconstruction->cameras[i].center());
    to.push_back(*recording.cameras[i].center);
  }
  try {
    bundle::transform(bundle::fitSimilarity(from, to), reconstruction);
  } catch (const bundle::BundleError& error) {
    throw ImportError(std::string("the shipped camera centres give no frame: ") + error.what() +
                      "; remove Cst.dat or original_cam_centers.dat to ignore them");
  }
}

/// The residuals are as measured, to compare them with those of others: smaller than the noise,
/// since the points were fitted to it. Those of a wave are corrected for that.
geometry::Rig rigOf(const Reconstruction& reconstruction, const std::string& method) {
  geometry::Rig rig = bundle::rigOf(reconstruction);
  rig.method = method;
  const bundle::Statistics all = bundle::statistics(reconstruction);
  rig.verdict = format(
      "%zu of %zu observations fit; their reprojection error: median %.2f px, mean %.2f "
      "px, RMS %.2f px",
      all.inliers, all.observations, all.median, all.mean, all.rms);
  if (!reconstruction.converged)
    rig.verdict += "; the adjustment did not converge: check the intrinsics and the frame numbers";
  return rig;
}

/// Uses the shipped projection matrices.
Solution fromProjections(const Recording& recording) {
  const ShippedCameras shipped = shippedCameras(recording, bundle::Options());
  Reconstruction best = shipped.reconstruction;
  Solution solution;
  solution.frames = shipped.frames;
  if (hasCenters(recording))
    alignToCenters(recording, &best);
  solution.rig = rigOf(best, "import: shipped projection matrices");
  if (!recording.points.empty()) {
    Reference& reference = solution.reference.emplace();
    reference.rig = solution.rig;
    reference.points.assign(recording.points.begin(), recording.points.end());
  }
  return solution;
}

/// The best fit with the shipped centres: orientations and points are adjusted.
Reference withShippedCenters(const Recording& recording, Reconstruction start) {
  for (std::size_t i = 0; i < start.cameras.size(); ++i)
    start.cameras[i].world_from_camera.translation() = *recording.cameras[i].center;
  bundle::Options options;
  options.maximum_error = 100.0;  // keeps all inliers of our solution, for comparison
  options.fixed_positions = true;
  bundle::triangulatePoints(&start, options.maximum_error);
  bundle::adjust(&start, options);
  Reference reference;
  reference.rig = rigOf(start, "import: shipped centres, orientations fitted");
  reference.points = start.points;
  return reference;
}

Solution fromPixels(const Recording& recording) {
  Reconstruction solved = bundle::solve(observedBy(recording), bundle::Options());
  Solution solution;
  solution.frames = recording.frames;
  if (hasCenters(recording)) {
    alignToCenters(recording, &solved);
    solution.reference = withShippedCenters(recording, solved);
  }
  solution.rig = rigOf(solved, "import: poses solved, intrinsics shipped");
  return solution;
}

}  // namespace

Solution solve(const Recording& recording) {
  try {
    return recording.cameras.front().projection ? fromProjections(recording)
                                                : fromPixels(recording);
  } catch (const bundle::BundleError& error) {
    throw ImportError(std::string("the cameras cannot be solved: ") + error.what());
  }
}

}  // namespace wiimote_tracker::import
