#pragma once

#include "ray_agreement.h"
#include "wiimote_tracker_triangulation/tracking/snapshot.h"

#include <boost/container/static_vector.hpp>

#include <array>
#include <cstddef>
#include <limits>
#include <optional>

namespace wiimote_tracker::tracking {

/// Numbers of the cameras that may show one LED, by their latest images.
struct Visibility {
  std::size_t expected = 0;                // should show the LED
  std::size_t in_view = 0;                 // should show it, or show as many others as they can
  std::size_t detected = 0;                // show it
  std::size_t supporting = 0;              // showed it in two of their last four images
  double squared_residuals = 0.0;          // sum over those that show it [px^2]
  std::array<const RayOffset*, 2> rays{};  // of the first two that show it
};

/// What each camera's latest images showed of one LED. Cameras are indices in the rig. Never
/// allocates.
class CameraRecords {
 public:
  /// Missed detection: the camera should have shown the LED and did not.
  void miss(std::size_t camera, double time);

  /// The camera has the LED in view, but shows as many others as it can.
  void noteSaturated(std::size_t camera, double time) { of(camera).last_saturated = time; }

  /// @param squared_residual of the spot [px^2]
  /// @param is_own false: a merged spot that is assigned to another LED.
  void hit(std::size_t camera, double time, double squared_residual, bool is_own);

  /// How far the ray of a camera's last spot was from the prediction.
  void noteRay(std::size_t camera, const RayOffset& ray) { of(camera).ray.add(ray); }

  void clear() { records_.clear(); }

  /// @param since time of the oldest images that count [s]
  Visibility visibility(double since) const;

  double lastDetectedBy(std::size_t camera) const;  // [s]; negative infinity: never

  /// Whether the camera's last image should have shown it and did not.
  bool wasMissedBy(std::size_t camera) const;

  /// Cameras, but one, that detected it at a time [s] or later.
  CameraList detecting(double since, std::optional<std::size_t> except = {}) const;

  /// Number of cameras with a spot of this LED's own at a time [s] or later.
  std::size_t showing(double since) const;

  /// Whether the newest image of some camera with a spot of one of the two LEDs, at a time [s] or
  /// later, has one of the other too.
  bool showBeside(const CameraRecords& other, double since) const;

 private:
  static constexpr double kNever = -std::numeric_limits<double>::infinity();

  struct Record {
    std::size_t camera;
    // Times of the last image [s]:
    double last_expected = kNever;        // that should show the LED
    double last_saturated = kNever;       // that should show it, but has as many spots as it can
    double last_detected = kNever;        // with a spot of the LED
    double last_detected_alone = kNever;  // with a spot that was not assigned to another LED, too
    double squared_residual = 0.0;        // of the last spot [px^2]
    RayOffset ray;                        // of recent spots of its own
    unsigned recent = 0;  // one bit per image, the newest lowest: detected or missed
  };

  Record& of(std::size_t camera);

  boost::container::static_vector<Record, kMaximumCameras> records_;
};

}  // namespace wiimote_tracker::tracking
