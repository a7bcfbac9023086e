#pragma once

#include "image_message.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"
#include "wiimote_tracker_triangulation/tracking/estimator.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <set>
#include <utility>

namespace wiimote_tracker {

/// Which faults of the cameras were reported. Each is reported once. A camera that does not fit the
/// others is reported again when that was over before another rig came; not when it goes on, since
/// continuous calibration makes a new rig every half minute.
class FaultReports {
 public:
  bool isNew(std::size_t camera, ImageFault::Kind fault) {
    return of_images_.emplace(camera, fault).second;
  }
  bool isNew(std::size_t camera, tracking::CameraFault::Kind fault) {
    return of_cameras_.emplace(camera, fault).second;
  }

  /// @param estimator with the new rig
  void useRig(const geometry::Rig& before,
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

 private:
  /// Whether they are alike in what faults of images depend on.
  static bool isAlike(const geometry::RigCamera& a, const geometry::RigCamera& b) {
    const geometry::Intrinsics& lens = a.camera.intrinsics;
    const geometry::Intrinsics& other = b.camera.intrinsics;
    return a.camera.name == b.camera.name && a.camera.identity == b.camera.identity &&
           lens.width == other.width && lens.height == other.height;
  }

  std::set<std::pair<std::size_t, ImageFault::Kind>> of_images_;
  std::set<std::pair<std::size_t, tracking::CameraFault::Kind>> of_cameras_;
};

}  // namespace wiimote_tracker
