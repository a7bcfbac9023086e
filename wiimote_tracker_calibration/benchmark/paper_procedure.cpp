#include "paper_procedure.h"

#include <wiimote_tracker_msgs/error.h>
#include <wiimote_tracker_triangulation/geometry/triangulate.h>

#include <cmath>
#include <random>
#include <string>

namespace wiimote_tracker::principal_point {

namespace {

using Random = std::mt19937_64;

double normal(Random& random, double stddev) {
  return stddev > 0.0 ? std::normal_distribution<double>(0.0, stddev)(random) : 0.0;
}

Eigen::Vector2d pixelNoise(Random& random, double stddev) {
  const double u = normal(random, stddev);
  return Eigen::Vector2d(u, normal(random, stddev));
}

/// One camera on a diagonal of the cube, 4.5 m from its edge and 2 m high, that looks at the middle
/// of the cube, a little below its centre (the paper's Fig. 1; z up).
geometry::Camera trueCamera(const PaperSession& session, std::size_t index, Random& random) {
  const double angle = M_PI / 4.0 + static_cast<double>(index) * M_PI / 2.0;
  const double distance = 4.5 + 1.25 * std::sqrt(2.0);
  const Eigen::Vector3d position(1.25 + distance * std::cos(angle),
                                 1.25 + distance * std::sin(angle), 2.0);
  geometry::Camera camera;
  camera.name = "camera_" + std::to_string(index + 1);
  camera.world_from_camera =
      geometry::lookAt(position, Eigen::Vector3d(1.25, 1.25, 1.0), Eigen::Vector3d::UnitZ());
  const double scale = 1.0 + normal(random, session.focal_stddev);
  camera.intrinsics.fx *= scale;
  camera.intrinsics.fy *= scale;
  const Eigen::Vector2d principal_point =
      session.true_principal_point + pixelNoise(random, session.principal_point_stddev);
  camera.intrinsics.cx = principal_point.x();
  camera.intrinsics.cy = principal_point.y();
  camera.intrinsics.distortion = session.distortion;
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
  std::vector<geometry::Camera> cameras;
  for (const geometry::RigCamera& camera : rig.cameras)
    cameras.push_back(rig.rayCamera(camera));
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
  square::SquareLayout layout;
  layout.side_x = 2.5;
  layout.side_y = 2.5;
  square::Corners corners = layout.corners(true);
  for (Eigen::Vector3d& corner : corners)
    corner.head<2>() += pixelNoise(random, session.placement);

  const std::vector<Eigen::Vector3d> points = tenPoints();
  std::vector<std::vector<Eigen::Vector2d>> pixels(points.size());
  std::vector<square::CameraSightings> cameras;
  for (const std::size_t index : session.cameras) {
    const geometry::Camera truth = trueCamera(session, index, random);
    square::CameraSightings sightings;
    sightings.name = truth.name;
    sightings.intrinsics.cx = session.assumed_principal_point.x();
    sightings.intrinsics.cy = session.assumed_principal_point.y();
    if (session.distortion_known)
      sightings.intrinsics.distortion = session.distortion;
    for (std::size_t c = 0; c < corners.size(); ++c)
      sightings.corners[c] =
          truth.project(corners[c]).value() + pixelNoise(random, session.corner_pixel);
    for (std::size_t p = 0; p < points.size(); ++p)
      pixels[p].push_back(truth.project(points[p]).value() +
                          pixelNoise(random, session.point_pixel));
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
