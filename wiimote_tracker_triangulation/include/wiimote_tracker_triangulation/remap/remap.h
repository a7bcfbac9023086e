#ifndef WIIMOTE_TRACKER_TRIANGULATION_REMAP_REMAP_H
#define WIIMOTE_TRACKER_TRIANGULATION_REMAP_REMAP_H

#include <Eigen/Core>

#include <cstddef>
#include <string>
#include <vector>

namespace wiimote_tracker::remap {

/// From few parameters to many.
enum class Model {
  kAffine,      ///< 12: shift, rotation, scale and shear.
  kProjective,  ///< 15: straight lines stay straight (Hartley and Zisserman, section 3.1).
  kTrilinear,   ///< 24: each corner of a box moves on its own.
  kThinPlate,   ///< 3 per point and 12: smooth displacement with least bending (Duchon 1977).
};

/// "affine", "projective", "trilinear" or "thin_plate".
const char* nameOf(Model model);

/// @throws Error for any other name.
Model modelFromName(const std::string& name);

/// Number of parameters of a model fitted to so many points of support.
std::size_t parameterCount(Model model, std::size_t support);

/// A correction of the volume as it is stored and sent: fields as in RigRemap.msg.
///
/// Let m be the middle of the smallest box round the support and s half its longest edge [m];
/// q = (p - m) / s. The corrected point is
/// - affine, trilinear, thin_plate: p + C' b(q), with C the parameters as a matrix of three columns
///   (x, y, z), stored row by row [m]. b(q) is 1, qx, qy, qz; then, for trilinear, qx qy, qy qz,
///   qz qx, qx qy qz; for thin_plate, the distance of q from each support point's q, in the order
///   of the support;
/// - projective: m + s P (1, q)' / (s + c q), with P (3x4) row by row, then c [m].
struct Remap {
  std::string rig_id;  ///< Of the calibration the points were measured with.
  Model model = Model::kAffine;
  std::vector<double> parameters;        ///< [m]
  std::vector<Eigen::Vector3d> support;  ///< Measured positions, world [m].

  /// @throws Error: no rig id, a number of parameters that does not fit the model, values that
  /// are not finite.
  void check() const;
};

bool operator==(const Remap& a, const Remap& b);

}  // namespace wiimote_tracker::remap

#endif  // WIIMOTE_TRACKER_TRIANGULATION_REMAP_REMAP_H
