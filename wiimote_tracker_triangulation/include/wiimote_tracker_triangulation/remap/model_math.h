#ifndef WIIMOTE_TRACKER_TRIANGULATION_REMAP_MODEL_MATH_H
#define WIIMOTE_TRACKER_TRIANGULATION_REMAP_MODEL_MATH_H

#include "wiimote_tracker_triangulation/remap/frame.h"
#include "wiimote_tracker_triangulation/remap/remap.h"

#include <Eigen/Core>

#include <optional>

namespace wiimote_tracker::remap {

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

#endif  // WIIMOTE_TRACKER_TRIANGULATION_REMAP_MODEL_MATH_H
