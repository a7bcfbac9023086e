#include "associate_views.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace wiimote_tracker::association {

namespace {

/// [px^2]
double meanImageArea(const geometry::Rig& rig) {
  double sum = 0.0;
  for (const geometry::RigCamera& camera : rig.cameras)
    sum += static_cast<double>(camera.camera.intrinsics.width) * camera.camera.intrinsics.height;
  return sum / rig.cameras.size();
}

}  // namespace

AssociationOptions typicalCosts(const geometry::Rig& rig,
                                double pixel_stddev,
                                double ghost_rate,
                                double detection_probability) {
  constexpr double kLedDensity = 0.25;  // [1/m^3]
  constexpr double kSpread = 0.0034;    // of a point [m/px]
  const double spread = kSpread * pixel_stddev;
  AssociationOptions options;
  options.pixel_stddev = pixel_stddev;
  options.ghost = std::max(1.0, -2.0 * std::log(2.0 * M_PI * pixel_stddev * pixel_stddev *
                                                ghost_rate / meanImageArea(rig)));
  options.point = std::max(
      0.0, -2.0 * std::log(kLedDensity * std::pow(2.0 * M_PI, 1.5) * spread * spread * spread));
  options.miss =
      std::max(0.0, -2.0 * std::log((1.0 - detection_probability) / detection_probability));
  return options;
}

ViewAssociator::ViewAssociator(const geometry::Rig& rig,
                               std::vector<std::vector<std::size_t>> partners,
                               const AssociationOptions& options)
    : options_(options), search_(rig, std::move(partners), options) {
  constexpr std::size_t kUsual = 64;  // spots of all views; more allocate
  component_.spots.reserve(kUsual);
  connected_.reserve(kUsual);
  pair_chi_squared_.reserve(kUsual * kUsual);
}

const Association& ViewAssociator::associate(const std::vector<View>& views) {
  collectSpots(views);
  for (std::size_t a = 0; a < views.size(); ++a) {
    if (views[a].count == 0)
      continue;
    for (const std::size_t b : search_.partners(a)) {
      if (b > a && views[b].count > 0)
        findPairs(views, a, b);
    }
  }
  result_.points.clear();
  result_.cost = 0.0;
  result_.steps = 0;
  result_.proven = true;
  solveComponents(views);
  return result_;
}

void ViewAssociator::collectSpots(const std::vector<View>& views) {
  first_spot_.clear();
  spots_.clear();
  epipolar_.clear();
  for (std::size_t view = 0; view < views.size(); ++view) {
    first_spot_.push_back(spots_.size());
    for (std::size_t i = 0; i < views[view].count; ++i) {
      spots_.push_back({view, i, spots_.size(), &views[view].sights[i]});
      const geometry::Sight& sight = views[view].sights[i];
      const Eigen::Matrix<double, 3, 2> by_pixel = sight.directionByPixel() * options_.pixel_stddev;
      epipolar_.push_back({sight.direction, by_pixel, by_pixel.squaredNorm()});
    }
  }
  first_spot_.push_back(spots_.size());
  pair_chi_squared_.assign(spots_.size() * spots_.size(), std::numeric_limits<double>::infinity());
}

/// Finds the pairs of spots of two views that can be one point, with the squared distance of both
/// from the constraint that their rays meet, over the variance of a pixel: f^2 / |d f / d (pixel a,
/// pixel b)|^2 with f = baseline . (direction a x direction b) (Sampson's distance). With normal a
/// = baseline x direction a, and normal b likewise, f = normal a . direction b.
void ViewAssociator::findPairs(const std::vector<View>& views, std::size_t a, std::size_t b) {
  const Eigen::Vector3d baseline = views[b].sights[0].origin - views[a].sights[0].origin;
  // A bound without derivatives rejects most pairs.
  const double widest = options_.maximum_pair_chi_squared * baseline.squaredNorm();
  normals_.clear();
  for (std::size_t spot = first_spot_[b]; spot < first_spot_[b + 1]; ++spot)
    normals_.push_back(baseline.cross(epipolar_[spot].direction));
  for (std::size_t spot_a = first_spot_[a]; spot_a < first_spot_[a + 1]; ++spot_a) {
    const EpipolarSpot& one = epipolar_[spot_a];
    const Eigen::Vector3d normal = baseline.cross(one.direction);
    for (std::size_t spot_b = first_spot_[b]; spot_b < first_spot_[b + 1]; ++spot_b) {
      const EpipolarSpot& other = epipolar_[spot_b];
      const double f = normal.dot(other.direction);
      if (f * f > widest * (one.spread + other.spread))
        continue;
      const Eigen::Vector3d& other_normal = normals_[spot_b - first_spot_[b]];
      const double variance = (other_normal.transpose() * one.direction_by_pixel).squaredNorm() +
                              (normal.transpose() * other.direction_by_pixel).squaredNorm();
      const double chi_squared = f * f / variance;
      if (!(chi_squared <= options_.maximum_pair_chi_squared))
        continue;
      pair_chi_squared_[spot_a * spots_.size() + spot_b] = chi_squared;
      pair_chi_squared_[spot_b * spots_.size() + spot_a] = chi_squared;
    }
  }
}

/// Solves each connected component of the graph of possible pairs.
void ViewAssociator::solveComponents(const std::vector<View>& views) {
  component_.pair_chi_squared = pair_chi_squared_.data();
  component_.spots_of_all_views = spots_.size();
  is_solved_.assign(spots_.size(), false);
  for (std::size_t first = 0; first < spots_.size(); ++first) {
    if (is_solved_[first])
      continue;
    connected_.assign(1, first);
    is_solved_[first] = true;
    for (std::size_t i = 0; i < connected_.size(); ++i) {
      for (std::size_t other = first + 1; other < spots_.size(); ++other) {
        if (is_solved_[other] ||
            std::isinf(pair_chi_squared_[connected_[i] * spots_.size() + other]))
          continue;
        connected_.push_back(other);
        is_solved_[other] = true;
      }
    }
    std::sort(connected_.begin(), connected_.end());
    component_.spots.clear();
    for (const std::size_t spot : connected_)
      component_.spots.push_back(spots_[spot]);
    solveComponent(views);
  }
}

void ViewAssociator::solveComponent(const std::vector<View>& views) {
  if (component_.spots.size() == 1) {
    result_.cost += options_.ghost;
    return;
  }
  if (!search_.solveAsOnePoint(component_, views)) {
    result_.steps += search_.solve(component_, views, options_.maximum_steps - result_.steps);
    result_.proven = result_.proven && result_.steps < options_.maximum_steps;
  }
  result_.cost += search_.cost();
  for (std::size_t i = 0; i < search_.pointCount(); ++i) {
    const PointSearch::Point& point = search_.point(i);
    SpotReferences& spots = result_.points.emplace_back(AssociatedPoint{point.location, {}}).spots;
    for (const std::size_t place : point.spots)
      spots.push_back({component_.spots[place].view, component_.spots[place].index});
  }
}

}  // namespace wiimote_tracker::association
