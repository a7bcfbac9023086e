#include "wiimote_tracker_triangulation/remap/remap.h"

#include "wiimote_tracker_triangulation/geometry/error.h"
#include "wiimote_tracker_triangulation/remap/model_math.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace wiimote_tracker::remap {
namespace {

// In the order of Model.
constexpr std::array<const char*, 4> kNames = {"affine", "projective", "trilinear", "thin_plate"};

}  // namespace

const char* nameOf(Model model) {
  return kNames[static_cast<std::size_t>(model)];
}

Model modelFromName(const std::string& name) {
  const auto found = std::find(kNames.begin(), kNames.end(), name);
  if (found == kNames.end())
    throw Error("\"" + name +
                "\" is not a model of a volume correction: choose affine, projective, "
                "trilinear or thin_plate");
  return static_cast<Model>(found - kNames.begin());
}

std::size_t parameterCount(Model model, std::size_t support) {
  constexpr std::size_t kAxes = 3;
  switch (model) {
    case Model::kAffine:
      return kAxes * kAffineTerms;
    case Model::kProjective:
      return 15;
    case Model::kTrilinear:
      return kAxes * kTrilinearTerms;
    default:
      return kAxes * (kAffineTerms + support);
  }
}

bool operator==(const Remap& a, const Remap& b) {
  return a.rig_id == b.rig_id && a.model == b.model && a.parameters == b.parameters &&
         a.support == b.support;
}

void Remap::check() const {
  if (rig_id.empty())
    throw Error(
        "the correction of the volume has no rig id: it is damaged; measure the "
        "known points again");
  const std::size_t expected = parameterCount(model, support.size());
  if (parameters.size() != expected)
    throw Error("the correction of the volume has " + std::to_string(parameters.size()) +
                " parameters, but " + nameOf(model) + " needs " + std::to_string(expected) +
                ": it is damaged; measure the known points again");
  const bool finite = std::all_of(parameters.begin(), parameters.end(),
                                  [](double value) { return std::isfinite(value); }) &&
                      std::all_of(support.begin(), support.end(),
                                  [](const Eigen::Vector3d& point) { return point.allFinite(); });
  if (!finite)
    throw Error(
        "the correction of the volume contains values that are not finite: it is damaged; measure "
        "the known points again");
}

}  // namespace wiimote_tracker::remap
