#pragma once

#include "capture/image.h"
#include "capture/views.h"

#include <wiimote_tracker_triangulation/geometry/rig.h>
#include <wiimote_tracker_triangulation/geometry/sight.h>

#include <Eigen/Core>

#include <cstddef>
#include <deque>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace wiimote_tracker::health {

struct DriftOptions {
  double limit = 0.7;  ///< Largest median residual of a camera that did not move [px, > 0].
  /// Over which the median is taken; add() judges twelve times in it [s, > 0].
  double window = 60.0;
  /// While fewer samples in it show the LED to three cameras, as of LEDs that hide each other, the
  /// window is longer, up to four times.
  std::size_t samples = 0;
};

/// Pixels of the LED in two cameras or more at one time, with the cameras' indices in the rig,
/// ascending.
struct DriftSample {
  double time;  ///< [s]
  std::vector<std::pair<std::size_t, geometry::Sight>> sights;
};
using DriftSamples = std::deque<DriftSample>;

/// How far a camera's images are from what the other cameras see.
struct Drift {
  /// Median residual (predicted less observed); with one other camera only, its size across the
  /// epipolar line, in x [px].
  Eigen::Vector2d bias = Eigen::Vector2d::Zero();
  /// Of the residuals around the bias, standard deviation, root of trace [px].
  double scatter = 0.0;
  double stddev = 0.0;    ///< Of the bias, from noise and from the calibration: root of trace [px].
  double ratio = 0.0;     ///< Of the bias to the tolerance; 1 or more: drifted [1].
  std::string or_camera;  ///< The other camera, if one of both drifted and it is unknown which.
  bool or_others = false;      ///< Several drifted, perhaps not this one.
  std::string exchanged_with;  ///< The camera in whose place it seems to stand, if one does.
};

/// Per camera of a rig; nothing: it was not judged.
using Drifts = std::vector<std::optional<Drift>>;

/// How far each camera of a rig is off in these images, by the default limit.
Drifts driftsOf(const geometry::Rig& rig, const std::vector<capture::Image>& images);

/// Whether so many cameras at least were judged, and none contradicts the others.
bool allFit(const Drifts& drifts, std::ptrdiff_t cameras = 3);

/// Watches the median of a rig's residuals while one LED is tracked. Images of several spots take
/// no part: LedSelection leaves one. A rig with RayModel::kImageCenter is not judged: its rays
/// differ from its calibration.
class DriftWatch {
 public:
  DriftWatch(const geometry::Rig& rig, const DriftOptions& options);

  /// One image of any camera; of one camera in the order of their stamps.
  /// @returns true when a new judgement is there.
  bool add(const capture::Image& image);

  /// Judges the window now; add() does so twelve times in it.
  void judge();

  /// At the time of the latest judgement. Nothing for cameras that shared too little motion with
  /// others in the window.
  const Drifts& drifts() const { return drifts_; }

  /// Why a camera without a judgement has none.
  std::string whyNotJudged(std::size_t camera) const;

 private:
  struct Camera {
    geometry::Camera rays;
    std::vector<capture::Spot> spots;  // By the time of the exposure, from the next sample on.
    bool clock_known = false;          // The time offset holds for the latest image.
    double late = 0.0;  // By how much the latest image was older than the newest of all [s].
    std::size_t later_than = 0;                  // The camera of that newest image.
    std::optional<Eigen::Vector2d> last_sample;  // [px]
  };
  void sampleUntil(double time);
  bool hasEnoughSamples() const;
  void sampleAt(double time);
  void restart();

  geometry::Rig rig_;
  DriftOptions options_;
  std::vector<Camera> cameras_;
  DriftSamples samples_;
  double newest_ = -std::numeric_limits<double>::infinity();  // Latest exposure [s].
  std::size_t newest_camera_ = 0;
  double next_sample_ = 0.0;     // [s]
  double next_judgement_ = 0.0;  // [s]
  Drifts drifts_;
};

}  // namespace wiimote_tracker::health
