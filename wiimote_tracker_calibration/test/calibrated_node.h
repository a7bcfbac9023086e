#pragma once

#include "node_fixture.h"

#include <wiimote_tracker_msgs/AddKnownPlace.h>
#include <wiimote_tracker_msgs/CheckPlace.h>

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <string>

namespace wiimote_tracker {
namespace {

/// A calibration node with a rig.
class CalibratedNode : public Node {
 protected:
  /// The rig as it stands, with no uncertainty but that of the pixels.
  static geometry::Rig trueRig() {
    geometry::Rig rig;
    for (std::size_t i = 0; i < cameras_->truth.size(); ++i) {
      geometry::RigCamera camera;
      camera.camera = cameras_->truth[i];
      camera.camera.identity = "00:1e:35:00:00:0" + std::to_string(i + 1);
      camera.time_offset = 0.0;
      camera.time_offset_rule = geometry::TimeOffsetRule::kAlways;
      rig.cameras.push_back(camera);
    }
    rig.cameras[0].gravity =
        9.81 * cameras_->truth[0].world_from_camera.linear().row(2).transpose();
    rig.method = "test";
    rig.covariance = Eigen::MatrixXd::Zero(64, 64);
    return rig;
  }

  /// Measures eight known places of a world that is 2 % larger. @param places known before
  static void measureLargerWorld(std::uint32_t places) {
    for (const double x : {0.4, 2.1}) {
      for (const double y : {0.4, 2.1}) {
        for (const double z : {0.1, 1.6}) {
          const Eigen::Vector3d place(x, y, z);
          putLed(place);
          wiimote_tracker_msgs::AddKnownPlace::Request request;
          request.known = pointOf(1.02 * place);
          const auto response =
              call<wiimote_tracker_msgs::AddKnownPlace>("calibration/known_places/add", request);
          ASSERT_TRUE(response.success) << response.message;
          EXPECT_EQ(response.places, ++places);
          EXPECT_NEAR(response.measured.x, x, 0.005);
          EXPECT_SAYS(response.message, " m from the known place");
        }
      }
    }
  }

  static void load(const geometry::Rig& rig, const std::string& service = "calibration/load") {
    LoadRig::Request request;
    request.path = folder_ + "/loaded.yaml";
    geometry::writeRigFile(rig, request.path);
    const auto response = call<LoadRig>(service, request);
    ASSERT_TRUE(response.success) << response.message;
  }

  /// @param duration longest wait [s]; 0: the parameter.
  static wiimote_tracker_msgs::CheckPlace::Response check(const Eigen::Vector3d& known,
                                                          double duration = 0.0) {
    wiimote_tracker_msgs::CheckPlace::Request request;
    request.duration = duration;
    request.known = pointOf(known);
    request.known_stddev = 0.001;
    return call<wiimote_tracker_msgs::CheckPlace>("calibration/check", request);
  }

  static std::string health(const std::string& camera) {
    const auto status = status_->get();
    for (const auto& each : status->cameras) {
      if (each.name == camera)
        return each.health;
    }
    return "";
  }
};

}  // namespace
}  // namespace wiimote_tracker
