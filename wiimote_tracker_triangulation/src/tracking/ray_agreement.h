#pragma once

#include <Eigen/Core>

#include <limits>

namespace wiimote_tracker::tracking {

struct Visibility;

/// How far a camera's rays are from the predictions of a track: of one spot, or the mean of recent
/// spots.
struct RayOffset {
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  ///< From the camera to the LED, length 1.
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();     ///< Parallel to the image plane [m].
  double scale = 1.0;                                   ///< Of the image, at the LED [m/px].
  double pixel_stddev = 1.0;                            ///< Of one spot [px].
  double count = 0.0;                                   ///< Of the spots, at most the memory's.

  void add(const RayOffset& spot);
};

/// Evidence that the two cameras that see a track see one LED, rather than a light each, such as a
/// reflection: rays of two lights seldom meet for long. The log odds of the two hypotheses, summed
/// over time (Blackman and Popoli 1999, section 6.2: track score).
class RayAgreement {
 public:
  /// Adds the evidence since the last call. @param now of this time [s]
  /// @param pixel_stddev of an LED's rays [px]
  void update(const Visibility& now, double pixel_stddev, double time);

  /// Where a track had lost its LED, the LED is likelier than two lights.
  void reacquire();

  bool areLikelyOne() const { return log_odds_ >= 0.0; }
  bool areNowOne() const { return latest_ >= 0.0; }

 private:
  void weigh(double distance, double stddev, double time);

  double log_odds_ = -9.0;  // of a new track: about 0.5 s of agreement
  double latest_ = -1.0;    // evidence of a time constant
  double time_ = std::numeric_limits<double>::infinity();
};

}  // namespace wiimote_tracker::tracking
