#ifndef WIIMOTE_TRACKER_CALIBRATION_CAPTURE_STILL_SPOT_H
#define WIIMOTE_TRACKER_CALIBRATION_CAPTURE_STILL_SPOT_H

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace wiimote_tracker::capture {

/// Positions of one spot in successive images of one camera, and how still it was.
class StillSpot {
 public:
  void add(const Eigen::Vector2d& pixel);

  std::size_t samples() const { return pixels_.size(); }

  /// Mean position [px]; zero without samples.
  const Eigen::Vector2d& mean() const { return mean_; }

  /// Standard deviation over both axes together, sqrt(var_u + var_v) [px]; NaN below two samples.
  double spread() const;

  /// Distance between the means of the first and the last third of the samples [px]: finds motion
  /// too slow for the spread. Zero below nine samples.
  double drift() const;

 private:
  std::vector<Eigen::Vector2d> pixels_;
  Eigen::Vector2d mean_ = Eigen::Vector2d::Zero();
  double sum_of_squares_ = 0.0;  // of the distances to the mean
};

}  // namespace wiimote_tracker::capture

#endif  // WIIMOTE_TRACKER_CALIBRATION_CAPTURE_STILL_SPOT_H
