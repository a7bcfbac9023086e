#include "wiimote_tracker_calibration/remap/correction.h"

#include "wiimote_tracker_calibration/remap/error.h"

#include "model_math.h"

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::remap {

Correction::Correction(const Remap& remap, const std::string& rig_id)
    : remap_(remap), frame_(frameOf(remap.support)), hull_(remap.support) {
  if (remap.rig_id.empty() || remap.rig_id != rig_id)
    throw RemapError("the correction of the volume was measured with calibration \"" +
                     remap.rig_id + "\", but the rig is \"" + rig_id +
                     "\": it is void, so measure the known points again");
  const std::size_t expected = parameterCount(remap.model, remap.support.size());
  if (remap.parameters.size() != expected)
    throw RemapError("the correction of the volume has " + std::to_string(remap.parameters.size()) +
                     " parameters, but " + nameOf(remap.model) + " needs " +
                     std::to_string(expected) +
                     ": it is damaged, so measure the known points again");
  const bool finite = std::all_of(remap.parameters.begin(), remap.parameters.end(),
                                  [](double value) { return std::isfinite(value); }) &&
                      std::all_of(remap.support.begin(), remap.support.end(),
                                  [](const Eigen::Vector3d& point) { return point.allFinite(); });
  if (!finite)
    throw RemapError(
        "the correction of the volume holds values that are not finite: it is damaged, so measure "
        "the known points again");
  if (std::isinf(hull_.excess(frame_.middle)))
    throw RemapError(
        "the points of the correction of the volume enclose no volume: it is damaged, so measure "
        "the known points again");
}

std::optional<CorrectedPoint> Correction::apply(const Eigen::Vector3d& measured,
                                                const Eigen::Matrix3d& covariance) const {
  if (!measured.allFinite())
    return std::nullopt;
  const std::optional<Mapped> mapped = evaluate(remap_, frame_, measured);
  if (!mapped)
    return std::nullopt;
  CorrectedPoint point;
  point.position = mapped->position;
  point.jacobian = mapped->jacobian;
  point.covariance = mapped->jacobian * covariance * mapped->jacobian.transpose();
  point.inside = hull_.encloses(measured);
  return point;
}

}  // namespace wiimote_tracker::remap
