#pragma once

#include "capture/camera_monitor.h"
#include "capture/still_spot.h"

#include <Eigen/Core>

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace wiimote_tracker::capture {

struct CornerCaptureOptions {
  int minimum_samples = 50;   ///< Images with exactly one spot that each camera must give.
  int minimum_cameras = 2;    ///< Cameras that must see the LED.
  double spread_limit = 1.5;  ///< Largest StillSpot::spread() [px].
  double drift_limit = 1.0;   ///< Largest StillSpot::drift() [px].
  double timeout = 10.0;      ///< Longest capture [s].
};

/// Where one camera saw the LED.
struct CornerView {
  Eigen::Vector2d pixel;    ///< Mean position, distorted [px].
  double spread = 0.0;      ///< StillSpot::spread() [px].
  std::size_t samples = 0;  ///< Number of images.
};

/// A captured corner, by the names of the cameras that saw it.
using CapturedCorner = std::map<std::string, CornerView>;

/// Captures one corner: the LED lies still while every camera that sees it gives samples. A camera
/// that does not see exactly one spot is left out, and named in the message. So is one whose stamps
/// are later than the capture can last. Times [s] are stamps of images.
class CornerCapture {
 public:
  enum class State { kCollecting, kDone, kRefused };

  CornerCapture(const std::vector<std::string>& cameras,
                const CornerCaptureOptions& options,
                double start_time);

  /// One image that came after the start. Ignored for unknown cameras, when the capture has ended,
  /// when its stamp is before the start or ahead by more than the time-out, and for a camera that
  /// has its samples: the result does not depend on how long the others take.
  void add(const Image& image);

  /// Advances the time: the capture ends when every camera that sees the LED has its samples, or at
  /// the time-out.
  State update(double now);

  State state() const { return state_; }

  /// One sentence: what was captured and which cameras were left out, why it was refused, or what
  /// it still waits for.
  std::string message() const;

  /// Share of the needed samples, of the slowest camera that sees the LED [0..1].
  double progress() const;

  /// Why this camera does not contribute, or not yet. Empty when it has given its samples.
  /// @throws std::out_of_range for unknown cameras.
  std::string problem(const std::string& camera) const;

  /// The samples of this camera so far. @throws std::out_of_range for unknown cameras.
  const StillSpot& spot(const std::string& camera) const { return cameras_.at(camera).spot; }

  /// The cameras that have given their samples.
  CapturedCorner result() const;

 private:
  struct Camera {
    StillSpot spot;
    bool seen = false;          // any image came
    std::string clock;          // what was wrong with the stamp of an image
    std::size_t blobs = 0;      // in the latest image, without masked ones
    std::size_t masked = 0;     // in the latest image
    double last_sample = -1e9;  // time of the latest image with exactly one spot [s]
  };

  bool isAwaited(const Camera& camera) const;
  bool isComplete(const Camera& camera) const;
  std::string movement(const StillSpot& spot) const;
  std::string clockProblem(double stamp) const;
  std::string leftOut() const;
  void refuse(const std::string& message);

  CornerCaptureOptions options_;
  double start_time_;
  double now_;
  std::map<std::string, Camera> cameras_;
  State state_ = State::kCollecting;
  std::string message_;
};

}  // namespace wiimote_tracker::capture
