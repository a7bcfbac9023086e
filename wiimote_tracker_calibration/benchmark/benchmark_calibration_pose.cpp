#include "benchmark_calibration_sections.h"

#include "pose_trial.h"

#include "adjust/opencv.h"

#include <opencv2/calib3d.hpp>

#include <cmath>
#include <ctime>
#include <functional>
#include <optional>

namespace wiimote_tracker {

namespace {

using Random = std::mt19937_64;

constexpr double kDegree = M_PI / 180.0;
constexpr int kPosesPerRun = 1000;  // of one tilt bin
constexpr int kBins = 5;
constexpr double kBinWidth = 15.0 * kDegree;
constexpr int kStarts = 12;
constexpr int kBatch = 500;  // poses timed together

std::vector<PoseTrial> drawBatch(Random& random,
                                 const geometry::Intrinsics& lens,
                                 double least_tilt,
                                 double most_tilt) {
  std::vector<PoseTrial> trials;
  for (int i = 0; i < kBatch; ++i)
    trials.push_back(drawPoseTrial(random, lens, least_tilt, most_tilt));
  return trials;
}

/// Of the processor since `start` [s].
double since(std::clock_t start) {
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

BenchmarkRow tiltRow(const std::string& name,
                     const geometry::Intrinsics& lens,
                     double least_tilt,
                     double most_tilt,
                     int poses,
                     std::uint64_t seed) {
  Random random(seed);
  PoseTally tally;
  double seconds = 0.0;
  std::vector<square::PlanarPoses> found(kBatch);
  while (tally.poses < poses) {
    const std::vector<PoseTrial> trials = drawBatch(random, lens, least_tilt, most_tilt);
    const std::clock_t start = std::clock();
    for (std::size_t i = 0; i < trials.size(); ++i)
      found[i] = square::planarPoses(lens, trials[i].pixels, trials[i].corners);
    seconds += since(start);
    for (std::size_t i = 0; i < trials.size(); ++i)
      tally.add(trials[i], found[i], multiStartPoses(trials[i], kStarts, random));
  }
  return {name,
          {{"poses", tally.poses},
           {"judged", tally.judged},
           {"whitened", tally.whitened()},
           {"worst", tally.worst_excess},
           {"wrong", tally.wrong},
           {"wrong_ml", tally.wrong_multi_start},
           {"two", tally.two},
           {"two_ml", tally.two_multi_start},
           {"missed", tally.missed},
           {"us", 1e6 * seconds / poses}}};
}

void runTilts(int runs, const RowCallback& row) {
  const int poses = kPosesPerRun * runs;
  for (int bin = 0; bin < kBins; ++bin)
    row(tiltRow(
        "tilt " + std::to_string(15 * bin) + " to " + std::to_string(15 * bin + 15) + " degrees",
        geometry::Intrinsics(), bin * kBinWidth, (bin + 1) * kBinWidth, poses,
        static_cast<std::uint64_t>(bin + 1)));
  geometry::Intrinsics distorting;
  distorting.distortion = {-0.12, 0.03, 0.001, -0.002, 0.0};
  row(tiltRow("tilt 0 to 75 degrees, lens with distortion", distorting, 0.0, kBins * kBinWidth,
              poses, kBins + 1));
}

/// Camera from square, or nothing when the method fails.
using Solver = std::function<std::optional<Eigen::Isometry3d>(const PoseTrial&)>;

std::optional<Eigen::Isometry3d> solveWithOpenCv(const PoseTrial& trial, int method) {
  // SOLVEPNP_IPPE_SQUARE wants the corners in this order.
  static const std::array<std::size_t, 4> order = {3, 2, 1, 0};
  std::vector<cv::Point3d> corners;
  std::vector<cv::Point2d> pixels;
  for (const std::size_t c : order) {
    corners.emplace_back(trial.corners[c].x(), trial.corners[c].y(), trial.corners[c].z());
    pixels.emplace_back(trial.pixels[c].x(), trial.pixels[c].y());
  }
  const geometry::Intrinsics& lens = trial.truth.intrinsics;
  const cv::Matx33d matrix(lens.fx, 0.0, lens.cx, 0.0, lens.fy, lens.cy, 0.0, 0.0, 1.0);
  cv::Mat rotation;
  cv::Mat translation;
  try {
    if (!cv::solvePnP(corners, pixels, matrix, cv::noArray(), rotation, translation, false, method))
      return std::nullopt;
  } catch (const cv::Exception&) {
    return std::nullopt;
  }
  const Eigen::Isometry3d camera_from_world = adjust::poseFromCv(rotation, translation);
  if (!camera_from_world.matrix().allFinite())
    return std::nullopt;
  return camera_from_world.inverse();
}

struct Method {
  std::string name;
  Solver solve;
  PoseErrors errors = {};
  double seconds = 0.0;
  int failed = 0;
};

/// All methods on the same poses, one after the other on each batch: their times are those of one
/// machine in one state.
void runMethods(int runs, const RowCallback& row) {
  std::vector<Method> methods;
  methods.push_back({"this package, both branches", [](const PoseTrial& trial) {
                       const auto poses =
                           square::planarPoses(trial.truth.intrinsics, trial.pixels, trial.corners);
                       return poses.empty() ? std::nullopt
                                            : std::optional(poses[0].world_from_camera);
                     }});
  const std::vector<std::pair<std::string, int>> opencv = {
    {"ITERATIVE", cv::SOLVEPNP_ITERATIVE},
    {"EPNP", cv::SOLVEPNP_EPNP},
    {"P3P", cv::SOLVEPNP_P3P},
    {"AP3P", cv::SOLVEPNP_AP3P},
    {"IPPE", cv::SOLVEPNP_IPPE},
    {"IPPE_SQUARE", cv::SOLVEPNP_IPPE_SQUARE},
#if CV_VERSION_MAJOR > 4 || (CV_VERSION_MAJOR == 4 && CV_VERSION_MINOR >= 5)
    {"SQPNP", cv::SOLVEPNP_SQPNP},
#endif
  };
  for (const auto& [name, method] : opencv)
    methods.push_back({"cv::solvePnP " + name, [flag = method](const PoseTrial& trial) {
                         return solveWithOpenCv(trial, flag);
                       }});

  Random random(kBins + 2);
  const int poses = kPosesPerRun * runs;
  std::vector<std::optional<Eigen::Isometry3d>> found(kBatch);
  for (int done = 0; done < poses; done += kBatch) {
    const auto trials = drawBatch(random, geometry::Intrinsics(), 0.0, kBins * kBinWidth);
    std::vector<std::vector<square::PlanarPose>> minima;
    for (const PoseTrial& trial : trials)
      minima.push_back(multiStartPoses(trial, kStarts, random));
    for (Method& method : methods) {
      const std::clock_t start = std::clock();
      for (std::size_t i = 0; i < trials.size(); ++i)
        found[i] = method.solve(trials[i]);
      method.seconds += since(start);
      for (std::size_t i = 0; i < trials.size(); ++i) {
        if (found[i])
          method.errors.add(trials[i], minima[i], *found[i]);
        else
          ++method.failed;
      }
    }
  }
  for (const Method& method : methods)
    row({method.name,
         {{"us", 1e6 * method.seconds / poses},
          {"whitened", method.errors.whitened()},
          {"wrong", method.errors.wrong},
          {"failed", method.failed},
          {"poses", poses}}});
}

}  // namespace

BenchmarkSection poseSection() {
  return {"pose",
          "the pose of a square from its four corners in one image: sides 0.5 to 2.5 m, ranges 4 "
          "to 8 m, 0.5 px of noise; 1000 poses per session. judged: poses whose Cramer-Rao bound "
          "of the rotation is at most 1.5 degrees and whose other branch is absent or worse by 80 "
          "in chi^2; whitened: their RMS error over the bound. Beside a maximum-likelihood "
          "solution from many starts: worst excess of the cost [chi^2]; poses of which the other "
          "branch is the better one, here and there; poses with two branches, here and there; "
          "second branches within 80 in chi^2 that were missed. Processor time per pose [us].",
          runTilts};
}

BenchmarkSection poseMethodsSection() {
  return {"pose_methods",
          "the same square by OpenCV's methods, tilts 0 to 75 degrees, in turns.\n"
          "Processor time per pose [us]; whitened error of the judged poses, 1 is the bound; poses "
          "on the wrong branch; poses without a solution.",
          runMethods};
}

}  // namespace wiimote_tracker
