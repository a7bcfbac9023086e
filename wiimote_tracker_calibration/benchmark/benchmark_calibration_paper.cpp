#include "benchmark_calibration_sections.h"
#include "paper_procedure.h"

#include <wiimote_tracker_triangulation/geometry/error.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace wiimote_tracker {

namespace {

using namespace principal_point;

const Eigen::Vector2d kStart(535.0, 401.7);  // Principal point of the default intrinsics [px].

BenchmarkRow rowOf(const std::string& name, PaperSession session, int runs) {
  double before = 0.0;
  double after = 0.0;
  double worst = 0.0;
  double origin = 0.0;
  double moved = 0.0;
  int solved = 0;
  int lost = 0;
  for (int seed = 1; seed <= runs; ++seed) {
    session.seed = static_cast<std::uint64_t>(seed);
    try {
      const PaperResult result = runPaperSession(session);
      ++solved;
      before += result.before;
      after += result.after;
      worst = std::max(worst, result.after);
      const Round& last = result.correction.trace.rounds.back();
      origin += last.origin_error;
      for (const Eigen::Vector2d& point : last.principal_points)
        moved = std::max(moved, (point - kStart).norm());
      lost += result.correction.lost;
    } catch (const geometry::Error&) {
      // Counted below.
    }
  }
  return {name,
          {{"before", 100.0 * before / solved},
           {"after", 100.0 * after / solved},
           {"worst", 100.0 * worst},
           {"origin", 100.0 * origin / solved},
           {"moved px", moved},
           {"lost", lost},
           {"refused", runs - solved}}};
}

void runPaper(int runs, const RowCallback& row) {
  const std::vector<std::pair<std::string, std::vector<std::size_t>>> rigs = {
      {"2 adjacent", {0, 1}}, {"2 diagonal", {0, 2}}, {"4 cameras", {0, 1, 2, 3}}};
  for (const auto& [name, cameras] : rigs) {
    PaperSession session;
    session.cameras = cameras;
    row(rowOf(name + ", calibrated", session, runs));
    session.correction.ray_model = geometry::RayModel::kImageCenter;
    row(rowOf(name + ", image_center", session, runs));
    session.correction.points = Points::kAllCorners;
    row(rowOf(name + ", image_center, all corners", session, runs));
    session.correction.points = Points::kOrigin;
    session.correction.method = geometry::TriangulationMethod::kLeastSquares;
    row(rowOf(name + ", image_center, least squares", session, runs));
    session.correction.method = geometry::TriangulationMethod::kMeanClosest;
    session.correction.step = -0.25;
    row(rowOf(name + ", image_center, wrong sign", session, runs));
    session.correction.step = 0.25;
    session.correction.virtual_hfov = 41.0 * M_PI / 180.0;
    row(rowOf(name + ", image_center, 41 degrees", session, runs));
  }
}

}  // namespace

BenchmarkSection paperSection() {
  return {
      "paper",
      "the paper's procedure: each camera solved alone from the square with K (2), true principal "
      "points 512, 384 +- 5 px, focal lengths +- 1 %, corners +- 5 mm. Mean error of the paper's "
      "ten points [cm]: before the principal point correction, after 14 rounds, in the worst "
      "session; error of the origin after it [cm]; farthest that a principal point was moved [px]; "
      "sessions in which the correction lost the rig; refused sessions. The paper reports, for two "
      "cameras, 15-50 before and 0-7 after; for four, 2.8 (C3), 8.5 (C4) and below 4.8 (C5) after.",
      runPaper};
}

}  // namespace wiimote_tracker
