#ifndef WIIMOTE_TRACKER_BRINGUP_EVALUATION_MONTE_CARLO_ROOM_H
#define WIIMOTE_TRACKER_BRINGUP_EVALUATION_MONTE_CARLO_ROOM_H

#include "description.h"
#include "remote_camera.h"
#include "virtual_camera.h"

#include "wiimote_tracker_driver/exposure_clock/exposure_clock.h"
#include "wiimote_tracker_driver/virtual_wiimote/frame_times.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"
#include "wiimote_tracker_triangulation/tracking/camera_image.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace wiimote_tracker::monte_carlo {

/// Where an LED is [m, world] at a time [s].
using Path = std::function<Eigen::Vector3d(double)>;

/// How an image comes by its stamp.
enum class Stamping {
  kExact,      ///< The exposure itself: nobody can have that.
  kEstimated,  ///< The driver's exposure clock, from the arrivals.
  kArrival,    ///< The arrival.
};

struct RoomOptions {
  bool synchronised = false;  ///< All cameras expose at once; else each by its own clock.
  Stamping stamping = Stamping::kEstimated;
  std::string sensitivity = "wii_3";  ///< Of all cameras.
  double led_size = 3.0;              ///< As the sensor reports it; nearer than that, LEDs merge.

  /// Whether an LED is dark for a camera whose exposure is at this time [s]: something is in the
  /// way, or it blinks.
  std::function<bool(std::size_t camera, std::size_t led, double time)> hidden;
};

struct RoomImage {
  std::size_t camera = 0;
  double exposure = 0.0;  ///< True [s]; arrival and stamp are in the image.
  tracking::CameraImage image;
};

/// LEDs before the cameras of a description, in simulated time: each exposes by its own clock, the
/// lens and noise are the description's, the sensor is a virtual Wii Remote's, and the images
/// arrive late, in order, or not at all.
class Room {
 public:
  Room(const simulation::Description& description,
       const std::vector<Path>& leds,
       const RoomOptions& options,
       std::uint32_t seed);

  /// The next image in the order of arrival, for ever. Valid until the next call.
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
  RoomOptions options_;
  std::vector<Camera> cameras_;
  std::vector<RoomImage> on_the_way_;  // a heap, the next to arrive at the front
  std::vector<simulation::Lamp> lamps_;
  RoomImage current_;
};

/// All images that are exposed in the first `duration` [s], in the order of arrival.
std::vector<RoomImage> record(Room* room, double duration);

/// By how much the images' stamps are late, median [s]: what all cameras have in common of it can
/// be told by no arrival, and shifts nothing but the time of a point.
double medianLateness(const std::vector<RoomImage>& images);

/// A description with only its first cameras, at most so many.
simulation::Description withCameras(const simulation::Description& description, std::size_t count);

/// The cameras of a description as a rig that is exactly known.
geometry::Rig trueRig(const simulation::Description& description);

}  // namespace wiimote_tracker::monte_carlo

#endif  // WIIMOTE_TRACKER_BRINGUP_EVALUATION_MONTE_CARLO_ROOM_H
