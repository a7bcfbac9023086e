#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_BUNDLE_CERTAINTY_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_BUNDLE_CERTAINTY_H

#include "wiimote_tracker_calibration/bundle/reconstruction.h"
#include "wiimote_tracker_calibration/bundle/solve.h"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace wiimote_tracker::bundle {

/// How certain an adjusted reconstruction is of its lenses and cameras. First order, from the
/// inliers with their Huber weights and the noise that their residuals show, and from what
/// Options::lens says of all but the focal lengths.
class Certainty {
 public:
  /// @param fixed_lenses the lenses are given, and exact.
  Certainty(const Reconstruction& reconstruction, const Options& options, bool fixed_lenses);

  double pixelStddev() const { return pixel_stddev_; }  ///< Of one coordinate, as estimated [px].

  /// Covariance of a lens in the order fx, fy, cx, cy, k1, k2, p1, p2, k3. Nothing when the
  /// observations leave some of it open.
  std::optional<Eigen::MatrixXd> lensCovariance(std::size_t camera) const;

  /// RMS over the points that a repetition of the recording would differ by after the best
  /// similarity [m]: errors of cameras, lenses and pixels together, from a few drawn at random.
  /// Nothing when some of it is open.
  std::optional<double> expectedShapeError() const;

 private:
  struct PointView {
    Eigen::Index camera;
    Eigen::Matrix<double, 2, 15> by_camera;  // lens, then pose
    Eigen::Matrix<double, 2, 3> by_point;
  };

  Eigen::Index column(Eigen::Index camera, Eigen::Index parameter) const;
  void linearize(const Reconstruction& reconstruction, const Options& options);
  void reduce();
  void addWhatIsKnown(const Reconstruction& reconstruction, const Options& options);
  void fixWorld(const Reconstruction& reconstruction);
  void invert();

  const bool one_lens_;
  const Eigen::Index camera_count_;
  std::vector<std::vector<PointView>> points_;  // of points with two views or more
  std::vector<Eigen::Vector3d> positions_;      // of the same
  double pixel_stddev_ = 0.0;
  Eigen::MatrixXd information_;          // of lenses, then poses
  std::optional<Eigen::MatrixXd> root_;  // covariance = root_ * root_^T
};

}  // namespace wiimote_tracker::bundle

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_BUNDLE_CERTAINTY_H
