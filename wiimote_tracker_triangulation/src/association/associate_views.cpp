#include "wiimote_tracker_triangulation/association/associate_views.h"

#include "point_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace wiimote_tracker::association {

/// One of the two spots of an epipolar constraint.
struct EpipolarSpot {
  EpipolarSpot(const geometry::Sight& sight, double pixel_stddev)
      : direction(sight.direction),
        direction_by_pixel(sight.directionByPixel() * pixel_stddev),
        spread(direction_by_pixel.squaredNorm()) {}

  Eigen::Vector3d direction;
  Eigen::Matrix<double, 3, 2> direction_by_pixel;  ///< For one standard deviation.
  double spread;                                   ///< Upper bound of its squared length.
};

namespace {

/// Squared distance of two spots from the constraint that their rays meet, over the variance of a
/// pixel: f^2 / |d f / d (pixel a, pixel b)|^2 with f = baseline . (direction a x direction b)
/// (Sampson's distance). normal_a = baseline x direction a, normal_b likewise; f = normal_a .
/// direction b.
double epipolarChiSquared(const EpipolarSpot& a,
                          const Eigen::Vector3d& normal_a,
                          const EpipolarSpot& b,
                          const Eigen::Vector3d& normal_b,
                          double f) {
  const double by_a = (normal_b.transpose() * a.direction_by_pixel).squaredNorm();
  const double by_b = (normal_a.transpose() * b.direction_by_pixel).squaredNorm();
  return f * f / (by_a + by_b);
}

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

struct ViewAssociator::Workspace {
  Workspace(const geometry::Rig& rig,
            std::vector<std::vector<std::size_t>> partners,
            const AssociationOptions& association_options)
      : options(association_options), search(rig, std::move(partners), association_options) {
    constexpr std::size_t kUsual = 64;  // spots of all views; more allocate
    component.spots.reserve(kUsual);
    connected.reserve(kUsual);
    pair_chi_squared.reserve(kUsual * kUsual);
  }

  void collectSpots(const std::vector<View>& views);
  void findPairs(const std::vector<View>& views, std::size_t a, std::size_t b);
  void solveComponents(const std::vector<View>& views);
  void solveComponent(const std::vector<View>& views);

  AssociationOptions options;
  PointSearch search;
  std::vector<std::size_t> first_spot;   // of each view, and one past the last of all
  std::vector<Component::Spot> spots;    // of all views
  std::vector<EpipolarSpot> epipolar;    // of all spots
  std::vector<double> pair_chi_squared;  // see Component
  std::vector<bool> is_solved;           // per spot
  std::vector<std::size_t> connected;    // numbers of the spots of a component
  std::vector<Eigen::Vector3d> normals;
  Component component;
  Association result;
};

ViewAssociator::ViewAssociator(const geometry::Rig& rig,
                               std::vector<std::vector<std::size_t>> partners,
                               const AssociationOptions& options)
    : workspace_(std::make_unique<Workspace>(rig, std::move(partners), options)) {}

ViewAssociator::~ViewAssociator() = default;

const Association& ViewAssociator::associate(const std::vector<View>& views) {
  Workspace& w = *workspace_;
  w.collectSpots(views);
  for (std::size_t a = 0; a < views.size(); ++a) {
    if (views[a].count == 0)
      continue;
    for (const std::size_t b : w.search.partners(a)) {
      if (b > a && views[b].count > 0)
        w.findPairs(views, a, b);
    }
  }
  w.result.points.clear();
  w.result.spots.clear();
  w.result.cost = 0.0;
  w.result.steps = 0;
  w.result.proven = true;
  w.solveComponents(views);
  return w.result;
}

void ViewAssociator::Workspace::collectSpots(const std::vector<View>& views) {
  first_spot.clear();
  spots.clear();
  epipolar.clear();
  for (std::size_t view = 0; view < views.size(); ++view) {
    first_spot.push_back(spots.size());
    for (std::size_t i = 0; i < views[view].count; ++i) {
      spots.push_back({view, i, spots.size(), &views[view].sights[i]});
      epipolar.emplace_back(views[view].sights[i], options.pixel_stddev);
    }
  }
  first_spot.push_back(spots.size());
  pair_chi_squared.assign(spots.size() * spots.size(), std::numeric_limits<double>::infinity());
}

/// Finds the pairs of spots of two views that can be one point.
void ViewAssociator::Workspace::findPairs(const std::vector<View>& views,
                                          std::size_t a,
                                          std::size_t b) {
  const Eigen::Vector3d baseline = views[b].sights[0].origin - views[a].sights[0].origin;
  // A bound without derivatives rejects most pairs.
  const double widest = options.maximum_pair_chi_squared * baseline.squaredNorm();
  normals.clear();
  for (std::size_t spot = first_spot[b]; spot < first_spot[b + 1]; ++spot)
    normals.push_back(baseline.cross(epipolar[spot].direction));
  for (std::size_t spot_a = first_spot[a]; spot_a < first_spot[a + 1]; ++spot_a) {
    const EpipolarSpot& one = epipolar[spot_a];
    const Eigen::Vector3d normal = baseline.cross(one.direction);
    for (std::size_t spot_b = first_spot[b]; spot_b < first_spot[b + 1]; ++spot_b) {
      const EpipolarSpot& other = epipolar[spot_b];
      const double f = normal.dot(other.direction);
      if (f * f > widest * (one.spread + other.spread))
        continue;
      const double chi_squared =
          epipolarChiSquared(one, normal, other, normals[spot_b - first_spot[b]], f);
      if (!(chi_squared <= options.maximum_pair_chi_squared))
        continue;
      pair_chi_squared[spot_a * spots.size() + spot_b] = chi_squared;
      pair_chi_squared[spot_b * spots.size() + spot_a] = chi_squared;
    }
  }
}

/// Solves each connected component of the graph of possible pairs.
void ViewAssociator::Workspace::solveComponents(const std::vector<View>& views) {
  component.pair_chi_squared = pair_chi_squared.data();
  component.spots_of_all_views = spots.size();
  is_solved.assign(spots.size(), false);
  for (std::size_t first = 0; first < spots.size(); ++first) {
    if (is_solved[first])
      continue;
    connected.assign(1, first);
    is_solved[first] = true;
    for (std::size_t i = 0; i < connected.size(); ++i) {
      for (std::size_t other = first + 1; other < spots.size(); ++other) {
        if (is_solved[other] || std::isinf(pair_chi_squared[connected[i] * spots.size() + other]))
          continue;
        connected.push_back(other);
        is_solved[other] = true;
      }
    }
    std::sort(connected.begin(), connected.end());
    component.spots.clear();
    for (const std::size_t spot : connected)
      component.spots.push_back(spots[spot]);
    solveComponent(views);
  }
}

void ViewAssociator::Workspace::solveComponent(const std::vector<View>& views) {
  if (component.spots.size() == 1) {
    result.cost += options.ghost;
    return;
  }
  if (!search.solveAsOnePoint(component, views)) {
    result.steps += search.solve(component, views, options.maximum_steps - result.steps);
    result.proven = result.proven && result.steps < options.maximum_steps;
  }
  result.cost += search.cost();
  for (std::size_t i = 0; i < search.pointCount(); ++i) {
    const PointSearch::Point& point = search.point(i);
    result.points.push_back({point.location, result.spots.size(), point.spots.size()});
    for (const std::size_t place : point.spots) {
      const Component::Spot& spot = component.spots[place];
      result.spots.push_back({spot.view, spot.index});
    }
  }
}

}  // namespace wiimote_tracker::association
