#pragma once

#include "wiimote_tracker_triangulation/geometry/calibration_uncertainty.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"
#include "wiimote_tracker_triangulation/tracking/estimator.h"
#include "wiimote_tracker_triangulation/tracking/tracker_options.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace wiimote_tracker::tracking {

class CameraGroup;
class Ids;
class ImageIntake;
class TrackerCamera;
struct StoredImage;

/// Tracks LEDs in continuous time. Each image updates the tracks that its camera may see, at once
/// and at the image's own time. A late image is inserted at its time and the steps after it are
/// repeated before the next snapshot. Cameras that share no view, as those of several rooms, are
/// independent.
///
/// An image newer than all others makes a snapshot of all LEDs at its time. The states are
/// explained in doc/tracking.md; a lost LED is in one snapshot only. The covariance of a position
/// is that of its filter, plus that of the calibration when two cameras see the LED and the rig has
/// one. LEDs that were seen when time jumped back are lost in the first snapshot after the jump.
class Tracker : public Estimator {
 public:
  /// @throws geometry::InvalidRigError (see Rig::check).
  Tracker(const geometry::Rig& rig, const TrackerOptions& options);
  ~Tracker() override;
  Tracker(const Tracker&) = delete;
  Tracker& operator=(const Tracker&) = delete;

  /// While cameras, their places and clocks are the same, everything goes on, as with each step of
  /// a continuous calibration. Else only tracks go on that the new cameras may see.
  void setRig(const geometry::Rig& rig) override;

  void add(std::size_t camera, const CameraImage& image) override;
  const Snapshot* next() override;
  const Counters& counters() const override { return counters_; }
  std::optional<CameraFault> cameraFault(std::size_t camera) const override;
  bool isDoubtful(std::size_t camera) const override;
  ClockError clockError(std::size_t camera, std::uint32_t clock_epoch) const override;

  /// Without lost LEDs.
  bool predictTo(double time, Snapshot* snapshot) override;

 private:
  /// The images of a camera.
  struct Input {
    CameraGroup* group;                // to which they go
    std::size_t dropped_in_a_row = 0;  // images, because they were too late
    double lateness = 0.0;             // of the last of them, behind the newest of all cameras [s]
  };

  /// Per camera of a rig those that share its view.
  using Partners = std::vector<std::vector<std::size_t>>;

  bool hasSameGroups(const geometry::Rig& rig, const Partners& partners) const;
  void useCameras(const geometry::Rig& rig);
  void useRig(const geometry::Rig& rig, const Partners& partners);
  void takeOverTracks(const std::vector<std::unique_ptr<CameraGroup>>& before);
  void reset();
  void complete(const CameraImage& image, StoredImage* stored);
  void updateGroups();
  void report(double time, Snapshot* snapshot) const;
  void addLost();
  void addCalibrationErrors(Snapshot* snapshot);

  TrackerOptions options_;
  std::unique_ptr<ImageIntake> intake_;
  geometry::Rig rig_;
  std::vector<TrackerCamera> cameras_;  // of the rig
  std::vector<std::unique_ptr<CameraGroup>> groups_;
  std::vector<Input> inputs_;  // per camera
  std::unique_ptr<Ids> ids_;
  std::optional<geometry::CalibrationUncertainty> uncertainty_;  // never empty
  std::vector<CameraView> views_;
  Counters counters_;
  std::uint64_t images_ = 0;
  double newest_time_;     // of all used images [s]
  double newest_arrival_;  // of these [s]
  double last_output_;     // [s]
  Snapshot snapshot_;
  std::vector<TrackedLed> before_;  // in the last snapshot, without the lost
};

}  // namespace wiimote_tracker::tracking
