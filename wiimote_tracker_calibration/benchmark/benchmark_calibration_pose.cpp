#include "benchmark_calibration_sections.h"

#include "pose_trial.h"

#include <cmath>
#include <ctime>

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
        geometry::Intrinsics(), bin * kBinWidth, (bin + 1) * kBinWidth, poses, bin + 1));
  geometry::Intrinsics distorting;
  distorting.distortion = {-0.12, 0.03, 0.001, -0.002, 0.0};
  row(tiltRow("tilt 0 to 75 degrees, lens with distortion", distorting, 0.0, kBins * kBinWidth,
              poses, kBins + 1));
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

}  // namespace wiimote_tracker
