// Solves what calibration/save_samples wrote, without the node.

#include "../ros/parameters.h"
#include "wiimote_tracker_calibration/session/session_file.h"
#include "wiimote_tracker_calibration/session/solve_session.h"

#include <wiimote_tracker_triangulation/geometry/rig_file.h>
#include <wiimote_tracker_triangulation/ros/parameter_file.h>

#include <cstdio>
#include <ctime>
#include <stdexcept>
#include <string>

namespace {

using namespace wiimote_tracker;

const char* const kUsage =
    "usage: solve_samples FILE [--params YAML] [--rig OUT] [--method joint|per_camera]\n"
    "                     [--without-gravity] [--correct-principal-points]\n"
    "                     [--ray-model calibrated|image_center]\n"
    "Solves what calibration/save_samples wrote, and prints the verdict. --params: the node's "
    "parameters,\n"
    "a file like config/calibration.yaml; without it their defaults. What is said behind it goes "
    "before it.\n"
    "--rig writes the rig file.\n";

struct Arguments {
  std::string samples;
  std::string rig;
  session::SolveOptions options;
};

/// One of two words. @throws std::invalid_argument.
bool isSecond(const std::string& option,
              const std::string& word,
              const std::string& first,
              const std::string& second) {
  if (word != first && word != second)
    throw std::invalid_argument(option + " is '" + word + "', but must be " + first + " or " +
                                second);
  return word == second;
}

Arguments argumentsOf(int argc, char** argv) {
  Arguments arguments;
  for (int i = 1; i < argc; ++i) {
    const std::string option = argv[i];
    const auto value = [&] {
      if (i + 1 == argc)
        throw std::invalid_argument(option + " needs a value");
      return std::string(argv[++i]);
    };
    if (option == "--rig")
      arguments.rig = value();
    else if (option == "--params")
      arguments.options = readParameters(readParameterTree(value())).solve;
    else if (option == "--method")
      arguments.options.square.method = isSecond(option, value(), "joint", "per_camera")
                                            ? square::Method::kPerCamera
                                            : square::Method::kJoint;
    else if (option == "--without-gravity")
      arguments.options.use_gravity = false;
    else if (option == "--correct-principal-points")
      arguments.options.correct_principal_points = true;
    else if (option == "--ray-model")
      arguments.options.ray_model = isSecond(option, value(), "calibrated", "image_center")
                                        ? geometry::RayModel::kImageCenter
                                        : geometry::RayModel::kCalibrated;
    else if (arguments.samples.empty() && option.compare(0, 1, "-") != 0)
      arguments.samples = option;
    else
      throw std::invalid_argument("'" + option + "' is not understood");
  }
  if (arguments.samples.empty())
    throw std::invalid_argument("name the file of samples");
  return arguments;
}

void print(const session::Solution& solution) {
  const session::Verdict& verdict = solution.verdict;
  std::printf("%s\n\n", verdict.text.c_str());
  std::printf("%-20s %9s %9s %8s %10s %10s %9s %9s %9s %9s\n", "camera", "residual", "", "inliers",
              "rotation", "position", "focal", "centre", "k1", "offset");
  std::printf("%-20s %9s %9s %8s %10s %10s %9s %9s %9s %9s\n", "", "[px]", "[mm]", "[%]", "[mrad]",
              "[mm]", "[px]", "[px]", "", "[ms]");
  for (const session::CameraVerdict& camera : verdict.cameras)
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
  if (solution.trace)
    std::printf("\n%s", principal_point::table(*solution.trace).c_str());
  std::printf("\nrig %s\n", solution.rig.id().c_str());
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const Arguments arguments = argumentsOf(argc, argv);
    session::Solution solution =
        session::solveSession(session::readSessionFile(arguments.samples), arguments.options);
    print(solution);
    if (!arguments.rig.empty()) {
      solution.rig.solved_at = static_cast<double>(std::time(nullptr));
      geometry::writeRigFile(solution.rig, arguments.rig);
    }
    return 0;
  } catch (const std::invalid_argument& error) {
    std::fprintf(stderr, "%s\n%s", error.what(), kUsage);
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
