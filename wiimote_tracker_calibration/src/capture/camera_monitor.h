#pragma once

#include "capture/image.h"

#include <Eigen/Core>

#include <deque>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace wiimote_tracker::capture {

/// The recent images of one camera, summarised.
struct CameraSummary {
  bool connected = false;                                  ///< Images arrive.
  double rate = std::numeric_limits<double>::quiet_NaN();  ///< [Hz]; NaN until two images came.
  std::size_t blobs = 0;                                   ///< In the latest image.
  bool sees_led = false;  ///< Exactly one spot, in nearly all images of the window.
  Eigen::Vector2d pixel =
      Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());  ///< Of that spot.
  std::string problem;  ///< One sentence that says what to do; empty when all is well.
};

/// The problems of cameras, each a name and what follows it, as CameraSummary::problem; those that
/// have the same one are named together.
std::string listOfProblems(const std::vector<std::pair<std::string, std::string>>& problems);

/// Summarises the images of one camera. Times [s] are to be of one clock; when it is set back,
/// earlier images are forgotten.
class CameraMonitor {
 public:
  /// Images older than this are forgotten [s].
  static constexpr double kMemory = 10.0;

  /// @param time stamp of the image; @param arrival when it came.
  void add(double time, const Blobs& blobs, double arrival);

  /// Summary of the images of the last `window` seconds (up to kMemory).
  CameraSummary summary(double now, double window = 1.0) const;

 private:
  struct Image {
    double time;
    std::size_t blobs;
  };

  std::deque<Image> images_;
  double arrival_ = 0.0;  // of the latest image [s]
  Eigen::Vector2d first_blob_ = Eigen::Vector2d::Zero();
};

/// An image that comes later after its stamp was stamped by another clock [s].
inline constexpr double kLongestDelay = 1.0;

/// What is wrong with the stamp [s] of an image that came so long after it [s], and what to do;
/// empty when nothing is.
std::string stampProblem(double stamp, double delay);

/// Why a camera without images sees nothing, and what to do.
inline constexpr char kSendsNoImages[] =
    "sends no images: check its battery, its connection and its driver";

/// Why a camera with this many spots does not see the LED, and what to do; empty for one spot.
std::string spotCountProblem(std::size_t blobs);

}  // namespace wiimote_tracker::capture
