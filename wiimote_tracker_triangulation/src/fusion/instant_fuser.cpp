#include "wiimote_tracker_triangulation/fusion/instant_fuser.h"

#include "led_memory.h"
#include "locator.h"
#include "synchronizer.h"
#include "wiimote_tracker_triangulation/geometry/calibration_uncertainty.h"

#include <algorithm>
#include <optional>
#include <vector>

namespace wiimote_tracker::fusion {

using tracking::Snapshot;
using tracking::SpotUse;
using tracking::TrackedLed;
using tracking::TrackState;

struct InstantFuser::Parts {
  explicit Parts(const InstantFuserOptions& fuser_options)
      : options(fuser_options), synchronizer(fuser_options), memory(fuser_options) {}

  void report();
  void describe(const LedMemory::Led& led);
  void describeRays(const Locator::Point& point, TrackedLed* led);

  InstantFuserOptions options;
  std::vector<geometry::Camera> cameras;
  Synchronizer synchronizer;
  std::unique_ptr<Locator> locator;
  std::optional<geometry::CalibrationUncertainty> uncertainty;  // never empty
  LedMemory memory;
  Snapshot snapshot;
};

InstantFuser::InstantFuser(const geometry::Rig& rig, const InstantFuserOptions& options)
    : parts_(std::make_unique<Parts>(options)) {
  InstantFuser::setRig(rig);
}

InstantFuser::~InstantFuser() = default;

void InstantFuser::setRig(const geometry::Rig& rig) {
  rig.check();
  parts_->cameras = rig.rayCameras();
  parts_->synchronizer.setRig(rig);
  parts_->locator = std::make_unique<Locator>(rig, parts_->options);
  parts_->uncertainty.emplace(rig);
}

void InstantFuser::add(std::size_t camera, const tracking::CameraImage& image) {
  const std::uint64_t resets = counters_.resets;
  parts_->synchronizer.add(camera, image, &counters_);
  if (counters_.resets != resets)
    parts_->memory.forget();
}

const Snapshot* InstantFuser::next() {
  if (!parts_->synchronizer.advance())
    return nullptr;
  parts_->locator->locate(parts_->synchronizer.views());
  parts_->memory.match(parts_->synchronizer.time(), parts_->locator->points());
  parts_->report();
  return &parts_->snapshot;
}

void InstantFuser::Parts::report() {
  snapshot.time = synchronizer.time();
  snapshot.latest_arrival = synchronizer.latestArrival();
  snapshot.skew = synchronizer.skew();
  snapshot.views.assign(synchronizer.views().begin(), synchronizer.views().end());
  snapshot.leds.clear();
  for (const LedMemory::Led& led : memory.leds()) {
    if (led.point != LedMemory::kNone || led.state == TrackState::kLost)
      describe(led);
  }
}

void InstantFuser::Parts::describe(const LedMemory::Led& led) {
  TrackedLed& reported = snapshot.leds.emplace_back(led);
  if (led.point != LedMemory::kNone)
    describeRays(locator->points()[led.point], &reported);
  if (const auto covariance = uncertainty->covarianceNear(
          reported.position, reported.cameras.data(), reported.cameras.size()))
    reported.position_covariance += *covariance;
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    if (std::binary_search(reported.cameras.begin(), reported.cameras.end(), c) ||
        cameras[c].sees(led.position))
      ++reported.rays_possible;
  }
}

void InstantFuser::Parts::describeRays(const Locator::Point& point, TrackedLed* led) {
  led->residual = point.located.reprojection_error;
  for (const association::SpotReference& ray : point.spots) {
    if (led->cameras.size() < led->cameras.capacity())
      led->cameras.push_back(ray.view);
    tracking::SeenSpot& spot = snapshot.views[ray.view].spots[ray.spot];
    spot.use = SpotUse::kAssigned;
    spot.led = led->id;
  }
}

}  // namespace wiimote_tracker::fusion
