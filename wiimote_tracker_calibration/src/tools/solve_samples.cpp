// solve_samples: solves what calibration/save_samples wrote, without the node.

#include "../ros/parameters.h"
#include "session/session_file.h"
#include "session/solve_session.h"

#include <wiimote_tracker_triangulation/geometry/rig_file.h>
#include <wiimote_tracker_triangulation/ros/parameter_file.h>

#include <CLI/CLI.hpp>

#include <cstdio>
#include <ctime>
#include <exception>
#include <string>

namespace {

using namespace wiimote_tracker;

struct Arguments {
  std::string samples;
  std::string params;
  std::string rig;
  std::string method;
  std::string ray_model;
  bool without_gravity = false;
  bool correct_principal_points = false;
};

void addTo(CLI::App* app, Arguments* arguments) {
  app->add_option("FILE", arguments->samples, "File that save_samples wrote")->required();
  app->add_option("--params", arguments->params,
                  "Parameters of the node, a file like config/calibration.yaml (default: their "
                  "defaults); the options below override it");
  app->add_option("--rig", arguments->rig, "Write the rig to this file");
  app->add_option("--method", arguments->method, "How to solve a square without a wave")
      ->check(CLI::IsMember({"joint", "per_camera"}));
  app->add_option("--ray-model", arguments->ray_model, "Camera model of the rays")
      ->check(CLI::IsMember({"calibrated", "image_center"}));
  app->add_flag("--without-gravity", arguments->without_gravity, "Do not use the accelerometers");
  app->add_flag("--correct-principal-points", arguments->correct_principal_points,
                "Correct the principal points as the paper does");
}

session::SolveOptions optionsOf(const Arguments& arguments) {
  session::SolveOptions options;
  if (!arguments.params.empty())
    options = readParameters(ParameterReader(readParameterTree(arguments.params))).solve;
  if (!arguments.method.empty())
    options.square.method =
        arguments.method == "joint" ? square::Method::kJoint : square::Method::kPerCamera;
  if (!arguments.ray_model.empty())
    options.ray_model = arguments.ray_model == "calibrated" ? geometry::RayModel::kCalibrated
                                                            : geometry::RayModel::kImageCenter;
  options.use_gravity = options.use_gravity && !arguments.without_gravity;
  options.correct_principal_points =
      options.correct_principal_points || arguments.correct_principal_points;
  return options;
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
  CLI::App app("Solves what calibration/save_samples wrote, and prints the verdict.");
  Arguments arguments;
  addTo(&app, &arguments);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    session::Solution solution =
        session::solveSession(session::readSessionFile(arguments.samples), optionsOf(arguments));
    print(solution);
    if (!arguments.rig.empty()) {
      solution.rig.solved_at = static_cast<double>(std::time(nullptr));
      geometry::writeRigFile(solution.rig, arguments.rig);
    }
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
