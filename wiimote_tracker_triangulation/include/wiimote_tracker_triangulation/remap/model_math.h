#pragma once

#include "wiimote_tracker_triangulation/remap/remap.h"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace wiimote_tracker::remap {

/// Coordinates of the models: centre and half the longest edge of the bounding box of the support
/// [m].
struct Frame {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  double scale = 1.0;

  Eigen::Vector3d normalized(const Eigen::Vector3d& point) const {
    return (point - middle) / scale;
  }
};

Frame frameOf(const std::vector<Eigen::Vector3d>& support);

/// An image point of the model and its derivative.
struct Mapped {
  Eigen::Vector3d position;
  Eigen::Matrix3d jacobian;
};

/// The formula of Remap. Nothing behind the vanishing plane of a projective model.
std::optional<Mapped> evaluate(const Remap& remap,
                               const Frame& frame,
                               const Eigen::Vector3d& point);

/// The polynomial basis functions b(q) of the linear models; the thin plate's distances are not
/// among them.
constexpr int kAffineTerms = 4;
constexpr int kTrilinearTerms = 8;
Eigen::Matrix<double, kTrilinearTerms, 1> polynomial(const Eigen::Vector3d& q);

}  // namespace wiimote_tracker::remap
