#pragma once

#include "association/associate_views.h"
#include "synchronizer.h"
#include "wiimote_tracker_triangulation/fusion/instant_fuser.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"
#include "wiimote_tracker_triangulation/geometry/shared_views.h"
#include "wiimote_tracker_triangulation/geometry/triangulate.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

namespace wiimote_tracker::fusion {

/// Associates the spots of one instant and triangulates the points.
class Locator {
 public:
  struct Point {
    geometry::TriangulatedPoint located;
    double last_observed;               ///< Newest image of its spots [s].
    association::SpotReferences spots;  ///< In the order of the views.
  };

  /// @param rig has passed Rig::check.
  Locator(const geometry::Rig& rig, const InstantFuserOptions& options)
      : options_(options),
        ray_cameras_(rig.rayCameras()),
        associator_(rig,
                    geometry::sharedViews(rig, options.maximum_range),
                    associationOptions(rig, options)),
        sights_(rig.cameras.size()),
        spot_of_sight_(rig.cameras.size()),
        views_(rig.cameras.size()) {}

  /// Fills in points(): most rays first, then least reprojection error.
  void locate(const std::vector<InstantView>& views) {
    associate(views);
    points_.clear();
    for (const association::AssociatedPoint& associated : association_->points) {
      rays_.clear();
      observations_.clear();
      for (const association::SpotReference& sight : associated.spots) {
        const std::size_t spot = spot_of_sight_[sight.view][sight.spot];
        rays_.push_back({sight.view, spot});
        observations_.push_back({&ray_cameras_[sight.view], views[sight.view].spots[spot].pixel});
      }
      auto located = geometry::triangulate(observations_, options_.triangulation);
      if (!fits(located))
        located = triangulateWithoutWorst();
      if (!located)
        continue;
      double observed = -std::numeric_limits<double>::infinity();
      for (const association::SpotReference& ray : rays_)
        observed = std::max(observed, *views[ray.view].time);
      points_.push_back({*located, observed, rays_});
    }
    std::sort(points_.begin(), points_.end(), [](const Point& a, const Point& b) {
      return a.spots.size() != b.spots.size()
                 ? a.spots.size() > b.spots.size()
                 : a.located.reprojection_error < b.located.reprojection_error;
    });
  }

  const std::vector<Point>& points() const { return points_; }

 private:
  static association::AssociationOptions associationOptions(const geometry::Rig& rig,
                                                            const InstantFuserOptions& options) {
    association::AssociationOptions association =
        association::typicalCosts(rig, options.maximum_reprojection_error / 5.0);
    association.minimum_rays = options.minimum_rays;
    association.minimum_angle = options.triangulation.minimum_angle;
    return association;
  }

  void associate(const std::vector<InstantView>& views) {
    for (std::size_t v = 0; v < views.size(); ++v) {
      sights_[v].clear();
      spot_of_sight_[v].clear();
      for (std::size_t i = 0; i < views[v].spots.size(); ++i) {
        const tracking::SeenSpot& spot = views[v].spots[i];
        const auto sight = spot.use == tracking::SpotUse::kMasked
                               ? std::nullopt
                               : geometry::sightFromPixel(ray_cameras_[v], spot.pixel);
        if (!sight)
          continue;
        sights_[v].push_back(*sight);
        spot_of_sight_[v].push_back(i);
      }
      views_[v] = {sights_[v].data(), sights_[v].size(), views[v].is_watching, views[v].full};
    }
    association_ = &associator_.associate(views_);
  }

  bool fits(const std::optional<geometry::TriangulatedPoint>& point) const {
    return point && point->reprojection_error <= options_.maximum_reprojection_error;
  }

  /// Removes the ray without which the reprojection error is least. Nothing when the others do not
  /// fit either.
  std::optional<geometry::TriangulatedPoint> triangulateWithoutWorst() {
    if (rays_.size() < 3 || rays_.size() <= options_.minimum_rays)
      return std::nullopt;
    std::optional<geometry::TriangulatedPoint> best;
    std::size_t worst = 0;
    for (std::size_t left_out = 0; left_out < rays_.size(); ++left_out) {
      subset_.clear();
      for (std::size_t i = 0; i < observations_.size(); ++i) {
        if (i != left_out)
          subset_.push_back(observations_[i]);
      }
      const auto point = geometry::triangulate(subset_, options_.triangulation);
      if (fits(point) && (!best || point->reprojection_error < best->reprojection_error)) {
        best = point;
        worst = left_out;
      }
    }
    if (best)
      rays_.erase(rays_.begin() + worst);
    return best;
  }

  InstantFuserOptions options_;
  std::vector<geometry::Camera> ray_cameras_;
  association::ViewAssociator associator_;

  // Of one instant.
  std::vector<std::vector<geometry::Sight>> sights_;     // of each view
  std::vector<std::vector<std::size_t>> spot_of_sight_;  // in its view
  std::vector<association::View> views_;
  const association::Association* association_ = nullptr;
  std::vector<Point> points_;

  // Of one point.
  association::SpotReferences rays_;
  std::vector<geometry::Observation> observations_;  // of rays_
  std::vector<geometry::Observation> subset_;
};

}  // namespace wiimote_tracker::fusion
