#ifndef WIIMOTE_TRACKER_TRIANGULATION_BODY_BODY_TRACKER_H
#define WIIMOTE_TRACKER_TRIANGULATION_BODY_BODY_TRACKER_H

#include "wiimote_tracker_triangulation/body/body_estimate.h"
#include "wiimote_tracker_triangulation/body/constellation.h"
#include "wiimote_tracker_triangulation/body/inertial_filter.h"
#include "wiimote_tracker_triangulation/body/inertial_samples.h"
#include "wiimote_tracker_triangulation/body/pose_filter.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"
#include "wiimote_tracker_triangulation/tracking/camera_image.h"
#include "wiimote_tracker_triangulation/tracking/tracker_options.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker::body {

class BodyHistory;
struct BodyImage;
class BodySearch;
struct BodySetup;
struct BodyState;
class BodyUpdate;

struct BodyTrackerOptions : tracking::ImageOptions {
  PoseFilterOptions motion;
  InertialOptions inertial;  ///< Of bodies with an IMU.

  /// Gate: greatest squared Mahalanobis distance of a spot from an LED's prediction [1, > 0].
  double gate = 16.0;

  double prediction_time = 0.5;  ///< A body unseen for longer is lost [s, > 0].
  double tracked_time = 0.03;    ///< Tracked if seen this recently, else predicted [s, > 0].

  // Search for bodies that are not tracked.
  double window = 0.015;         ///< Images this close in time are combined [s, > 0].
  double window_motion = 0.002;  ///< LED motion within the window (std. dev.) [m, > 0].
  double minimum_margin = 15.0;  ///< Least Match::margin to start a body [> 0].
};

/// An LED identified by its blink code.
struct LabelledPoint {
  std::string label;
  Eigen::Vector3d position;    ///< World [m].
  Eigen::Matrix3d covariance;  ///< [m^2], positive definite.
};

/// Tracks rigid bodies by the pixels of each camera image, at the time of that image. Spots of an
/// image are first assigned to the LEDs of tracked bodies. Bodies that are not tracked are searched
/// among the remaining spots of several cameras, by the shape of the constellation, or by the
/// labels of their LEDs. Other remaining spots belong to free LEDs.
///
/// The result depends on the sequence of calls only. Late images are processed in the order of
/// their times. Does not allocate once warm.
class BodyTracker {
 public:
  /// @throws Error (Constellation::check), geometry::InvalidRigError (Rig::check).
  BodyTracker(const geometry::Rig& rig,
              const std::vector<Constellation>& constellations,
              const BodyTrackerOptions& options);
  ~BodyTracker();
  BodyTracker(const BodyTracker&) = delete;
  BodyTracker& operator=(const BodyTracker&) = delete;

  /// Computes the images that are kept (BodyTrackerOptions::history) again with another rig. Bodies
  /// that are hidden in all of them are lost. @throws geometry::InvalidRigError (Rig::check).
  void setRig(const geometry::Rig& rig);

  /// Tracks these bodies from now on. Those that were tracked before, with the same constellation,
  /// go on. @throws Error (Constellation::check).
  void setBodies(const std::vector<Constellation>& constellations);

  /// Adds the spots of a camera's image.
  /// @param time exposure [s]. @param stamp_stddev of that time [s, >= 0].
  /// @param pixels distorted, finite [px].
  /// @param is_doubtful the camera does not fit the others: no body is located by this image.
  /// @returns false, and does nothing, if the image is too old.
  bool add(std::size_t camera,
           double time,
           double stamp_stddev,
           const std::vector<Eigen::Vector2d>& pixels,
           bool is_doubtful = false);

  /// Adds a sample of the IMU of a body, whose constellation has one. A late sample changes the
  /// estimates from the next image on.
  void addInertial(std::size_t body, const InertialSample& sample);

  /// For each spot of the image added last: whether it was assigned to a body.
  const std::vector<bool>& taken() const { return taken_; }

  /// How that image fits the bodies; each counts as one LED.
  const tracking::LedFit& fit() const { return fit_; }

  /// Starts bodies that are unknown, if at least three of their LEDs are among these points at
  /// time() and agree with the constellation.
  void startFromLabels(const std::vector<LabelledPoint>& points);

  double time() const { return time_; }  ///< Of the newest image [s].

  /// One per constellation, at time(); nothing while the body's pose is unknown.
  const std::vector<std::optional<BodyEstimate>>& bodies() const { return estimates_; }

  /// Forgets all state, as after a jump in time.
  void reset();

 private:
  void useRig(const geometry::Rig& rig);
  std::uint64_t firstOutdated(std::uint64_t place);
  void step(std::uint64_t place);
  void dropLost(double time);
  void estimate();

  std::unique_ptr<BodySetup> setup_;
  std::unique_ptr<BodyState> state_;
  std::unique_ptr<BodyHistory> history_;
  std::unique_ptr<BodyUpdate> update_;
  std::unique_ptr<BodySearch> search_;

  double inertial_change_ =
      std::numeric_limits<double>::infinity();  // images after it are outdated
  std::size_t images_since_repeat_ = 0;         // of outdated images

  double time_ = -std::numeric_limits<double>::infinity();
  std::vector<std::optional<BodyEstimate>> estimates_;
  std::vector<bool> taken_;           // see taken()
  tracking::LedFit fit_;              // see fit()
  std::unique_ptr<BodyImage> image_;  // of add(), reused
};

}  // namespace wiimote_tracker::body

#endif  // WIIMOTE_TRACKER_TRIANGULATION_BODY_BODY_TRACKER_H
