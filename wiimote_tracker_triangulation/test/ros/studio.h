// A message tracker with simulated cameras: messages in, messages out.
#pragma once

#include "geometry/random_rigs.h"
#include "ros/blob_image.h"
#include "ros/tracker/message_tracker.h"
#include "wiimote_tracker_triangulation/ros/conversions.h"
#include "wiimote_tracker_triangulation/ros/message_fields.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace wiimote_tracker::studio {

using Eigen::Vector3d;
using estimators::TrackerMode;
using geometry::Rig;
using wiimote_tracker_msgs::IrBlobArray;
using wiimote_tracker_msgs::TrackedPoint;
using wiimote_tracker_msgs::TrackedPointArray;
using wiimote_tracker_msgs::TrackedPointArrayConstPtr;
using wiimote_tracker_msgs::ZoneEvent;

constexpr double kPeriod = 0.01;

// Bound on errors with exact pixels, which come from interpolation or the motion model on a circle
// of 0.5 m at 0.5 m/s [m].
constexpr double kNear = 2e-3;

using Paths = std::vector<std::function<Vector3d(double)>>;

inline Vector3d onCircle(double t) {
  return {0.5 * std::cos(t), 0.5 * std::sin(t), 0.2};
}

inline Vector3d besideCircle(double t) {
  return onCircle(t) + Vector3d(0.0, 0.0, 0.4);
}

struct Heard : MessageSink {
  void onPoints(const TrackedPointArrayConstPtr& array,
                const std::vector<tracking::CameraView>& views) override {
    arrays.push_back(array);
    view_count = views.size();
  }
  void onBodies(const wiimote_tracker_msgs::TrackedBodyArray& array,
                const std::vector<bool>& /*bridged*/) override {
    bodies.push_back(array);
  }
  void onZoneEvent(const ZoneEvent& event) override { events.push_back(event); }
  void onTriggeredPoints(const TrackedPointArray& array) override { triggered.push_back(array); }
  void onProblem(const std::string& sentence) override { problems.push_back(sentence); }

  /// How many of the problems contain these words.
  long problemsWith(const std::string& words) const {
    return std::count_if(problems.begin(), problems.end(), [&](const std::string& problem) {
      return problem.find(words) != std::string::npos;
    });
  }

  std::vector<TrackedPointArrayConstPtr> arrays;
  std::vector<wiimote_tracker_msgs::TrackedBodyArray> bodies;
  std::vector<ZoneEvent> events;
  std::vector<TrackedPointArray> triggered;
  std::vector<std::string> problems;
  std::size_t view_count = 0;
};

inline TrackingParameters parametersOf(TrackerMode mode) {
  TrackingParameters parameters;
  parameters.estimator.tracker_mode = mode;
  return parameters;
}

/// A tracker and three cameras, each with its own phase; images come in the order of arrival.
class Studio {
 public:
  explicit Studio(const TrackingParameters& parameters) : tracker(parameters, &heard) {
    geometry::test::Random random(81);
    rig = geometry::test::randomRig(random, 3);
    tracker.takeRig(toMessage(rig));
  }

  IrBlobArray image(std::size_t camera, double time, const Paths& leds) const {
    std::vector<Vector3d> lit;
    for (std::size_t i = 0; i < leds.size(); ++i) {
      if (!is_dark || !is_dark(i, time))
        lit.push_back(leds[i](time));
    }
    IrBlobArray image = blobImage(rig.cameras[camera].camera, time, lit);
    image.stamp_stddev = 1e-6;
    return image;
  }

  void film(double duration, const Paths& leds) {
    const double end = now + duration;
    for (; now < end - 1e-6; now += kPeriod) {
      for (std::size_t camera = 0; camera < 3; ++camera) {
        IrBlobArray taken = image(camera, now + 0.003 * static_cast<double>(camera), leds);
        if (spoil)
          spoil(camera, &taken);
        tracker.takeImage(rig.cameras[camera].camera.name, taken);
      }
    }
  }

  /// The points of this label in the outputs after a time.
  std::vector<std::pair<double, TrackedPoint>> pointsOf(const std::string& label,
                                                        double after) const {
    std::vector<std::pair<double, TrackedPoint>> points;
    for (const auto& array : heard.arrays) {
      for (const TrackedPoint& point : array->points) {
        if (point.label == label && array->header.stamp.toSec() > after)
          points.emplace_back(array->header.stamp.toSec(), point);
      }
    }
    return points;
  }

  void expectNear(const std::string& label,
                  double after,
                  const std::function<Vector3d(double)>& path) const {
    const auto points = pointsOf(label, after);
    EXPECT_FALSE(points.empty()) << label;
    for (const auto& [time, point] : points) {
      ASSERT_LT((vectorOf(point.position) - path(time)).norm(), kNear) << label << " at " << time;
    }
  }

  Heard heard;
  MessageTracker tracker;
  Rig rig;
  double now = 1000.0;
  std::function<void(std::size_t, IrBlobArray*)> spoil;
  std::function<bool(std::size_t led, double time)> is_dark;
};

}  // namespace wiimote_tracker::studio
