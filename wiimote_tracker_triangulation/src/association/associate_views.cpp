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
  return sum / static_cast<double>(rig.cameras.size());
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
  /// One spot: a node of the union-find of the components of possible pairs.
  struct Node {
    std::size_t view;
    std::size_t index;  // in its view
    std::size_t root;   // towards the first spot of its component
  };

  Workspace(const geometry::Rig& rig,
            std::vector<std::vector<std::size_t>> partners,
            const AssociationOptions& association_options)
      : options(association_options), search(rig, std::move(partners), association_options) {
    constexpr std::size_t kUsual = 64;  // spots of all views; more allocate
    component.spots.reserve(kUsual);
    pair_chi_squared.reserve(kUsual * kUsual);
  }

  void collectSpots(const std::vector<View>& views);
  void findPairs(const std::vector<View>& views, std::size_t a, std::size_t b);
  std::size_t rootOf(std::size_t spot);
  void solveComponents(const std::vector<View>& views);
  void solveComponent(const std::vector<View>& views);

  AssociationOptions options;
  PointSearch search;
  std::vector<std::size_t> first_spot;    // of each view, and one past the last of all
  std::vector<Node> nodes;                // of all spots
  std::vector<EpipolarSpot> epipolar;     // of all spots
  std::vector<double> pair_chi_squared;   // see Component
  std::vector<std::size_t> by_component;  // numbers of all spots
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
  nodes.clear();
  epipolar.clear();
  for (std::size_t view = 0; view < views.size(); ++view) {
    first_spot.push_back(nodes.size());
    for (std::size_t i = 0; i < views[view].count; ++i) {
      const std::size_t spot = nodes.size();
      nodes.push_back({view, i, spot});
      epipolar.emplace_back(views[view].sights[i], options.pixel_stddev);
    }
  }
  first_spot.push_back(nodes.size());
  pair_chi_squared.assign(nodes.size() * nodes.size(), std::numeric_limits<double>::infinity());
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
      pair_chi_squared[spot_a * nodes.size() + spot_b] = chi_squared;
      pair_chi_squared[spot_b * nodes.size() + spot_a] = chi_squared;
      const std::size_t root_a = rootOf(spot_a);
      const std::size_t root_b = rootOf(spot_b);
      nodes[std::max(root_a, root_b)].root = std::min(root_a, root_b);
    }
  }
}

std::size_t ViewAssociator::Workspace::rootOf(std::size_t spot) {
  while (nodes[spot].root != spot) {
    nodes[spot].root = nodes[nodes[spot].root].root;
    spot = nodes[spot].root;
  }
  return spot;
}

void ViewAssociator::Workspace::solveComponents(const std::vector<View>& views) {
  by_component.resize(nodes.size());
  for (std::size_t spot = 0; spot < nodes.size(); ++spot) {
    by_component[spot] = spot;
    nodes[spot].root = rootOf(spot);
  }
  std::sort(by_component.begin(), by_component.end(), [&](std::size_t a, std::size_t b) {
    return nodes[a].root != nodes[b].root ? nodes[a].root < nodes[b].root : a < b;
  });
  component.pair_chi_squared = pair_chi_squared.data();
  component.spots_of_all_views = nodes.size();
  for (auto spot = by_component.begin(); spot != by_component.end();) {
    component.spots.clear();
    const std::size_t root = nodes[*spot].root;
    for (; spot != by_component.end() && nodes[*spot].root == root; ++spot) {
      const Node& node = nodes[*spot];
      component.spots.push_back(
          {node.view, node.index, *spot, &views[node.view].sights[node.index]});
    }
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
