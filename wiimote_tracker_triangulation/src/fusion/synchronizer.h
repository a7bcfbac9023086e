#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_FUSION_SYNCHRONIZER_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_FUSION_SYNCHRONIZER_H

#include "wiimote_tracker_triangulation/fusion/frame.h"
#include "wiimote_tracker_triangulation/fusion/frame_history.h"
#include "wiimote_tracker_triangulation/fusion/instant_fuser.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"
#include "wiimote_tracker_triangulation/tracking/camera_image.h"
#include "wiimote_tracker_triangulation/tracking/estimator.h"

#include <Eigen/Core>

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

namespace wiimote_tracker::fusion {

/// A spot at an instant.
struct SpotThen {
  Eigen::Vector2d pixel;  ///< Distorted [px].
  double observed;        ///< Newest image not after the instant that shows it [s].
};

/// What one camera saw at an instant.
struct ViewThen {
  std::optional<double> exposure;  ///< Newest image not after the instant [s].
  bool is_watching = false;        ///< There are images on both sides of the instant.
  bool is_full = false;            ///< As many spots as the camera can report.
  std::vector<SpotThen> spots;
  std::vector<Eigen::Vector2d> masked;  ///< [px]
};

/// Brings the images of cameras that are not synchronised to one time each, and says when (see
/// InstantFuser).
class Synchronizer {
 public:
  explicit Synchronizer(const InstantFuserOptions& options) : options_(options) {}

  /// Forgets all images, not which instants there were. The rig must be good (Rig::check).
  void setRig(const geometry::Rig& rig);

  void add(std::size_t camera, const tracking::CameraImage& image, tracking::Counters* counters);

  /// Goes on to the next instant; false when none is due.
  bool advance();

  // The instant.
  double time() const { return time_; }
  double latestArrival() const { return latest_arrival_; }       ///< Of the images looked at [s].
  double skew() const { return skew_; }                          ///< To the furthest of them [s].
  const std::vector<ViewThen>& views() const { return views_; }  ///< In the order of the rig.

 private:
  struct CameraState {
    geometry::RigCamera calibration;
    FrameHistory<Frame> frames;
  };

  void begin(double arrival);
  void readFrame(const geometry::RigCamera& camera, const tracking::CameraImage& image);
  double reachedByAll() const;
  void look(const CameraState& camera, ViewThen* view);

  InstantFuserOptions options_;
  std::vector<CameraState> cameras_;
  bool has_begun_ = false;
  double begun_at_ = 0.0;        // arrival of the first image
  double newest_arrival_ = 0.0;  // of all cameras
  double time_ = -std::numeric_limits<double>::infinity();
  double latest_arrival_ = 0.0;
  double skew_ = 0.0;
  std::vector<ViewThen> views_;
  Frame frame_;  // reused
};

}  // namespace wiimote_tracker::fusion

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_FUSION_SYNCHRONIZER_H
