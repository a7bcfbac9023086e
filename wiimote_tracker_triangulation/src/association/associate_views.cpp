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

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

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
  /// One spot: a node of the graph of possible pairs, and of the union-find of its components.
  struct Node {
    std::size_t view;
    std::size_t index;              // in its view
    std::size_t root;               // towards the first spot of its component
    std::size_t next_in_component;  // kNone: the last
    std::size_t last_in_component;  // of a root
    std::size_t first_edge;         // to a later spot; kNone: none
    std::size_t edge_count;         // to later spots
    std::size_t place;              // in the component
  };
  /// Two spots that can belong to one point.
  struct Edge {
    std::size_t later_spot;
    std::size_t next;  // of the same earlier spot; kNone: the last
    double chi_squared;
  };

  Workspace(const geometry::Rig& rig,
            std::vector<std::vector<std::size_t>> partners,
            const AssociationOptions& association_options)
      : options(association_options), search(rig, std::move(partners), association_options) {
    constexpr std::size_t kUsual = 64;  // spots of a component; larger ones allocate
    component.spots.reserve(kUsual);
    component.pair_chi_squared.reserve(kUsual * kUsual);
  }

  void collectSpots(const std::vector<View>& views);
  void findEdges(const std::vector<View>& views, std::size_t a, std::size_t b);
  std::size_t rootOf(std::size_t spot);
  void listComponents();
  void solve(const std::vector<View>& views, std::size_t root);
  void collectComponent(const std::vector<View>& views, std::size_t root);
  void collectPairs(std::size_t root);

  AssociationOptions options;
  PointSearch search;
  std::vector<std::size_t> first_spot;  // of each view, and one past the last of all
  std::vector<Node> nodes;              // of all spots
  std::vector<EpipolarSpot> epipolar;   // of all spots
  std::vector<Edge> edges;
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
        w.findEdges(views, a, b);
    }
  }
  w.listComponents();
  w.result.points.clear();
  w.result.spots.clear();
  w.result.cost = 0.0;
  w.result.steps = 0;
  w.result.proven = true;
  for (std::size_t spot = 0; spot < w.nodes.size(); ++spot) {
    if (w.nodes[spot].root == spot)
      w.solve(views, spot);
  }
  return w.result;
}

void ViewAssociator::Workspace::collectSpots(const std::vector<View>& views) {
  first_spot.clear();
  nodes.clear();
  epipolar.clear();
  edges.clear();
  for (std::size_t view = 0; view < views.size(); ++view) {
    first_spot.push_back(nodes.size());
    for (std::size_t i = 0; i < views[view].count; ++i) {
      const std::size_t spot = nodes.size();
      nodes.push_back({view, i, spot, kNone, spot, kNone, 0, 0});
      epipolar.emplace_back(views[view].sights[i], options.pixel_stddev);
    }
  }
  first_spot.push_back(nodes.size());
}

/// Finds the pairs of spots of two views that can be one point.
void ViewAssociator::Workspace::findEdges(const std::vector<View>& views,
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
      edges.push_back({spot_b, nodes[spot_a].first_edge, chi_squared});
      nodes[spot_a].first_edge = edges.size() - 1;
      ++nodes[spot_a].edge_count;
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

void ViewAssociator::Workspace::listComponents() {
  for (std::size_t spot = 0; spot < nodes.size(); ++spot) {
    Node& root = nodes[rootOf(spot)];
    if (root.last_in_component != spot)
      nodes[root.last_in_component].next_in_component = spot;
    root.last_in_component = spot;
  }
}

void ViewAssociator::Workspace::solve(const std::vector<View>& views, std::size_t root) {
  if (nodes[root].next_in_component == kNone) {  // a spot without a possible pair
    result.cost += options.ghost;
    return;
  }
  collectComponent(views, root);
  if (!search.solveAsOnePoint(component, views)) {
    collectPairs(root);
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

void ViewAssociator::Workspace::collectComponent(const std::vector<View>& views, std::size_t root) {
  component.spots.clear();
  component.pair_count = 0;
  for (std::size_t spot = root; spot != kNone; spot = nodes[spot].next_in_component) {
    Node& link = nodes[spot];
    link.place = component.spots.size();
    component.spots.push_back({link.view, link.index, &views[link.view].sights[link.index]});
    component.pair_count += link.edge_count;
  }
}

void ViewAssociator::Workspace::collectPairs(std::size_t root) {
  const std::size_t size = component.spots.size();
  component.pair_chi_squared.assign(size * size, std::numeric_limits<double>::infinity());
  for (std::size_t spot = root; spot != kNone; spot = nodes[spot].next_in_component) {
    for (std::size_t edge = nodes[spot].first_edge; edge != kNone; edge = edges[edge].next) {
      const std::size_t place = nodes[spot].place;
      const std::size_t later_place = nodes[edges[edge].later_spot].place;
      component.pair_chi_squared[place * size + later_place] = edges[edge].chi_squared;
      component.pair_chi_squared[later_place * size + place] = edges[edge].chi_squared;
    }
  }
}

}  // namespace wiimote_tracker::association
