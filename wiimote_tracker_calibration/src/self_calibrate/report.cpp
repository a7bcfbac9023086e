#include "report.h"

#include <cmath>
#include <vector>

namespace wiimote_tracker::import {

namespace {

void printErrors(const std::string& name, const Errors& errors, std::FILE* file) {
  std::fprintf(file, "%-20s %6zu of %-6zu %9.3f %9.3f %9.3f\n", name.c_str(), errors.inliers,
               errors.observations, errors.median, errors.mean, errors.p95);
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
                 ".\nThe pixels are explained, but shapes in space are not to be trusted: turn the "
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
  const Comparison& comparison = *report.comparison;
  std::fprintf(file, "\nBeside the calibration that came with it: %s.\n", comparison.what.c_str());
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
    std::fprintf(file, "; own uncertainty lets expect RMS %.3g", *comparison.expected);
  std::fprintf(file, "\n  after a projective transformation: RMS %.3g, median %.3g, p95 %.3g\n",
               comparison.projective.rms, comparison.projective.median, comparison.projective.p95);
}

void jsonNumber(double value, std::FILE* file) {
  if (std::isfinite(value))
    std::fprintf(file, "%.17g", value);
  else
    std::fprintf(file, "null");
}

template <typename Numbers>
void jsonNumbers(const char* key, const Numbers& numbers, std::FILE* file) {
  std::fprintf(file, "\"%s\": [", key);
  bool first = true;
  for (const double number : numbers) {
    std::fprintf(file, first ? "" : ", ");
    jsonNumber(number, file);
    first = false;
  }
  std::fprintf(file, "]");
}

void jsonErrors(const char* key, const Errors& errors, std::FILE* file) {
  std::fprintf(file, "\"%s\": {\"observations\": %zu, \"inliers\": %zu, \"median\": ", key,
               errors.observations, errors.inliers);
  jsonNumber(errors.median, file);
  std::fprintf(file, ", \"mean\": ");
  jsonNumber(errors.mean, file);
  std::fprintf(file, ", \"p95\": ");
  jsonNumber(errors.p95, file);
  std::fprintf(file, "}");
}

void jsonCamera(const Report& report, std::size_t i, const Errors& errors, std::FILE* file) {
  const geometry::Camera& camera = report.solution.reconstruction.cameras[i];
  const geometry::Intrinsics& lens = camera.intrinsics;
  const bundle::LensCertainty& certainty = report.solution.lenses[i];
  const Eigen::Vector3d center = camera.center();
  const Eigen::Quaterniond q(camera.world_from_camera.linear());
  std::fprintf(file, "  {\"name\": \"%s\", \"width\": %d, \"height\": %d,\n   ",
               camera.name.c_str(), lens.width, lens.height);
  jsonErrors("reprojection_px", errors, file);
  std::fprintf(file, ",\n   ");
  jsonNumbers("fx_fy_cx_cy", std::vector<double>{lens.fx, lens.fy, lens.cx, lens.cy}, file);
  std::fprintf(file, ", \"distortion_model\": \"%s\", ", nameOf(lens.distortion_model));
  jsonNumbers("distortion", lens.distortion, file);
  std::fprintf(file, ",\n   \"focal_stddev_px\": ");
  jsonNumber(certainty.focal_stddev, file);
  std::fprintf(file, ", \"focal_determined\": %s,\n   ",
               certainty.focal_determined ? "true" : "false");
  jsonNumbers("position", std::vector<double>{center.x(), center.y(), center.z()}, file);
  std::fprintf(file, ", ");
  jsonNumbers("world_from_camera_xyzw", std::vector<double>{q.x(), q.y(), q.z(), q.w()}, file);
  if (report.comparison && !report.comparison->own.empty()) {
    std::fprintf(file, ",\n   ");
    jsonErrors("compared", report.comparison->own[i], file);
    std::fprintf(file, ", ");
    jsonErrors("shipped", report.comparison->shipped[i], file);
  }
  std::fprintf(file, "}");
}

void jsonDistances(const char* key, const Distances& distances, std::FILE* file) {
  std::fprintf(file, "\"%s\": {\"rms\": ", key);
  jsonNumber(distances.rms, file);
  std::fprintf(file, ", \"median\": ");
  jsonNumber(distances.median, file);
  std::fprintf(file, ", \"p95\": ");
  jsonNumber(distances.p95, file);
  std::fprintf(file, "}");
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
  const std::vector<Errors> errors = errorsOf(reconstruction);
  for (std::size_t i = 0; i < errors.size(); ++i)
    printErrors(reconstruction.cameras[i].name, errors[i], file);
  printLenses(report, file);
  printPoses(reconstruction, file);
  if (report.comparison)
    printComparison(report, file);
  for (std::size_t i = 0; points && i < reconstruction.points.size(); ++i) {
    if (const auto& point = reconstruction.points[i])
      std::fprintf(file, "%sframe %zu: %.6f %.6f %.6f\n", i == 0 ? "\n" : "", i, point->x(),
                   point->y(), point->z());
  }
}

void printJson(const Report& report, std::FILE* file) {
  const bundle::Reconstruction& reconstruction = report.solution.reconstruction;
  std::fprintf(file, "{\"starts\": %zu, \"followed\": %zu, \"agreeing\": %zu,\n \"pixel_stddev\": ",
               report.solution.starts, report.solution.followed, report.solution.agreeing);
  jsonNumber(report.solution.pixel_stddev, file);
  std::fprintf(file, ",\n \"cameras\": [\n");
  const std::vector<Errors> errors = errorsOf(reconstruction);
  for (std::size_t i = 0; i < errors.size(); ++i) {
    std::fprintf(file, i == 0 ? "" : ",\n");
    jsonCamera(report, i, errors[i], file);
  }
  std::fprintf(file, "\n ],\n \"points\": [");
  for (std::size_t i = 0; i < reconstruction.points.size(); ++i) {
    std::fprintf(file, i == 0 ? "\n  " : ",\n  ");
    if (const auto& point = reconstruction.points[i])
      std::fprintf(file, "[%.17g, %.17g, %.17g]", point->x(), point->y(), point->z());
    else
      std::fprintf(file, "null");
  }
  std::fprintf(file, "\n ]");
  if (report.comparison && !report.comparison->own.empty()) {
    std::fprintf(file,
                 ",\n \"shipped\": {\"points\": %zu, \"extent\": ", report.comparison->points);
    jsonNumber(report.comparison->extent, file);
    std::fprintf(file, ", ");
    jsonDistances("after_similarity", report.comparison->similar, file);
    std::fprintf(file, ", ");
    jsonDistances("after_projective", report.comparison->projective, file);
    std::fprintf(file, ", \"expected\": ");
    jsonNumber(report.comparison->expected.value_or(std::nan("")), file);
    std::fprintf(file, "}");
  }
  std::fprintf(file, "}\n");
}

}  // namespace wiimote_tracker::import
