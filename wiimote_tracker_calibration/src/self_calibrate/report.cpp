#include "report.h"

#include <wiimote_tracker_msgs/text.h>

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

namespace wiimote_tracker::self_calibrate {

namespace {

// A larger share of outliers comes from more than false detections.
constexpr double kMostOutliers = 0.1;

void printErrors(const std::string& name, const bundle::Statistics& errors, std::FILE* file) {
  std::fprintf(file, "%-20s %6zu of %-6zu %9.3f %9.3f %9.3f\n", name.c_str(), errors.inliers,
               errors.observations, errors.median, errors.mean, errors.p95);
}

/// Asks for a better recording if too many observations that another camera shares are outliers, or
/// the adjustment did not converge.
void printMisfit(const bundle::Reconstruction& reconstruction, std::FILE* file) {
  std::vector<std::size_t> views(reconstruction.points.size(), 0);
  for (const bundle::Observation& observation : reconstruction.observations)
    ++views[observation.point];
  std::size_t shared = 0;
  std::size_t outliers = 0;
  for (std::size_t i = 0; i < reconstruction.observations.size(); ++i) {
    if (views[reconstruction.observations[i].point] < 2)
      continue;
    ++shared;
    outliers += reconstruction.inliers[i] ? 0 : 1;
  }
  if (static_cast<double>(outliers) > kMostOutliers * static_cast<double>(shared))
    std::fprintf(file,
                 "\nOBSERVATIONS FIT NO POINT: %zu of the %zu that two cameras or more share.\n"
                 "The cameras may be wrong: record one light only, moved through all of the room, "
                 "with synchronised cameras, and give no intrinsics but the right ones.\n",
                 outliers, shared);
  if (!reconstruction.converged)
    std::fprintf(file,
                 "\nNO FINAL SOLUTION: the adjustment still changed when it was stopped.\n"
                 "The cameras may be less certain than stated: record the light longer, in more "
                 "places, with synchronised cameras and without other lights.\n");
}

void printLenses(const Report& report, std::FILE* file) {
  const auto& solution = report.solution;
  std::fprintf(file, "\n%-20s %19s %8s %8s %8s %8s %8s %8s\n", "lens", "fx [px]", "fy", "cx", "cy",
               "k1", "k2", "k3");
  bool determined = true;
  for (std::size_t i = 0; i < solution.lenses.size(); ++i) {
    const geometry::Camera& camera = solution.reconstruction.cameras[i];
    const geometry::Intrinsics& lens = camera.intrinsics;
    std::fprintf(file, "%-20s %8.1f +- %7.1f %8.1f %8.1f %8.1f %8.3f %8.3f %8.3f\n",
                 camera.name.c_str(), lens.fx, solution.lenses[i].focal_stddev, lens.fy, lens.cx,
                 lens.cy, lens.distortion[0], lens.distortion[1], lens.distortion[4]);
    determined = determined && solution.lenses[i].focal_determined;
  }
  if (!determined) {
    std::fprintf(file, "\nFOCAL LENGTH NOT DETERMINED by what was recorded, of:");
    for (std::size_t i = 0; i < solution.lenses.size(); ++i) {
      if (!solution.lenses[i].focal_determined)
        std::fprintf(file, " %s", solution.reconstruction.cameras[i].name.c_str());
    }
    std::fprintf(file,
                 ".\nThe pixels fit, but the shapes in space may be wrong: turn the "
                 "cameras so that they look from different sides, add a camera, or give the "
                 "intrinsics with --fix-intrinsics.\n");
  }
}

void printPoses(const bundle::Reconstruction& reconstruction, std::FILE* file) {
  std::fprintf(file, "\n%-20s %9s %9s %9s %30s\n", "pose (no scale)", "x", "y", "z",
               "looks along x, y, z");
  for (const geometry::Camera& camera : reconstruction.cameras) {
    const Eigen::Vector3d center = camera.center();
    const Eigen::Vector3d axis = camera.world_from_camera.linear().col(2);
    std::fprintf(file, "%-20s %9.4f %9.4f %9.4f %12.4f %8.4f %8.4f\n", camera.name.c_str(),
                 center.x(), center.y(), center.z(), axis.x(), axis.y(), axis.z());
  }
}

void printComparison(const Report& report, std::FILE* file) {
  const import::Comparison& comparison = *report.comparison;
  std::fprintf(file, "\nCompared with the shipped calibration: %s.\n", comparison.what.c_str());
  if (comparison.own.empty())
    return;
  for (std::size_t i = 0; i < comparison.own.size(); ++i) {
    printErrors(report.solution.reconstruction.cameras[i].name, comparison.own[i], file);
    printErrors("    shipped", comparison.shipped[i], file);
  }
  std::fprintf(file,
               "%zu points, RMS %.5g from their mean, as shipped. Distance of own points from "
               "them:\n  after a similarity: RMS %.3g, median %.3g, p95 %.3g",
               comparison.points, comparison.extent, comparison.similar.rms,
               comparison.similar.median, comparison.similar.p95);
  if (comparison.expected)
    std::fprintf(file, "; expected from the stated uncertainty: RMS %.3g", *comparison.expected);
  std::fprintf(file, "\n  after a projective transformation: RMS %.3g, median %.3g, p95 %.3g\n",
               comparison.projective.rms, comparison.projective.median, comparison.projective.p95);
}

std::string json(double value) {
  return std::isfinite(value) ? exactNumber(value) : "null";
}

std::string jsonList(const std::vector<double>& numbers) {
  std::vector<std::string> texts;
  for (const double number : numbers)
    texts.push_back(json(number));
  return "[" + joined(texts) + "]";
}

std::string json(const bundle::Statistics& errors) {
  return format("{\"observations\": %zu, \"inliers\": %zu, ", errors.observations, errors.inliers) +
         "\"median\": " + json(errors.median) + ", \"mean\": " + json(errors.mean) +
         ", \"p95\": " + json(errors.p95) + "}";
}

std::string jsonDistances(const bundle::Statistics& distances) {
  return "{\"rms\": " + json(distances.rms) + ", \"median\": " + json(distances.median) +
         ", \"p95\": " + json(distances.p95) + "}";
}

std::string jsonCamera(const Report& report, std::size_t i, const bundle::Statistics& errors) {
  const geometry::Camera& camera = report.solution.reconstruction.cameras[i];
  const geometry::Intrinsics& lens = camera.intrinsics;
  const bundle::LensCertainty& certainty = report.solution.lenses[i];
  const Eigen::Vector3d center = camera.center();
  const Eigen::Quaterniond q(camera.world_from_camera.linear());
  std::string text =
      format("  {\"name\": \"%s\", \"width\": %d, \"height\": %d,\n   ", camera.name.c_str(),
             lens.width, lens.height) +
      "\"reprojection_px\": " + json(errors) +
      ",\n   \"fx_fy_cx_cy\": " + jsonList({lens.fx, lens.fy, lens.cx, lens.cy}) +
      ", \"distortion_model\": \"" + nameOf(lens.distortion_model) +
      "\", \"distortion\": " + jsonList({lens.distortion.begin(), lens.distortion.end()}) +
      ",\n   \"focal_stddev_px\": " + json(certainty.focal_stddev) +
      ", \"focal_determined\": " + (certainty.focal_determined ? "true" : "false") +
      ",\n   \"position\": " + jsonList({center.x(), center.y(), center.z()}) +
      ", \"world_from_camera_xyzw\": " + jsonList({q.x(), q.y(), q.z(), q.w()});
  if (report.comparison && !report.comparison->own.empty())
    text += ",\n   \"compared\": " + json(report.comparison->own[i]) +
            ", \"shipped\": " + json(report.comparison->shipped[i]);
  return text + "}";
}

std::string jsonShipped(const import::Comparison& comparison) {
  return format(",\n \"shipped\": {\"points\": %zu, ", comparison.points) +
         "\"extent\": " + json(comparison.extent) +
         ", \"after_similarity\": " + jsonDistances(comparison.similar) +
         ", \"after_projective\": " + jsonDistances(comparison.projective) +
         ", \"expected\": " + json(comparison.expected.value_or(std::nan(""))) + "}";
}

}  // namespace

void print(const Report& report, bool points, std::FILE* file) {
  const bundle::SelfCalibration& solution = report.solution;
  const bundle::Reconstruction& reconstruction = solution.reconstruction;
  std::size_t known = 0;
  for (const auto& point : reconstruction.points)
    known += point ? 1 : 0;
  std::fprintf(file, "%s: %zu cameras, %zu frames, %zu observations, %zu points in space\n",
               report.source.c_str(), reconstruction.cameras.size(), report.frames,
               reconstruction.observations.size(), known);
  if (report.lenses_given)
    std::fprintf(file, "Intrinsics as given.\n");
  else
    std::fprintf(file, "%zu starts; %zu of the %zu best ended in this solution.\n", solution.starts,
                 solution.agreeing, solution.followed);
  std::fprintf(file, "Noise of a pixel coordinate: %.3f px\n", solution.pixel_stddev);
  std::fprintf(file, "\n%-20s %16s %9s %9s %9s\n", "reprojection [px]", "inliers", "median", "mean",
               "p95");
  const std::vector<bundle::Statistics> errors = bundle::statisticsOfCameras(reconstruction);
  for (std::size_t i = 0; i < errors.size(); ++i)
    printErrors(reconstruction.cameras[i].name, errors[i], file);
  printMisfit(reconstruction, file);
  printLenses(report, file);
  printPoses(reconstruction, file);
  if (report.comparison)
    printComparison(report, file);
  if (!points)
    return;
  std::fputc('\n', file);
  for (std::size_t i = 0; i < reconstruction.points.size(); ++i) {
    if (const auto& point = reconstruction.points[i])
      std::fprintf(file, "frame %zu: %.6f %.6f %.6f\n", i, point->x(), point->y(), point->z());
  }
}

std::string jsonText(const Report& report) {
  const bundle::SelfCalibration& solution = report.solution;
  const bundle::Reconstruction& reconstruction = solution.reconstruction;
  std::vector<std::string> cameras;
  for (const bundle::Statistics& errors : bundle::statisticsOfCameras(reconstruction))
    cameras.push_back(jsonCamera(report, cameras.size(), errors));
  std::vector<std::string> points;
  for (const auto& point : reconstruction.points)
    points.push_back(point ? jsonList({point->x(), point->y(), point->z()}) : "null");
  std::string text = format("{\"starts\": %zu, \"followed\": %zu, \"agreeing\": %zu,\n ",
                            solution.starts, solution.followed, solution.agreeing) +
                     "\"converged\": " + (reconstruction.converged ? "true" : "false") +
                     ", \"pixel_stddev\": " + json(solution.pixel_stddev) + ",\n \"cameras\": [\n" +
                     joined(cameras, ",\n") + "\n ],\n \"points\": [\n  " +
                     joined(points, ",\n  ") + "\n ]";
  if (report.comparison && !report.comparison->own.empty())
    text += jsonShipped(*report.comparison);
  return text + "}\n";
}

}  // namespace wiimote_tracker::self_calibrate
