#pragma once

#include "geometry/random_rigs.h"
#include "ros/blob_image.h"
#include "wiimote_tracker_triangulation/ros/conversions.h"

#include <diagnostic_msgs/DiagnosticArray.h>
#include <geometry_msgs/PointStamped.h>
#include <gtest/gtest.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <rosgraph_msgs/Log.h>
#include <std_msgs/Header.h>
#include <tf2_msgs/TFMessage.h>
#include <visualization_msgs/MarkerArray.h>
#include <wiimote_tracker_msgs/TrackedPointArray.h>
#include <wiimote_tracker_msgs/ZoneEvent.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace wiimote_tracker {

constexpr double kPeriod = 0.01;
// Topics may overtake each other within it; a camera this late still counts.
constexpr double kBatch = 0.02;

/// 0.5 m/s, in view of all cameras.
inline Eigen::Vector3d ledAt(double t) {
  return {0.5 * std::cos(t), 0.5 * std::sin(t), 0.2};
}

inline Eigen::Vector3d otherLedAt(double t) {
  return ledAt(t) + Eigen::Vector3d(0.0, 0.0, 0.4);
}

/// Publishes images and collects all output; shared by all tests, which follow each other in time.
class Bench {
 public:
  Bench() {
    geometry::test::Random random(81);
    rig_ = geometry::test::randomRig(random, 3);
    rig_publisher_ =
        nh_.advertise<wiimote_tracker_msgs::RigCalibration>("calibration/rig", 10, true);
    for (const auto& camera : rig_.cameras)
      blob_publishers_.push_back(
          nh_.advertise<wiimote_tracker_msgs::IrBlobArray>(camera.camera.name + "/ir_blobs", 1000));
    subscribers_ = {
        nh_.subscribe<wiimote_tracker_msgs::TrackedPointArray>(
            "points", 10000, [this](const auto& m) { arrays_.push_back(*m); }),
        nh_.subscribe<geometry_msgs::PointStamped>(
            "led/point", 10000, [this](const auto& m) { points_.push_back(*m); }),
        nh_.subscribe<geometry_msgs::PointStamped>(
            "second/point", 10000, [this](const auto& m) { second_points_.push_back(*m); }),
        nh_.subscribe<wiimote_tracker_msgs::TrackedPointArray>(
            "steady/points", 10000, [this](const auto& m) { steady_arrays_.push_back(*m); }),
        nh_.subscribe<wiimote_tracker_msgs::TrackedPointArray>(
            "triggered_points", 100, [this](const auto& m) { triggered_.push_back(*m); }),
        nh_.subscribe<wiimote_tracker_msgs::ZoneEvent>(
            "zone_events", 100, [this](const auto& m) { zone_events_.push_back(*m); }),
        nh_.subscribe<tf2_msgs::TFMessage>(
            "/tf", 10000,
            [this](const auto& m) {
              transforms_.insert(transforms_.end(), m->transforms.begin(), m->transforms.end());
            }),
        nh_.subscribe<visualization_msgs::MarkerArray>(
            "markers", 1000, [this](const auto& m) { markers_.push_back(*m); }),
        nh_.subscribe<diagnostic_msgs::DiagnosticArray>(
            "/diagnostics", 1000,
            [this](const auto& m) {
              EXPECT_FALSE(m->status.empty());
              diagnostics_.insert(diagnostics_.end(), m->status.begin(), m->status.end());
            }),
        nh_.subscribe<rosgraph_msgs::Log>("/rosout", 1000, [this](const auto& m) {
          if (m->name.find("steady") == std::string::npos)
            log_ += m->msg + "\n";
        })};
    trigger_publisher_ = nh_.advertise<std_msgs::Header>("trigger", 10);
    newest_.assign(3, -1.0);
  }

  /// Runs callbacks until the condition holds; false after a minute.
  static bool waitFor(const std::function<bool()>& condition) {
    const ros::WallTime deadline = ros::WallTime::now() + ros::WallDuration(60.0);
    while (ros::ok() && !condition()) {
      if (ros::WallTime::now() > deadline)
        return false;
      ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.01));
    }
    return condition();
  }

  bool waitForLog(const std::string& words) {
    return waitFor([&] { return log_.find(words) != std::string::npos; });
  }

  /// Of the tracker and of the one with a fixed rate.
  bool waitForSubscriptions() {
    return waitFor([&] {
      return std::all_of(blob_publishers_.begin(), blob_publishers_.end(),
                         [](const auto& p) { return p.getNumSubscribers() > 1; });
    });
  }

  wiimote_tracker_msgs::IrBlobArray image(std::size_t camera, double time) const {
    std::vector<Eigen::Vector3d> places;
    for (const auto& led : leds_)
      places.push_back(led(time));
    wiimote_tracker_msgs::IrBlobArray image = blobImage(rig_.cameras[camera].camera, time, places);
    image.arrival.fromSec(time + kDelay + (camera == 1 ? arrival_error_ : 0.0));
    return image;
  }

  /// Publishes images of these cameras for a while in batches, and waits for the output of each.
  bool film(double duration, const std::vector<std::size_t>& cameras) {
    for (const double end = now_ + duration; now_ < end; now_ += kBatch) {
      for (const std::size_t c : cameras) {
        for (double t = now_ + 0.003 * c; t < now_ + kBatch - 1e-6; t += kPeriod) {
          blob_publishers_[c].publish(image(c, t));
          newest_[c] = std::max(newest_[c], t);
        }
      }
      // Cameras without an image for 0.1 s are not waited for.
      double reached = now_ + kBatch;
      const double newest = *std::max_element(newest_.begin(), newest_.end());
      for (const double t : newest_) {
        if (t >= newest - 0.1 - 1e-6)
          reached = std::min(reached, t);
      }
      const auto arrived = [&] {
        return !arrays_.empty() && arrays_.back().header.stamp.toSec() >= reached - 1e-6;
      };
      if (!waitFor(arrived))
        return false;
    }
    return true;
  }

  std::vector<wiimote_tracker_msgs::TrackedPointArray> arraysSince(double time) const {
    std::vector<wiimote_tracker_msgs::TrackedPointArray> result;
    for (const wiimote_tracker_msgs::TrackedPointArray& array : arrays_) {
      if (array.header.stamp.toSec() > time)
        result.push_back(array);
    }
    return result;
  }

  ros::NodeHandle nh_;
  geometry::Rig rig_;
  double now_ = 1000.0;
  double arrival_error_ = 0.0;  // of camera 1 [s]
  std::vector<double> newest_;
  std::vector<std::function<Eigen::Vector3d(double)>> leds_ = {ledAt};
  ros::Publisher trigger_publisher_;
  ros::Publisher rig_publisher_;
  std::vector<ros::Publisher> blob_publishers_;
  std::vector<ros::Subscriber> subscribers_;
  std::vector<wiimote_tracker_msgs::TrackedPointArray> arrays_;
  std::vector<wiimote_tracker_msgs::TrackedPointArray> steady_arrays_;
  std::vector<wiimote_tracker_msgs::TrackedPointArray> triggered_;
  std::vector<wiimote_tracker_msgs::ZoneEvent> zone_events_;
  std::vector<geometry_msgs::TransformStamped> transforms_;
  std::vector<geometry_msgs::PointStamped> points_;
  std::vector<geometry_msgs::PointStamped> second_points_;
  std::vector<visualization_msgs::MarkerArray> markers_;
  std::vector<diagnostic_msgs::DiagnosticStatus> diagnostics_;
  std::string log_;
};

}  // namespace wiimote_tracker
