#pragma once

#include "geometry/random_rigs.h"
#include "ros/tracker/point_message.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>

/// A snapshot of one LED before three cameras, and its message.
namespace wiimote_tracker {

inline const Eigen::Vector3d kLed(0.1, 0.2, 0.3);

inline geometry::Rig threeCameras() {
  geometry::test::Random random(71);
  return geometry::test::randomRig(random, 3);
}

inline tracking::TrackedLed someLed(std::uint32_t id,
                                    double time,
                                    const Eigen::Vector3d& position) {
  tracking::TrackedLed led;
  led.id = id;
  led.state = tracking::TrackState::kTracked;
  led.position = position;
  led.position_covariance << 4e-6, 1e-6, 0.0, 1e-6, 9e-6, 0.0, 0.0, 0.0, 1e-6;
  led.cameras = {0, 1};
  led.rays_possible = 3;
  led.residual = 0.25;
  led.first_seen = 98.0;
  led.last_observed = time - 0.001;
  return led;
}

/// Cameras 0 and 1 see the LED, camera 2 does not.
inline tracking::Snapshot someSnapshot(const geometry::Rig& rig, double time = 100.0) {
  tracking::Snapshot snapshot;
  snapshot.time = time;
  snapshot.latest_arrival = time + 0.03;
  snapshot.skew = 0.004;
  snapshot.leds = {someLed(0, time, kLed)};
  snapshot.views.resize(3);
  for (std::size_t i = 0; i < 3; ++i)
    snapshot.views[i].time = time - 0.001 * i;
  for (std::size_t i = 0; i < 2; ++i)
    snapshot.views[i].spots = {
        {*rig.cameras[i].camera.project(kLed), tracking::SpotUse::kAssigned, 0}};
  return snapshot;
}

inline wiimote_tracker_msgs::TrackedPointArray messageOf(const tracking::Snapshot& snapshot,
                                                         const geometry::Rig& rig) {
  identity::LedLabels labels({"led"});
  labels.update(snapshot.time, snapshot.leds);
  return pointMessage(snapshot, rig, labels);
}

}  // namespace wiimote_tracker
