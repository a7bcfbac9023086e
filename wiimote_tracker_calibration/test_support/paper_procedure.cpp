#include "paper_procedure.h"

#include "simulated_square.h"

#include <wiimote_tracker_msgs/error.h>
#include <wiimote_tracker_triangulation/geometry/triangulate.h>

#include <string>

namespace wiimote_tracker::principal_point {

namespace {

using square::normal;
using square::Random;

constexpr double kPrincipalPoint[] = {512.0, 384.0};  // Mean of the cameras' [px].
constexpr double kPrincipalPointStddev = 5.0;         // Among the cameras, per axis [px].
constexpr double kFocalStddev = 0.01;                 // Among the cameras, relative.
constexpr double kCornerPixel = 0.2;                  // Of a captured corner, per axis [px].
constexpr double kPointPixel = 0.3;                   // Of a measured point, per axis [px].
constexpr double kPlacement = 0.005;  // Of the LED on the corners, per horizontal axis [m].

Eigen::Vector2d pixelNoise(Random& random, double stddev) {
  const double u = normal(random, stddev);
  return Eigen::Vector2d(u, normal(random, stddev));
}

geometry::Camera trueCamera(std::size_t index, Random& random) {
  geometry::Camera camera;
  camera.name = "camera_" + std::to_string(index + 1);
  camera.world_from_camera = square::paperRig()[index];
  const double scale = 1.0 + normal(random, kFocalStddev);
  camera.intrinsics.fx *= scale;
  camera.intrinsics.fy *= scale;
  const Eigen::Vector2d noise = pixelNoise(random, kPrincipalPointStddev);
  camera.intrinsics.cx = kPrincipalPoint[0] + noise.x();
  camera.intrinsics.cy = kPrincipalPoint[1] + noise.y();
  return camera;
}

/// The paper's ten points: the corners of the cube, the middle of the floor, a point inside.
std::vector<Eigen::Vector3d> tenPoints() {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 8; ++i)
    points.emplace_back(2.5 * (i & 1), 2.5 * (i >> 1 & 1), 2.5 * (i >> 2 & 1));
  points.emplace_back(1.25, 1.25, 0.0);
  points.emplace_back(1.25, 1.25, 1.5);
  return points;
}

double meanError(const geometry::Rig& rig,
                 geometry::TriangulationMethod method,
                 const std::vector<std::vector<Eigen::Vector2d>>& pixels) {
  const std::vector<geometry::Camera> cameras = rig.rayCameras();
  const std::vector<Eigen::Vector3d> points = tenPoints();
  geometry::TriangulationOptions options;
  options.method = method;
  double sum = 0.0;
  for (std::size_t p = 0; p < points.size(); ++p) {
    std::vector<geometry::Observation> observations;
    for (std::size_t i = 0; i < cameras.size(); ++i)
      observations.push_back({&cameras[i], pixels[p][i]});
    const auto measured = geometry::triangulate(observations, options);
    if (!measured)
      throw Error("a point of the simulated session cannot be measured");
    sum += (measured->position - points[p]).norm();
  }
  return sum / static_cast<double>(points.size());
}

}  // namespace

PaperResult runPaperSession(const PaperSession& session) {
  Random random(session.seed);
  const square::SquareLayout layout = square::paperSquare();
  square::Corners corners = layout.corners(true);
  for (Eigen::Vector3d& corner : corners)
    corner.head<2>() += pixelNoise(random, kPlacement);

  const std::vector<Eigen::Vector3d> points = tenPoints();
  std::vector<std::vector<Eigen::Vector2d>> pixels(points.size());
  std::vector<square::CameraSightings> cameras;
  for (const std::size_t index : session.cameras) {
    const geometry::Camera truth = trueCamera(index, random);
    square::CameraSightings sightings;
    sightings.name = truth.name;
    for (std::size_t c = 0; c < corners.size(); ++c)
      sightings.corners[c] = truth.project(corners[c]).value() + pixelNoise(random, kCornerPixel);
    for (std::size_t p = 0; p < points.size(); ++p)
      pixels[p].push_back(truth.project(points[p]).value() + pixelNoise(random, kPointPixel));
    // Up, which every Wiimote measures.
    sightings.gravity =
        9.81 * (truth.world_from_camera.linear().transpose() * Eigen::Vector3d::UnitZ());
    cameras.push_back(sightings);
  }

  PaperResult result;
  CorrectionOptions none = session.correction;
  none.rounds = 0;
  result.before = meanError(correctPrincipalPoints(layout, cameras, none).rig, none.method, pixels);
  result.correction = correctPrincipalPoints(layout, cameras, session.correction);
  result.after = meanError(result.correction.rig, session.correction.method, pixels);
  return result;
}

}  // namespace wiimote_tracker::principal_point
