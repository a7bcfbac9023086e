#pragma once

#include "wiimote_tracker_triangulation/fusion/frame_history.h"
#include "wiimote_tracker_triangulation/fusion/instant_fuser.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"
#include "wiimote_tracker_triangulation/tracking/camera_image.h"
#include "wiimote_tracker_triangulation/tracking/estimator.h"
#include "wiimote_tracker_triangulation/tracking/snapshot.h"

#include <Eigen/Core>

#include <cstddef>
#include <limits>
#include <vector>

namespace wiimote_tracker::fusion {

constexpr int kNoSpot = -1;

/// A spot of an image, and the same LED's spot in the image before.
struct FrameSpot : tracking::Spot {
  int before = kNoSpot;                                ///< Index in the image before.
  Eigen::Vector2d velocity = Eigen::Vector2d::Zero();  ///< Since then [px/s]; 0 with kNoSpot.
};

/// One image of a camera.
struct Frame {
  double time = 0.0;     ///< Of the exposure [s].
  double arrival = 0.0;  ///< When it reached the computer [s].
  bool is_full = false;  ///< As many spots as the camera can report.
  std::vector<FrameSpot> spots;
  std::vector<Eigen::Vector2d> masked;  ///< Pixels of spots that are ignored.
};

/// Fills in `before` and `velocity` of an image's spots: the assignment to the spots before, each
/// predicted with its velocity, with the least sum of squared distances. The gate is
/// `maximum_speed` [px/s]. A changed slot costs a little. Exact for up to 16 spots each; those
/// beyond are not followed.
void followSpots(const Frame& before, double maximum_speed, Frame* frame);

/// One camera's view at an instant: interpolated spots, then the masked ones of its newest image
/// not after the instant, whose time is the view's.
struct InstantView : tracking::CameraView {
  bool is_watching = false;  ///< There are images on both sides of the instant.
};

/// Chooses the instants and interpolates the images of unsynchronised cameras to them (see
/// InstantFuser).
class Synchronizer {
 public:
  explicit Synchronizer(const InstantFuserOptions& options) : options_(options) {}

  /// Forgets all images, but not the last instant. @param rig has passed Rig::check.
  void setRig(const geometry::Rig& rig);

  void add(std::size_t camera, const tracking::CameraImage& image, tracking::Counters* counters);

  /// Advances to the next instant; false when none is due.
  bool advance();

  // The instant.
  double time() const { return time_; }
  double latestArrival() const { return latest_arrival_; }  ///< Of the images used [s].
  double skew() const { return skew_; }                     ///< To the furthest of them [s].
  const std::vector<InstantView>& views() const { return views_; }  ///< In the order of the rig.

 private:
  struct CameraState {
    geometry::RigCamera calibration;
    FrameHistory<Frame> frames;
  };

  void noteArrival(const FrameHistory<Frame>& frames, tracking::Counters* counters);
  void jumpBack(tracking::Counters* counters);
  void begin(double arrival);
  void readFrame(const geometry::RigCamera& camera, const tracking::CameraImage& image);
  double reachedByAll() const;
  void interpolate(const CameraState& camera, InstantView* view);

  InstantFuserOptions options_;
  std::vector<CameraState> cameras_;
  bool has_begun_ = false;
  double begun_at_ = 0.0;                                             // arrival of the first image
  double newest_arrival_ = -std::numeric_limits<double>::infinity();  // of all cameras
  double former_arrival_ = -std::numeric_limits<double>::infinity();  // the same, of the rig before
  double time_ = -std::numeric_limits<double>::infinity();
  double latest_arrival_ = 0.0;
  double skew_ = 0.0;
  std::vector<InstantView> views_;
  Frame frame_;  // reused
};

}  // namespace wiimote_tracker::fusion
