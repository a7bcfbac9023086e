#include "statistics.h"

#include <wiimote_tracker_msgs/text.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace wiimote_tracker {
namespace {

// A view is counted in the snapshot of its own time only.
constexpr double kSameTime = 1e-6;  // [s]

double quotient(double sum, std::size_t count) {
  return count > 0 ? sum / count : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

double CameraStatistics::inlierRatio() const {
  return quotient(assigned, spots);
}

double CameraStatistics::meanDelay() const {
  return quotient(delay_sum, images);
}

double CameraStatistics::residual() const {
  return std::sqrt(quotient(squares_sum, assigned));
}

std::string describeLights(const CameraStatistics& statistics, const std::string& camera) {
  constexpr double kMost = 3.0;  // per image; a Wii Remote reports at most four spots
  const double others = quotient(statistics.spots - statistics.assigned, statistics.views);
  if (!(others > kMost && statistics.inlierRatio() < 0.5))
    return "";
  return format(
      "%.0f spots in each image of %s belong to no LED that another camera sees: mask lamps and "
      "reflections",
      others, camera.c_str());
}

void Statistics::setRig(const geometry::Rig& rig) {
  for_rays_ = rig.rayCameras();
  frames_.assign(for_rays_.size(), std::nullopt);
  clear();
}

std::string Statistics::describe() const {
  if (leds(tracking::TrackState::kTracked) > 0)
    return "tracking";
  if (bodies_ > 0)
    return "no LED is tracked singly";
  const bool sees_any =
      std::any_of(cameras_.begin(), cameras_.end(),
                  [](const CameraStatistics& camera) { return camera.spots > 0; });
  return sees_any ? "no LED is tracked" : "no LED is seen";
}

std::string Statistics::describeClock(std::size_t camera, const std::string& name) const {
  constexpr double kLarge = 0.002;    // [s]
  constexpr std::size_t kFewest = 3;  // cameras that show an error of a clock
  const double stddev = cameras_[camera].clock_stddev;
  if (bodies_ == 0 || !(stddev > kLarge) || cameras_.size() < kFewest)
    return "";
  return format(
      "%s has a new clock since it was calibrated, known to +- %.0f ms only: move one LED alone "
      "for 10 s where it and two other cameras see it",
      name.c_str(), 1e3 * stddev);
}

void Statistics::clear() {
  cameras_.assign(for_rays_.size(), CameraStatistics());
  snapshots_ = 0;
  leds_.fill(0);
  latencies_.clear();
}

void Statistics::addImage(std::size_t camera,
                          const tracking::CameraImage& image,
                          std::uint64_t frame) {
  std::optional<std::uint64_t>& last = frames_[camera];
  if (last && frame > *last)
    cameras_[camera].lost += frame - *last - 1;
  last = frame;
  ++cameras_[camera].images;
  cameras_[camera].delay_sum += image.arrival - image.stamp;
}

void Statistics::setClock(std::size_t camera, const tracking::ClockError& error) {
  cameras_[camera].clock_stddev = std::sqrt(error.variance);
}

void Statistics::addProblem(std::size_t camera, const std::string& problem) {
  cameras_[camera].problem = problem;
}

void Statistics::addSnapshot(const tracking::Snapshot& snapshot) {
  ++snapshots_;
  leds_.fill(0);
  for (const tracking::TrackedLed& led : snapshot.leds)
    ++leds_[static_cast<std::size_t>(led.state)];
  for (std::size_t i = 0; i < snapshot.views.size() && i < cameras_.size(); ++i) {
    const tracking::CameraView& view = snapshot.views[i];
    if (!view.time || std::abs(*view.time - snapshot.time) > kSameTime)
      continue;
    ++cameras_[i].views;
    for (const tracking::SeenSpot& spot : view.spots)
      addSpot(i, spot, snapshot.leds);
  }
}

void Statistics::addSpot(std::size_t camera,
                         const tracking::SeenSpot& spot,
                         const std::vector<tracking::TrackedLed>& leds) {
  CameraStatistics& statistics = cameras_[camera];
  if (spot.use == tracking::SpotUse::kMasked) {
    ++statistics.masked;
    return;
  }
  ++statistics.spots;
  if (spot.use != tracking::SpotUse::kAssigned)
    return;
  for (const tracking::TrackedLed& led : leds) {
    if (led.id != spot.led)
      continue;
    if (const auto pixel = for_rays_[camera].project(led.position)) {
      ++statistics.assigned;
      statistics.squares_sum += (*pixel - spot.pixel).squaredNorm();
    }
  }
}

void Statistics::addLatency(double latency) {
  constexpr std::size_t kMaximumLatencies = 100000;  // limits memory without clear()
  if (latencies_.size() < kMaximumLatencies)
    latencies_.push_back(latency);
}

std::size_t Statistics::leds(tracking::TrackState state) const {
  return leds_[static_cast<std::size_t>(state)];
}

double Statistics::latency(double q) const {
  if (latencies_.empty())
    return std::numeric_limits<double>::quiet_NaN();
  std::vector<double> sorted = latencies_;
  const auto place =
      sorted.begin() + static_cast<std::ptrdiff_t>(q * static_cast<double>(sorted.size() - 1));
  std::nth_element(sorted.begin(), place, sorted.end());
  return *place;
}

}  // namespace wiimote_tracker
