#include "baselines.h"

#include "wiimote_tracker_triangulation/geometry/error.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wiimote_tracker::gesture_tool {
namespace {

constexpr std::size_t kPoints = std::tuple_size<Cloud>::value;

/// Matches each point of a, from `start` on, to the nearest unmatched point of b. Early matches
/// weigh more.
double greedyMatch(const Cloud& a, const Cloud& b, std::size_t start) {
  std::array<bool, kPoints> taken{};
  double sum = 0.0;
  for (std::size_t step = 0; step < kPoints; ++step) {
    const std::size_t i = (start + step) % kPoints;
    double least = std::numeric_limits<double>::infinity();
    std::size_t nearest = 0;
    for (std::size_t j = 0; j < kPoints; ++j) {
      const double d = taken[j] ? least : (a[i] - b[j]).norm();
      if (d < least) {
        least = d;
        nearest = j;
      }
    }
    taken[nearest] = true;
    sum += (1.0 - static_cast<double>(step) / kPoints) * least;
  }
  return sum;
}

}  // namespace

Cloud cloudOf(const gesture::Path& path) {
  std::vector<double> lengths{0.0};
  for (std::size_t i = 1; i < path.size(); ++i)
    lengths.push_back(lengths.back() + (path[i].position - path[i - 1].position).norm());
  if (!(lengths.back() > 0.0))
    throw Error("a path has no length; remove it");
  Cloud cloud;
  for (std::size_t i = 0; i < kPoints; ++i) {
    const double wanted = lengths.back() * static_cast<double>(i) / (kPoints - 1);
    const auto above = std::lower_bound(lengths.begin(), lengths.end(), wanted);
    const auto k = std::min(static_cast<std::size_t>(above - lengths.begin()), path.size() - 1);
    const double share = k == 0 ? 0.0 : (wanted - lengths[k - 1]) / (lengths[k] - lengths[k - 1]);
    cloud[i] =
        k == 0 ? path[0].position
               : Eigen::Vector3d((1.0 - share) * path[k - 1].position + share * path[k].position);
  }
  Eigen::Map<Eigen::Matrix<double, 3, kPoints>> points(cloud[0].data());
  points.colwise() -= points.rowwise().mean().eval();
  points /= (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).maxCoeff();
  return cloud;
}

double pointCloudDistance(const Cloud& a, const Cloud& b) {
  const auto step = static_cast<std::size_t>(std::sqrt(kPoints));  // n^(1 - epsilon)
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t start = 0; start < kPoints; start += step)
    least = std::min({least, greedyMatch(a, b, start), greedyMatch(b, a, start)});
  return least;
}

double timeWarpingDistance(const Cloud& a, const Cloud& b) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::array<double, kPoints + 1> row;
  row.fill(kInfinity);
  row[0] = 0.0;
  for (const Eigen::Vector3d& point : a) {
    double diagonal = row[0];
    row[0] = kInfinity;
    for (std::size_t j = 1; j <= kPoints; ++j) {
      const double above = row[j];
      row[j] = (point - b[j - 1]).norm() + std::min({diagonal, above, row[j - 1]});
      diagonal = above;
    }
  }
  return row[kPoints];
}

}  // namespace wiimote_tracker::gesture_tool
