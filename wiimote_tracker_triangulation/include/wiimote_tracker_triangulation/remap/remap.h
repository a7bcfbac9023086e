#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <string>
#include <vector>

namespace wiimote_tracker::remap {

/// In the order of the number of parameters.
enum class Model {
  kAffine,      ///< 12: translation, rotation, scale and shear.
  kProjective,  ///< 15: preserves straight lines (Hartley and Zisserman, section 3.1).
  kTrilinear,   ///< 24: the corners of a box move independently.
  kThinPlate,   ///< 3 per point and 12: displacement of least bending energy (Duchon 1977).
};

/// "affine", "projective", "trilinear" or "thin_plate".
const char* nameOf(Model model);

/// @throws Error for any other name.
Model modelFromName(const std::string& name);

/// Number of parameters of a model for this number of support points.
std::size_t parameterCount(Model model, std::size_t support);

/// A correction of the volume; fields as in RigRemap.msg.
///
/// Let m be the centre of the support's bounding box and s half its longest edge [m];
/// q = (p - m) / s. The corrected point is
/// - affine, trilinear, thin_plate: p + C' b(q), with C the parameters as a matrix of three columns
///   (x, y, z), stored row by row [m]. b(q) is 1, qx, qy, qz; then, for trilinear, qx qy, qy qz,
///   qz qx, qx qy qz; for thin_plate, the distance of q from each support point's q, in the order
///   of the support;
/// - projective: m + P (1, q)' / (1 + c q / s), with P (3x4) row by row, then c [m].
struct Remap {
  std::string rig_id;  ///< Of the calibration used to measure the points.
  Model model = Model::kAffine;
  std::vector<double> parameters;        ///< [m]
  std::vector<Eigen::Vector3d> support;  ///< Measured positions, world [m].

  /// @throws Error: no rig id, a wrong number of parameters, values that are not finite.
  void check() const;
};

bool operator==(const Remap& a, const Remap& b);

}  // namespace wiimote_tracker::remap
