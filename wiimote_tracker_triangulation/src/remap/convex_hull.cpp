#include "wiimote_tracker_triangulation/remap/convex_hull.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace wiimote_tracker::remap {

// Three points with no other point on one side span a face. All triples are tried; most are
// rejected after a few points, and points of a known face are skipped.
ConvexHull::ConvexHull(const std::vector<Eigen::Vector3d>& points) {
  if (points.empty())
    return;
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& point : points)
    box.extend(point);
  const double size = box.diagonal().norm();
  tolerance_ = 1e-9 * size;
  const auto liesOn = [&](const Face& face, const Eigen::Vector3d& point) {
    return std::abs(face.normal.dot(point) - face.offset) <= tolerance_;
  };
  const auto tryFace = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                           const Eigen::Vector3d& c) {
    for (const Face& face : faces_) {
      if (liesOn(face, a) && liesOn(face, b) && liesOn(face, c))
        return;
    }
    const Eigen::Vector3d cross = (b - a).cross(c - a);
    if (cross.norm() <= 1e-9 * size * size)
      return;
    Face face{cross.normalized(), 0.0};
    face.offset = face.normal.dot(a);
    bool above = false;
    bool below = false;
    for (const Eigen::Vector3d& point : points) {
      const double distance = face.normal.dot(point) - face.offset;
      above = above || distance > tolerance_;
      below = below || distance < -tolerance_;
      if (above && below)
        return;
    }
    if (above)
      face = {-face.normal, -face.offset};
    if (above || below)
      faces_.push_back(face);
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = i + 1; j < points.size(); ++j) {
      for (std::size_t k = j + 1; k < points.size(); ++k)
        tryFace(points[i], points[j], points[k]);
    }
  }
}

bool ConvexHull::encloses(const Eigen::Vector3d& point) const {
  return excess(point) <= tolerance_;
}

double ConvexHull::excess(const Eigen::Vector3d& point) const {
  if (faces_.empty() || !point.allFinite())
    return std::numeric_limits<double>::infinity();
  double most = -std::numeric_limits<double>::infinity();
  for (const Face& face : faces_)
    most = std::max(most, face.normal.dot(point) - face.offset);
  return most;
}

ConvexHull::Exit ConvexHull::exit(const Eigen::Vector3d& inside,
                                  const Eigen::Vector3d& outside) const {
  Exit exit{1.0, (outside - inside).normalized()};
  for (const Face& face : faces_) {
    const double room = face.offset - face.normal.dot(inside);
    const double way = face.normal.dot(outside - inside);
    if (way > room && room / way <= exit.share)
      exit = {room / way, face.normal};
  }
  return exit;
}

}  // namespace wiimote_tracker::remap
