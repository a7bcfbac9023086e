#pragma once

#include "drawing.h"
#include "led_motion.h"

#include "wiimote_tracker_driver/virtual_wiimote/frame_times.h"
#include "wiimote_tracker_triangulation/geometry/camera.h"
#include "wiimote_tracker_triangulation/identity/waveform.h"

#include <Eigen/Core>

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker::simulation {

/// A true camera. Its optical frame follows from position and look_at, with a horizontal image x
/// axis.
struct CameraDescription {
  geometry::Camera camera;
  virtual_wiimote::FrameTimesModel timing;
};

/// The other end of a wand: turns about another LED.
struct TurnDescription {
  std::string around;     ///< Name of the other LED.
  double distance = 0.0;  ///< Length of the wand [m].
  double rate = 0.0;      ///< About the vertical [rad/s], while nodding.
};

/// Periodic blinking of an LED.
struct Blink {
  identity::Waveform waveform;
  double period = 1.0;  ///< [s, > 0]
  double begin = 0.0;   ///< Start of one of its periods [s].

  /// Share of the exposure around `time` [s] in which the LED is on [0..1], which scales its
  /// brightness. An exposure lasts 1 ms here; that of a Wii Remote is unknown.
  double light(double time) const {
    constexpr double kExposure = 0.001;  // [s]
    return identity::litShare(waveform, (time - 0.5 * kExposure - begin) / period,
                              kExposure / period);
  }
};

/// An LED; simulation/set_led changes how it moves and whether it is lit.
struct LedDescription {
  std::string name;
  LedMotion motion = LedMotion(Eigen::Vector3d::Zero());  ///< Ignored with `turns`.
  std::optional<TurnDescription> turns;

  /// Name of a person or rigid body in whose axes (see carriers.h) the motion is; or empty.
  std::string carried_by;
  std::optional<double> size;  ///< As of a Lamp [0..15].
  double brightness = 1.0;     ///< As of a Lamp [>= 0].
  bool lit = true;
  std::optional<Blink> blink;  ///< While lit; not set: steady light.
};

/// A person standing or walking on the floor: an upright cylinder that occludes LEDs. While they
/// are not present, the LEDs that they carry are not seen.
struct PersonDescription {
  std::string name;
  LedMotion motion = LedMotion(Eigen::Vector3d::Zero());  ///< z is ignored.
  double turn_rate = 0.0;                                 ///< About the vertical [rad/s].
  double radius = 0.2;                                    ///< [m]
  double height = 1.75;                                   ///< [m]
  bool present = true;
};

/// Rotation of a body: steady, swaying as in a hand, or both.
struct TurningDescription {
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< In the world, of any length except 0.
  double rate = 0.0;                                ///< About this axis [rad/s].
  double sway = 0.0;       ///< Amplitude about its own z axis, and 0.6 of it about x [rad].
  double sway_rate = 1.0;  ///< [rad/s]
};

/// A moving rigid body with LEDs, which are seen while it is present. It occludes nothing.
struct RigidBodyDescription {
  std::string name;
  LedMotion motion = LedMotion(Eigen::Vector3d::Zero());  ///< Of its origin.
  TurningDescription turning;
  bool present = true;
};

/// A reflection, as of a lamp in a window: a spot at a fixed place in one camera's image.
struct ReflectionDescription {
  std::string name;
  std::string camera;                               ///< Name of the camera.
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  ///< In the image, v down [px].
  std::optional<double> size;                       ///< As of a Lamp [0..15].
  double brightness = 1.0;                          ///< At the camera [>= 0].
  bool lit = true;
};

/// A board of 4 x 4 LEDs in front of one camera.
struct BoardDescription {
  std::string before;            ///< Name of the camera.
  double column_spacing = 0.08;  ///< [m]
  double row_spacing = 0.08;     ///< [m]
  double size = 3.0;             ///< Of each LED, as of a Lamp [0..15].
};

/// The thing of this name; null: there is none.
template <typename Things>
auto findNamed(Things& things, const std::string& name) {
  const auto found = std::find_if(things.begin(), things.end(),
                                  [&](const auto& thing) { return thing.name == name; });
  return found == things.end() ? nullptr : &*found;
}

/// A simulated rig. z points up in the world.
struct Description {
  std::string world_frame = "world";
  std::uint32_t seed = 1;
  double pixel_noise = 0.3;   ///< Standard deviation of each pixel coordinate [px].
  double truth_rate = 200.0;  ///< [Hz]
  std::vector<CameraDescription> cameras;
  std::vector<LedDescription> leds;
  std::vector<PersonDescription> people;
  std::vector<RigidBodyDescription> bodies;
  std::vector<ReflectionDescription> reflections;
  std::optional<BoardDescription> board;
  std::map<std::string, Drawing> drawings;  ///< By name.
};

/// Reads a description (layout: paper_rig.yaml, people_rig.yaml, body_rig.yaml). Unknown keys are
/// refused. @throws Error naming the file, the key and what is wrong.
Description readDescription(const std::string& path);

}  // namespace wiimote_tracker::simulation
