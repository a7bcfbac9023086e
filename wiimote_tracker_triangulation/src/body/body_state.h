#pragma once

#include "body/body_filter.h"
#include "body/body_setup.h"
#include "body/solve_pose.h"
#include "tracking/timed_image.h"
#include "wiimote_tracker_triangulation/body/pose_filter.h"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

namespace wiimote_tracker::body {

/// A body whose pose is known.
struct KnownBody {
  /// @param options not owned. @param spots that told its pose.
  KnownBody(const BodyTrackerOptions& options, double time, const BodyPose& pose, std::size_t spots)
      : filter(options.motion,
               options.inertial,
               PoseFilter(options.motion, time, pose.world_from_body, pose.covariance)),
        first_seen(time),
        last_observed(time),
        found_time(time),
        found_spots(spots) {
    led_times.fill(-std::numeric_limits<double>::infinity());
  }

  BodyFilter filter;
  double first_seen;                           ///< [s]
  double last_observed;                        ///< [s]
  double found_time;                           ///< When it was started, last [s].
  std::size_t found_spots;                     ///< That told its pose then.
  std::array<double, kMaximumLeds> led_times;  ///< When last seen [s].
};

struct SpotLed {
  std::size_t body;
  std::size_t led;
};

/// A spot that updated a body.
struct BodySpot : SpotLed {
  bool is_further;  ///< Merged with the one before.
  Eigen::Vector2d pixel;
  double misfit;     ///< Squared Mahalanobis distance from the prediction [1].
  double residual;   ///< [px]
  double deviation;  ///< [m]
};

/// The newest image of a camera.
struct LastImage {
  double time = -std::numeric_limits<double>::infinity();  ///< [s]
  std::vector<BodySpot> taken;
  std::vector<Eigen::Vector2d> free;  ///< Spots of no tracked body [px].

  std::size_t countSpots(std::size_t body) const {
    return std::count_if(taken.begin(), taken.end(), [&](const BodySpot& spot) {
      return spot.body == body && !spot.is_further;
    });
  }
};

/// Everything that a late image may change.
struct BodyState {
  std::vector<std::optional<KnownBody>> bodies;
  std::vector<LastImage> images;  ///< Per camera.
};

/// An image to track bodies in.
struct BodyImage : tracking::TimedImage {
  struct LabelStart {
    std::size_t body;
    BodyPose pose;
  };

  std::vector<Eigen::Vector2d> pixels;
  bool is_doubtful = false;        ///< Of a camera that does not fit the others.
  std::vector<LabelStart> starts;  ///< Of bodies that were unknown after this image.
};

}  // namespace wiimote_tracker::body
