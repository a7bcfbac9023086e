#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_RAY_AGREEMENT_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_RAY_AGREEMENT_H

#include <Eigen/Core>

#include <limits>

namespace wiimote_tracker::tracking {

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

/// The distance of two rays of one track from each other, positive or negative, over the standard
/// deviation that a pixel error of 1 px in each camera causes: of an LED, an error in pixels.
/// Motion that the predictions did not expect moves both rays alike and does not count.
double distanceOf(const RayOffset& a, const RayOffset& b);

/// Standard deviation of this distance by the noise of both cameras [px].
double stddevOf(const RayOffset& a, const RayOffset& b);

/// Evidence that the two cameras that see a track see one LED, rather than a light each, such as a
/// reflection: rays of two lights seldom meet for long. The log odds of the two hypotheses, summed
/// over time (Blackman and Popoli 1999, section 6.2: track score).
class RayAgreement {
 public:
  /// Adds the evidence of two rays since the last call. @param time of this image [s]
  /// @param distance of the rays, see distanceOf; 0 where a third camera sees the LED too [px]
  /// @param stddev of that of an LED's rays [px]
  void weigh(double distance, double stddev, double time);

  /// No two cameras see it.
  void wait(double time) { time_ = time; }

  /// Where an LED was lost, an LED is likelier than two lights.
  void reacquire();

  bool areLikelyOne() const { return log_odds_ >= 0.0; }
  bool areNowOne() const { return latest_ >= 0.0; }

 private:
  double log_odds_ = -9.0;  // of a new track: about 0.5 s of agreement
  double latest_ = -1.0;    // evidence of a time constant
  double time_ = std::numeric_limits<double>::infinity();
};

}  // namespace wiimote_tracker::tracking

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_RAY_AGREEMENT_H
