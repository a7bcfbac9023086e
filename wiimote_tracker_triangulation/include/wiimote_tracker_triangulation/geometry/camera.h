#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <cstddef>
#include <optional>
#include <string>

namespace wiimote_tracker::geometry {

/// How a lens departs from a pinhole; names as in sensor_msgs/distortion_models.h.
enum class DistortionModel {
  kPlumbBob,     ///< "plumb_bob": Brown 1966; k1, k2, p1, p2, k3.
  kEquidistant,  ///< "equidistant": a fisheye lens (Kannala and Brandt 2006, as OpenCV's
                 ///< cv::fisheye); k1, k2, k3, k4.
};

/// All of them.
constexpr std::array<DistortionModel, 2> kDistortionModels = {DistortionModel::kPlumbBob,
                                                              DistortionModel::kEquidistant};

const char* nameOf(DistortionModel model);

/// Nothing for a name that is not known.
std::optional<DistortionModel> distortionModelFromName(const std::string& name);

/// Names of a model's coefficients, such as "k1, k2, k3, k4".
const char* coefficientNames(DistortionModel model);

/// Their number, at most 5.
std::size_t coefficientCount(DistortionModel model);

/// All models with their coefficients, for refusals: "plumb_bob (k1, ...) or equidistant (...)".
std::string describeDistortionModels();

/// Camera with a lens. Pixels: u right, v down, (0, 0) is the centre of the top left pixel.
struct Intrinsics {
  int width = 1024;                    ///< Image size [px].
  int height = 768;                    ///< Image size [px].
  double fx = 1306.3;                  ///< Focal length [px]; the default is the paper's K (2).
  double fy = 1302.3;                  ///< Focal length [px].
  double cx = 535.0;                   ///< Principal point [px].
  double cy = 401.7;                   ///< Principal point [px].
  std::array<double, 5> distortion{};  ///< In the order of the model, then zeros [1].
  DistortionModel distortion_model = DistortionModel::kPlumbBob;

  /// Pixel of a point on the normalised image plane (x/z, y/z) [1].
  /// @param jacobian receives d pixel / d normalized, when it is not null.
  Eigen::Vector2d pixelFromNormalized(const Eigen::Vector2d& normalized,
                                      Eigen::Matrix2d* jacobian = nullptr) const;

  /// Inverse of pixelFromNormalized (Newton's method), exact to 1e-12. Nothing for NaN, and where
  /// the model is not invertible: both models are polynomials that are one to one only up to the
  /// fold, the radius at which their derivative reaches zero. Equidistant lenses are used up to
  /// 1.55 rad off the axis.
  std::optional<Eigen::Vector2d> normalizedFromPixel(const Eigen::Vector2d& pixel) const;

  /// Whether a pixel is in the image, or at most `margin` [px] beyond its outermost pixels'
  /// centres.
  bool isInImage(const Eigen::Vector2d& pixel, double margin = 0.0) const;

  /// @throws InvalidRigError naming the value that is out of range or not finite.
  void check() const;
};

/// One calibrated camera. Optical frame: z forward, x right, y down (REP 103).
struct Camera {
  std::string name;      ///< Namespace of the camera and prefix of its frames.
  std::string identity;  ///< Bluetooth address, lower case with colons; empty if unknown.
  Intrinsics intrinsics;
  Eigen::Isometry3d world_from_camera = Eigen::Isometry3d::Identity();  ///< [m]

  /// Whether both identities are known, and differ.
  bool isOtherDevice(const std::string& other) const {
    return !identity.empty() && !other.empty() && identity != other;
  }

  /// Optical centre in the world [m].
  Eigen::Vector3d center() const { return world_from_camera.translation(); }

  /// Pixel of a world point [m]. Nothing when the point is not in front of the camera, or beyond
  /// the fold of the lens model (Intrinsics::normalizedFromPixel). The pixel may lie outside the
  /// image. @param jacobian receives d pixel / d point [px/m], when it is not null.
  std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& point,
                                         Eigen::Matrix<double, 2, 3>* jacobian = nullptr) const;

  /// Whether the point is in front of the camera and its pixel inside the image.
  bool sees(const Eigen::Vector3d& point) const;
};

/// Measurement noise of the pixel of an LED.
struct PixelNoise {
  double pixel_stddev = 0.5;  ///< Standard deviation of each coordinate [px, > 0].
  double stamp_stddev = 0.0;  ///< Of the image's time; adds noise by the LED's velocity [s, >= 0].
};

/// Whether two poses of a camera are so alike, to 0.002 rad and 5 mm, that another calibration of a
/// camera that was not moved explains the difference.
bool haveSamePose(const Camera& a, const Camera& b);

/// World-from-camera rotation and position of a camera at `position` [m] whose optical axis passes
/// through `target` [m], image x axis horizontal. `up` need not be a unit vector.
/// @throws InvalidRigError when the optical axis would be parallel to `up`.
Eigen::Isometry3d lookAt(const Eigen::Vector3d& position,
                         const Eigen::Vector3d& target,
                         const Eigen::Vector3d& up);

}  // namespace wiimote_tracker::geometry
