// solve_samples: solves what calibration/save_samples wrote, without the node.

#include "samples/solve_samples.h"
#include "../ros/parameters.h"
#include "samples/samples_file.h"

#include <wiimote_tracker_msgs/argument_parser.h>
#include <wiimote_tracker_triangulation/geometry/rig_file.h>
#include <wiimote_tracker_triangulation/ros/parameter_file.h>

#include <cstdio>
#include <ctime>
#include <string>

namespace {

using namespace wiimote_tracker;

void print(const samples::Solution& solution) {
  const samples::Verdict& verdict = solution.verdict;
  std::printf("%s\n\n", verdict.text.c_str());
  std::printf("%-20s %9s %9s %8s %10s %10s %9s %9s %9s %9s\n", "camera", "residual", "", "inliers",
              "rotation", "position", "focal", "centre", "k1", "offset");
  std::printf("%-20s %9s %9s %8s %10s %10s %9s %9s %9s %9s\n", "", "[px]", "[mm]", "[%]", "[mrad]",
              "[mm]", "[px]", "[px]", "", "[ms]");
  for (const samples::CameraVerdict& camera : verdict.cameras)
    std::printf("%-20s %9.3f %9.2f %8.1f %10.3f %10.2f %9.2f %9.2f %9.4f %9.3f\n",
                camera.name.c_str(), camera.residual_px, 1e3 * camera.residual_m,
                100.0 * camera.inlier_share, 1e3 * camera.rotation_stddev,
                1e3 * camera.position_stddev, camera.focal_stddev, camera.principal_point_stddev,
                camera.k1_stddev, 1e3 * camera.time_offset_stddev);
  if (!verdict.predicted_at.empty())
    std::printf("\n%-28s %s\n", "place [m]", "known to [mm]");
  for (std::size_t i = 0; i < verdict.predicted_at.size(); ++i)
    std::printf("%8.3f %8.3f %8.3f   %8.1f\n", verdict.predicted_at[i].x(),
                verdict.predicted_at[i].y(), verdict.predicted_at[i].z(),
                1e3 * verdict.predicted_stddev[i]);
  if (verdict.next)
    std::printf("next: %s\n", verdict.next->text.c_str());
  if (solution.trace)
    std::printf("\n%s", principal_point::table(*solution.trace).c_str());
  std::printf("\nrig %s\n", solution.rig.id().c_str());
}

}  // namespace

int main(int argc, char** argv) {
  std::string file, params, rig;
  ArgumentParser parser("solve_samples",
                        "Solves FILE, which calibration/save_samples wrote, and prints the "
                        "verdict.");
  parser.positional("FILE", &file);
  parser.option("--params FILE", &params,
                "parameters of the node, a file like config/calibration.yaml, or one for "
                "parameters:= of tracker.launch (default: their defaults)");
  parser.option("--rig FILE", &rig, "write the rig to this file");
  return parser.run(argc, argv, [&] {
    const ParameterTree parameters = readParameterTree(params, "calibration");
    samples::Solution solution = samples::solveSamples(
        samples::readSamplesFile(file), readParameters(ParameterReader(parameters)).solve);
    print(solution);
    if (!rig.empty()) {
      solution.rig.solved_at = static_cast<double>(std::time(nullptr));
      geometry::writeRigFile(solution.rig, rig);
    }
    return 0;
  });
}
