#include "wiimote_tracker_calibration/principal_point/correction.h"

#include "square/error.h"
#include "wiimote_tracker_calibration/square/solve_square.h"

#include <wiimote_tracker_msgs/text.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace wiimote_tracker::principal_point {

namespace {

/// The sightings of the solved cameras, in the order of the rig. The correction changes their
/// intrinsics.
std::vector<square::CameraSightings> solvedOnes(const std::vector<square::CameraSightings>& cameras,
                                                const geometry::Rig& rig) {
  std::vector<square::CameraSightings> solved;
  for (const geometry::RigCamera& camera : rig.cameras) {
    const auto same = [&](const square::CameraSightings& s) {
      return s.name == camera.camera.name;
    };
    solved.push_back(*std::find_if(cameras.begin(), cameras.end(), same));
  }
  return solved;
}

/// @throws Error: a corner cannot be measured, since fewer than two of the cameras saw it.
void checkCorners(const std::vector<square::CameraSightings>& cameras) {
  for (std::size_t corner = 0; corner < 4; ++corner) {
    const auto seeing = std::count_if(
        cameras.begin(), cameras.end(),
        [corner](const square::CameraSightings& s) { return s.corners[corner].has_value(); });
    if (seeing < 2)
      throw Error("corner " + std::to_string(corner + 1) +
                  " was seen by one camera only, but the principal point correction measures all "
                  "four: capture it again where two cameras see it, or do without the correction");
  }
}

std::optional<Eigen::Vector3d> measure(const std::vector<geometry::Camera>& ray_cameras,
                                       const std::vector<square::CameraSightings>& sightings,
                                       std::size_t corner,
                                       geometry::TriangulationMethod method) {
  std::vector<geometry::Observation> observations;
  for (std::size_t i = 0; i < ray_cameras.size(); ++i) {
    if (sightings[i].corners[corner])
      observations.push_back({&ray_cameras[i], *sightings[i].corners[corner]});
  }
  geometry::TriangulationOptions options;
  options.method = method;
  const auto point = geometry::triangulate(observations, options);
  if (!point)
    return std::nullopt;
  return point->position;
}

/// Measures the corners with the rig. Nothing when one of them cannot be measured or projected.
std::optional<Round> evaluate(const geometry::Rig& rig,
                              const std::vector<square::CameraSightings>& sightings,
                              const square::Corners& ideal,
                              const CorrectionOptions& options) {
  const std::vector<geometry::Camera> ray_cameras = rig.rayCameras();
  Round round;
  for (const geometry::RigCamera& camera : rig.cameras) {
    const geometry::Intrinsics& lens = camera.camera.intrinsics;
    round.principal_points.emplace_back(lens.cx, lens.cy);
    round.differences.emplace_back(Eigen::Vector2d::Zero());
  }
  const std::size_t used = options.points == Points::kOrigin ? 1 : ideal.size();
  double squared = 0.0;
  for (std::size_t corner = 0; corner < ideal.size(); ++corner) {
    const std::optional<Eigen::Vector3d> measured =
        measure(ray_cameras, sightings, corner, options.method);
    if (!measured)
      return std::nullopt;
    const double error = (*measured - ideal[corner]).norm();
    if (corner == 0)
      round.origin_error = error;
    squared += error * error;
    if (corner >= used)
      continue;
    for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
      const geometry::Camera& camera = rig.cameras[i].camera;
      const auto ideal_pixel = camera.project(ideal[corner]);
      const auto measured_pixel = camera.project(*measured);
      if (!ideal_pixel || !measured_pixel)
        return std::nullopt;
      round.differences[i] += (*ideal_pixel - *measured_pixel) / static_cast<double>(used);
    }
  }
  round.corner_error = std::sqrt(squared / static_cast<double>(ideal.size()));
  return round;
}

square::Solution solve(const square::SquareLayout& layout,
                       const std::vector<square::CameraSightings>& cameras,
                       const CorrectionOptions& options) {
  square::Solution solution = square::solveSquare(
      layout, cameras, {square::Method::kPerCamera, options.uncertainty, options.branch_odds});
  solution.rig.ray_model = options.ray_model;
  solution.rig.virtual_hfov = options.virtual_hfov;
  return solution;
}

double errorOf(const Round& round, Points points) {
  return points == Points::kOrigin ? round.origin_error : round.corner_error;
}

std::vector<std::string> warningsOf(const CorrectionOptions& options,
                                    const CorrectionResult& result) {
  std::vector<std::string> warnings;
  if (result.lost)
    warnings.push_back(
        format("the principal point correction was stopped after round %zu, because its next step "
               "led to no usable rig: do without it, and check the starting intrinsics",
               result.trace.rounds.size() - 1));
  const double before = errorOf(result.trace.rounds.front(), options.points);
  const double after = errorOf(result.trace.rounds.back(), options.points);
  if (after > before)
    warnings.push_back(
        format("the principal point correction made the measured corners worse (%ld mm before, "
               "%ld mm after): do without it",
               std::lround(1e3 * before), std::lround(1e3 * after)));
  const bool distorted = std::any_of(
      result.rig.cameras.begin(), result.rig.cameras.end(), [](const geometry::RigCamera& c) {
        const auto& distortion = c.camera.intrinsics.distortion;
        return std::any_of(distortion.begin(), distortion.end(), [](double k) { return k != 0; });
      });
  if (distorted && options.ray_model == geometry::RayModel::kImageCenter)
    warnings.push_back(
        "rays of the image_center model know no distortion, but the lenses have some: the "
        "correction compensates it at its own points only, so use ray_model calibrated");
  return warnings;
}

}  // namespace

std::string table(const Trace& trace) {
  std::string text = "round  origin [mm]  corners [mm]";
  for (const std::string& camera : trace.cameras)
    text += "  " + camera + " cx, cy [px]";
  text += "\n";
  for (std::size_t i = 0; i < trace.rounds.size(); ++i) {
    const Round& round = trace.rounds[i];
    text += format("%5zu  %11.1f  %12.1f", i, 1e3 * round.origin_error, 1e3 * round.corner_error);
    for (std::size_t c = 0; c < round.principal_points.size(); ++c) {
      const int width = static_cast<int>(trace.cameras[c].size()) + 7;
      text += format("  %*.1f, %6.1f", width, round.principal_points[c].x(),
                     round.principal_points[c].y());
    }
    text += "\n";
  }
  return text;
}

CorrectionResult correctPrincipalPoints(const square::SquareLayout& layout,
                                        const std::vector<square::CameraSightings>& cameras,
                                        const CorrectionOptions& options,
                                        const RoundCallback& progress) {
  square::Solution solution = solve(layout, cameras, options);
  std::vector<square::CameraSightings> sightings = solvedOnes(cameras, solution.rig);
  checkCorners(sightings);
  const square::Corners ideal = layout.corners(solution.z_up);

  CorrectionResult result;
  for (const square::CameraSightings& camera : sightings)
    result.trace.cameras.push_back(camera.name);
  std::optional<Round> round = evaluate(solution.rig, sightings, ideal, options);
  if (!round)
    throw Error(
        "the rays of the cameras do not meet at the corners: place the cameras so that they look "
        "at the square from different sides, and check the starting intrinsics");
  result.trace.rounds.push_back(*round);
  for (int done = 0;; ++done) {
    if (progress)
      progress(done);
    const Round& last = result.trace.rounds.back();
    if (done == options.rounds || errorOf(last, options.points) < options.limit)
      break;
    for (std::size_t i = 0; i < sightings.size(); ++i) {
      sightings[i].intrinsics.cx += options.step * last.differences[i].x();
      sightings[i].intrinsics.cy += options.step * last.differences[i].y();
    }
    try {
      const square::Solution next = solve(layout, sightings, options);
      round.reset();
      // One that saw three corners may be left out now.
      if (next.rig.cameras.size() == sightings.size())
        round = evaluate(next.rig, sightings, ideal, options);
      if (round)
        solution = next;
    } catch (const square::SquareError&) {
      round.reset();
    }
    if (!round) {
      result.lost = true;
      break;
    }
    result.trace.rounds.push_back(*round);
  }

  result.rig = solution.rig;
  result.rig.method = "square, per camera, principal points corrected";
  result.z_up = solution.z_up;
  result.warnings = solution.warnings;
  for (const std::string& warning : warningsOf(options, result))
    result.warnings.push_back(warning);
  return result;
}

}  // namespace wiimote_tracker::principal_point
