#pragma once

#include "geometry/random_rigs.h"
#include "tracking/paths.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"
#include "wiimote_tracker_triangulation/tracking/camera_image.h"
#include "wiimote_tracker_triangulation/tracking/tracker_options.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

namespace wiimote_tracker::tracking::test {

/// Four Wii Remotes around the paper's cube (its Fig. 1), which stands on [0, 2.5] m in x and y;
/// the cameras see well what is 0.3 to 2.2 m above the floor. True lenses as in paper_rig.yaml.
geometry::Rig paperRig();

/// Rooms 100 m apart along x, each with cameras on a circle about its middle (0, 0, 1) m.
geometry::Rig roomsRig(int rooms, int cameras_per_room);

/// Model of the cameras and of the radio, the same for all cameras.
struct SceneOptions {
  double start = 1000.0;        ///< Time of the first exposures [s].
  double period = 0.01;         ///< Of the exposures [s].
  bool synchronised = false;    ///< All cameras expose at once; else at phases of their own.
  double clock_skew = 0.0;      ///< Largest relative error of the cameras' periods [1].
  double pixel_noise = 0.3;     ///< Standard deviation of each coordinate [px].
  bool integer_pixels = false;  ///< Rounded, as a Wii Remote does.
  double dropout = 0.0;         ///< Probability that an image misses an LED that it ought to show.
  double lost_images = 0.0;     ///< Probability that an image never arrives.
  double ghosts = 0.0;          ///< Probability of a ghost in each image, anywhere in it.
  double merging_distance = 0.0;  ///< Spots closer than this become one, in the middle [px].
  std::size_t maximum_spots = 4;  ///< The nearest LEDs win.
  bool equally_bright = false;    ///< At any distance: merged spots win, then the first LEDs.
  double range = 20.0;            ///< Walls: a camera sees no further [m].
  double stamp_noise = 0.0;       ///< Error of the stamp, standard deviation [s].
  double delay = 0.01;            ///< From exposure to arrival [s].
  double delay_jitter = 0.0;      ///< Normal, cut off at -delay; images do not overtake [s].

  /// Pixels of lamps: a spot in every image of that camera.
  std::vector<std::vector<Eigen::Vector2d>> reflections;

  /// Whether an LED is hidden from a camera at a time [s].
  std::function<bool(std::size_t camera, std::size_t led, double time)> hidden;
};

/// For a scene with the default noise, and exact stamps.
inline TrackerOptions exactOptions() {
  TrackerOptions options;
  options.pixel_stddev = SceneOptions().pixel_noise;
  options.stamp_stddev = 0.0;
  return options;
}

/// An image and its ground truth.
struct SceneImage {
  std::size_t camera = 0;
  CameraImage image;
  double true_time = 0.0;  ///< Of the exposure [s].

  /// Of each spot, bit i: LED i made it, or went into it. 0: a ghost or a reflection.
  std::vector<std::uint64_t> leds_of_spot;
};

/// Simulates LEDs and cameras with their own clocks; gives images in the order of arrival, without
/// end.
class Scene {
 public:
  Scene(const geometry::Rig& rig,
        const std::vector<Path>& leds,
        const SceneOptions& options,
        unsigned seed);

  /// Valid until the next call.
  const SceneImage& next();

  const std::vector<Path>& leds() const { return leds_; }

 private:
  struct Clock {
    double next;          // exposure [s]
    double period;        // [s]
    double last_arrival;  // [s]
  };
  struct Light {
    Eigen::Vector2d pixel;
    double distance;  // [m]
    std::uint64_t leds;
  };

  void expose(std::size_t camera);
  void collectLights(std::size_t camera, double time);
  void merge();
  void keepSlots(std::size_t camera, SceneImage* image);

  geometry::Rig rig_;
  std::vector<Path> leds_;
  SceneOptions options_;
  geometry::test::Random random_;
  std::vector<Clock> clocks_;
  std::vector<std::vector<std::uint64_t>> slots_;  // of each camera, what made each slot's spot
  std::vector<SceneImage> on_the_way_;             // a heap, the next to arrive at the front
  std::vector<Light> lights_;
  SceneImage current_;
};

}  // namespace wiimote_tracker::tracking::test
