#pragma once

#include "wiimote_tracker_triangulation/geometry/camera.h"
#include "wiimote_tracker_triangulation/remap/remap.h"

#include <Eigen/Core>

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker::geometry {

enum class RayModel { kCalibrated, kImageCenter };
enum class TimeOffsetRule { kNone, kAlways, kOneEpoch };

/// Farthest LED that a Wii Remote sees [m].
constexpr double kFarthestLed = 12.0;

/// A round region of the image in which light is ignored.
struct ImageMask {
  Eigen::Vector2d center;  ///< [px]
  double radius;           ///< [px, > 0]
};

/// Whether light at this pixel is to be ignored.
bool isMasked(const std::vector<ImageMask>& masks, const Eigen::Vector2d& pixel);

/// A named box of the world.
struct Zone {
  std::string name;
  Eigen::Vector3d minimum;  ///< [m]
  Eigen::Vector3d maximum;  ///< [m]
};

/// Where the world lies in a calibration square, whose own axes are: origin at the first corner, x
/// towards the second, y towards the fourth.
struct SquarePose {
  Eigen::Vector2d origin;  ///< World's origin in the square's axes [m].
  double yaw;              ///< From the square's x axis to the world's x axis, about z [rad].
};

/// A camera of a rig and its calibration. Fields as in CameraCalibration.msg; NaN and empty mean
/// unknown.
struct RigCamera {
  Camera camera;
  double time_offset = std::numeric_limits<double>::quiet_NaN();  ///< [s]
  TimeOffsetRule time_offset_rule = TimeOffsetRule::kNone;
  std::uint32_t time_offset_epoch = 0;
  std::optional<Eigen::Vector3d> gravity;  ///< Specific force at rest, optical frame [m/s^2].
  std::vector<ImageMask> masks;
  double residual_px = std::numeric_limits<double>::quiet_NaN();
  double residual_m = std::numeric_limits<double>::quiet_NaN();
  std::uint32_t observations = 0;
  std::uint32_t inliers = 0;

  /// What to add to the stamps of images while its clock is in this epoch [s]; nothing where that
  /// is not known.
  std::optional<double> timeOffsetIn(std::uint32_t clock_epoch) const;

  /// Whether it reconnected after its time offset was calibrated. Epochs are counted from 0 at each
  /// start of a driver, over the same link with the same offset: a lower one is not new.
  bool hasNewClock(std::uint32_t clock_epoch) const {
    return time_offset_rule == TimeOffsetRule::kOneEpoch && clock_epoch > time_offset_epoch;
  }
};

/// Standard deviation of a camera's pixel coordinates [px]: if `use_learnt`, that of the residual
/// with which it was calibrated, within 0.1 and 2. Many moving spots tell it; the four still
/// corners of a square do not. Else pixel_stddev.
double pixelNoise(const RigCamera& camera, bool use_learnt, double pixel_stddev);

/// All cameras of a rig, calibrated together. Fields as in RigCalibration.msg.
struct Rig {
  std::string world_frame = "world";
  double solved_at = 0.0;  ///< When it was solved [s since 1970].
  std::string method;
  RayModel ray_model = RayModel::kCalibrated;
  double virtual_hfov = std::numeric_limits<double>::quiet_NaN();  ///< [rad]
  std::vector<double> square_sides;                                ///< Along x, along y [m].
  std::optional<SquarePose> square_pose;  ///< Only in files. Nothing: unknown, as in older ones.
  double led_height = std::numeric_limits<double>::quiet_NaN();  ///< [m]
  std::vector<RigCamera> cameras;

  /// Order as in RigCalibration.msg, but 16 per camera whatever its lens: an equidistant one has
  /// k1 to k4, then zeros. 0x0: unknown.
  Eigen::MatrixXd covariance;

  /// Correction of the volume. It may belong to another calibration (remap::Remap::rig_id is not
  /// id()); then it is not applied, and kept so that a message can say so.
  std::optional<remap::Remap> remap;
  std::vector<Zone> zones;
  std::string verdict;

  /// Nothing when there is no camera of that name.
  const RigCamera* find(const std::string& name) const;

  /// Names of its frames in TF: world_frame, that of the calibration square, then those of the
  /// cameras and of their accelerometers.
  std::vector<std::string> frames() const;

  /// Names a camera too far from all others to see an LED with one of them, as where millimetres
  /// were typed for metres: what is wrong, and what to do. Empty: there is none.
  std::string describeFarCamera() const;

  /// The camera to build rays with: the calibrated one or, with RayModel::kImageCenter, the paper's
  /// virtual model at the same place: a pinhole without distortion whose principal point is the
  /// image centre (width / 2, height / 2) and whose focal length is the calibrated one, or
  /// (width / 2) / tan(virtual_hfov / 2) in both axes when virtual_hfov is not NaN.
  Camera rayCamera(const RigCamera& camera) const;

  /// Of all cameras. Whoever asks where their spots are, or what they see, needs these.
  std::vector<Camera> rayCameras() const;

  /// Hash (16 hexadecimal digits) over everything that changes a triangulated point: world frame,
  /// ray model, and each camera's name, identity, intrinsics, pose, time offset and masks, in the
  /// order of cameras. The correction of the volume is not included: it names the id it belongs to.
  /// Equal rigs have equal ids on every machine, also after a round trip through a file or a
  /// message: poses are compared as canonicalQuaternion (rotation.h) stores them.
  std::string id() const;

  /// @throws InvalidRigError: no camera, two of one name, values out of range or not finite.
  /// Error: a correction of the volume that is damaged (Remap::check).
  void check() const;
};

/// Whether the two are one device with one clock in one place (haveSamePose), so that what was
/// seen with one calibration goes on with the other. Masks and lens may differ.
bool isSameCamera(const RigCamera& a, const RigCamera& b);

/// Whether both have cameras of the same names, in the same order.
bool haveSameCameras(const Rig& a, const Rig& b);

/// Optical frame of a camera: its name without a leading slash, other slashes as underscores,
/// + "_optical_frame".
std::string opticalFrame(const std::string& camera_name);

/// The same without "_optical_frame". The camera-info file has this name, too.
std::string withoutSlashes(const std::string& camera_name);

/// @returns which two of these cameras share an optical frame and a camera-info file, as a/b and
/// a_b, and what to do; empty when no two do.
std::string nameClash(const std::vector<std::string>& camera_names);

}  // namespace wiimote_tracker::geometry
