#pragma once

#include "body/body_estimate.h"
#include "body/body_search.h"
#include "body/body_setup.h"
#include "body/body_state.h"
#include "body/body_update.h"
#include "body/constellation.h"
#include "body/inertial_samples.h"
#include "body/solve_pose.h"
#include "tracking/history.h"
#include "tracking/image_intake.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"
#include "wiimote_tracker_triangulation/tracking/camera_image.h"
#include "wiimote_tracker_triangulation/tracking/estimator.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker::body {

/// The bodies at the time of an image.
struct BodySnapshot {
  double time = 0.0;            ///< [s]
  double latest_arrival = 0.0;  ///< Of the newest image [s].

  /// One per constellation; nothing while the body's pose is unknown. A body that was lost since
  /// the snapshot before is there once more.
  std::vector<std::optional<BodyEstimate>> bodies;
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
  /// Without bodies, and without a rig, which must be set before the first image.
  explicit BodyTracker(const BodyTrackerOptions& options);

  /// The same with both. @throws as setRig() and setBodies().
  BodyTracker(const geometry::Rig& rig,
              const std::vector<Constellation>& constellations,
              const BodyTrackerOptions& options);
  BodyTracker(const BodyTracker&) = delete;
  BodyTracker& operator=(const BodyTracker&) = delete;

  /// Computes the images that are kept (BodyTrackerOptions::history) again with another rig. Bodies
  /// that are hidden in all of them are lost. Where a time offset jumps, bodies are searched anew.
  /// @throws geometry::InvalidRigError (Rig::check); the previous rig then stays.
  void setRig(const geometry::Rig& rig);

  /// Tracks these bodies from now on. Those that were tracked before, with the same constellation,
  /// go on.
  /// @returns the latest snapshot of the bodies before: those that do not go on, as lost.
  /// @throws Error (Constellation::check); the previous bodies then stay.
  BodySnapshot setBodies(const std::vector<Constellation>& constellations);

  const std::vector<Constellation>& constellations() const { return constellations_; }

  /// Tracks bodies in an image and removes their spots from it, before it goes to the tracking of
  /// free LEDs. @param clock see Estimator::clockError().
  /// @param is_doubtful see Estimator::isDoubtful(): no body is located by this image.
  void take(std::size_t camera,
            const tracking::ClockError& clock,
            tracking::CameraImage* image,
            bool is_doubtful = false);

  /// The snapshot after the last image if it is newer than all before, else null. Valid until the
  /// next call.
  const BodySnapshot* next();

  /// Adds a sample of the IMU of a body, whose constellation has one. A late sample changes the
  /// estimates from the next image on.
  void addInertial(std::size_t body, const InertialSample& sample);

  /// Starts bodies that are unknown, if at least three of their LEDs are among these points at
  /// time() and agree with the constellation.
  void startFromLabels(const std::vector<LabelledPoint>& points);

  double time() const { return time_; }  ///< Of the newest image [s].

  /// One per constellation, at time(); nothing while the body's pose is unknown.
  const std::vector<std::optional<BodyEstimate>>& bodies() const { return estimates_; }

 private:
  void useRig(const geometry::Rig& rig);
  void replaceBodies(const std::vector<Constellation>& constellations);
  std::uint64_t firstOutdated(std::uint64_t place);
  void step(const BodyImage& image);
  void dropLost(double time);
  void estimate();
  void reset();

  std::vector<Constellation> constellations_;
  BodySetup setup_;
  BodyState state_;
  tracking::ImageIntake intake_;
  tracking::History<BodyImage, BodyState> history_;
  BodyUpdate update_;
  std::optional<BodySearch> search_;  // nothing without a rig

  double inertial_change_ =
      std::numeric_limits<double>::infinity();  // images after it are outdated
  std::size_t images_since_repeat_ = 0;         // of outdated images

  double time_ = -std::numeric_limits<double>::infinity();
  std::vector<std::optional<BodyEstimate>> estimates_;
  std::vector<bool> taken_;      // spots of the last image, by a body
  BodyImage image_;              // the last one; reused
  double latest_arrival_ = 0.0;  // [s]
  double last_output_ = -std::numeric_limits<double>::infinity();
  BodySnapshot snapshot_;
};

}  // namespace wiimote_tracker::body
