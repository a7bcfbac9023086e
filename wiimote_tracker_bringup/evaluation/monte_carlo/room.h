#pragma once

#include "description.h"
#include "remote_camera.h"
#include "virtual_camera.h"

#include "wiimote_tracker_driver/exposure_clock/exposure_clock.h"
#include "wiimote_tracker_driver/virtual_wiimote/frame_times.h"
#include "wiimote_tracker_triangulation/estimators/make_estimator.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace wiimote_tracker::monte_carlo {

/// Position of an LED [m, world] at a time [s].
using Path = std::function<Eigen::Vector3d(double)>;

/// Whether an LED is dark for a camera at an exposure time [s], as by occlusion or blinking.
using Hidden = std::function<bool(std::size_t camera, std::size_t led, double time)>;

struct RoomImage {
  std::size_t camera = 0;
  double exposure = 0.0;  ///< True [s]; the arrival, and the driver's estimate, are in the image.
  tracking::CameraImage image;
};

/// LEDs seen by the cameras of a description, in simulated time: each camera exposes by its own
/// clock, lens and noise are those of the description, the sensor is that of a virtual Wii Remote,
/// and images are delayed or lost.
class Room {
 public:
  Room(const simulation::Description& description,
       const std::vector<Path>& leds,
       std::uint32_t seed,
       const Hidden& hidden = {});

  /// The next image in the order of arrival; endless. Valid until the next call.
  const RoomImage& next();

 private:
  struct Camera {
    simulation::VirtualCamera optics;
    RemoteCamera sensor;
    virtual_wiimote::FrameTimes times;
    virtual_wiimote::FrameTime coming;
    exposure_clock::ExposureClock clock;
  };

  void expose(std::size_t number);

  std::vector<Path> leds_;
  Hidden hidden_;
  std::vector<Camera> cameras_;
  std::vector<RoomImage> on_the_way_;  // a heap; the next to arrive is in front
  std::vector<simulation::Lamp> lamps_;
  RoomImage current_;
};

/// All images exposed in the first `duration` [s], in the order of arrival.
std::vector<RoomImage> record(Room* room, double duration);

/// The images with their arrivals as stamps, as if the driver estimated nothing.
std::vector<RoomImage> stampedByArrival(std::vector<RoomImage> images);

/// Median lateness of the images' stamps [s]. A common part for all cameras cannot be estimated
/// from the arrivals; it only shifts the times of points.
double medianLateness(const std::vector<RoomImage>& images);

/// Tracks the images. `take` gets each snapshot, with its time without the median lateness of the
/// images' stamps [s].
void trackImages(const geometry::Rig& rig,
                 const estimators::EstimatorOptions& options,
                 const std::vector<RoomImage>& images,
                 const std::function<void(double time, const tracking::Snapshot& snapshot)>& take);

/// A description with only its first `count` cameras.
simulation::Description withCameras(const simulation::Description& description, std::size_t count);

/// The cameras of a description as an exactly known rig.
geometry::Rig trueRig(const simulation::Description& description);

}  // namespace wiimote_tracker::monte_carlo
