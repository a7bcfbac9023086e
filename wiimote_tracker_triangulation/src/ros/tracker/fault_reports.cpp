#include "fault_reports.h"

#include <algorithm>
#include <iterator>

namespace wiimote_tracker {
namespace {

/// Whether they are alike in what faults of images depend on.
bool isAlike(const geometry::RigCamera& a, const geometry::RigCamera& b) {
  const geometry::Intrinsics& lens = a.camera.intrinsics;
  const geometry::Intrinsics& other = b.camera.intrinsics;
  return a.camera.name == b.camera.name && a.camera.identity == b.camera.identity &&
         lens.width == other.width && lens.height == other.height;
}

}  // namespace

void FaultReports::useRig(const geometry::Rig& before,
                          const geometry::Rig& rig,
                          const tracking::Estimator& estimator) {
  if (!std::equal(before.cameras.begin(), before.cameras.end(), rig.cameras.begin(),
                  rig.cameras.end(), isAlike)) {
    of_images_.clear();
    of_cameras_.clear();
    return;
  }
  for (auto report = of_cameras_.begin(); report != of_cameras_.end();) {
    const auto fault = estimator.cameraFault(report->first);
    const bool goes_on = fault && fault->kind == report->second;
    report = goes_on ? std::next(report) : of_cameras_.erase(report);
  }
}

}  // namespace wiimote_tracker
