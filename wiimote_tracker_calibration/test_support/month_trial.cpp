#include "month_trial.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace wiimote_tracker {
namespace {

constexpr double kHour = 3600.0;         // [s]
constexpr double kRate = 100.0;          // of the images [1/s]
constexpr double kStampStddev = 0.0003;  // [s]
constexpr double kTransport = 0.005;     // from exposure to arrival [s]
constexpr double kDrift = 1e-4;          // of a clock
constexpr double kOffsetStddev = 0.003;  // of the clock of a new connection [s]
constexpr std::size_t kDrifting = 1;     // cameras
constexpr std::size_t kUnknown = 3;
constexpr int kLifeOfBatteries = 40;  // [hours]
constexpr int kLeapHour = 240;
constexpr double kReadings = 0.1;  // interval of the accelerometers' [s]
constexpr double kStep = 0.18;     // of an accelerometer's readings [m/s^2]
constexpr double kSettling = 3.0;  // after the beginning of an hour's part [s]

geometry::Rig monthRig() {
  geometry::Rig rig = paperRigWith(calibratedByWave());
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    if (i != kUnknown)
      rig.cameras[i].time_offset_rule = geometry::TimeOffsetRule::kAlways;
  }
  return rig;
}

}  // namespace

Month::Month(std::uint64_t seed, double part)
    : part_(part),
      random_(seed),
      rig_(monthRig()),
      led_(drawTruth(rig_, random_), seed + 1, kRate),
      tracker_(rig_, {}),
      health_(rig_, {}),
      epochs_(rig_.cameras.size(), 7) {
  led_.stamp = kStampStddev;
  led_.wrong_share = 0.01;
}

MonthFigures Month::run(int hours) {
  MonthFigures figures;
  for (int i = 0; i < hours; ++i)
    runHour(&figures);
  return figures;
}

void Month::knock(double angle) {
  geometry::Camera& camera = led_.truth[0].camera;
  camera.world_from_camera.rotate(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitX()));
}

void Month::reconnect(std::size_t camera) {
  ++epochs_[camera];
  if (camera == kUnknown)
    led_.truth[camera].time_offset = square::normal(random_, kOffsetStddev);
}

void Month::runHour(MonthFigures* figures) {
  const double begin = hour_ * kHour;
  reconnect(static_cast<std::size_t>(hour_) % epochs_.size());
  const std::string empty =
      hour_ % kLifeOfBatteries == kLifeOfBatteries - 1
          ? rig_.cameras[static_cast<std::size_t>(hour_ / kLifeOfBatteries) % epochs_.size()]
                .camera.name
          : "";
  const double offset = led_.truth[kDrifting].time_offset;
  const std::uint64_t points = figures->points;
  const double due = rig_.cameras.size() * kRate * (part_ - kSettling);
  led_.skipTo(begin);
  for (double time = begin; time < begin + part_; time += kReadings) {
    led_.truth[kDrifting].time_offset = offset + kDrift * (time - begin);
    if (hour_ == kLeapHour && clock_step_ == 0.0 && time >= begin + part_ / 2.0) {
      clock_step_ = -1.0;
      for (std::uint32_t& epoch : epochs_)
        ++epoch;
    }
    led_.runUntil(time + kReadings, [&](const capture::Image& image) {
      if (image.camera != empty)
        add(image, figures);
    });
    addAccelerations(time);
  }
  led_.truth[kDrifting].time_offset = offset;
  const double share = (figures->points - points) / due;
  figures->hours_dark += share < 0.5 * (empty.empty() ? 1.0 : 0.75) ? 1 : 0;
  figures->alarms += health_.takeNews().size();
  ++hour_;
}

void Month::add(const capture::Image& image, MonthFigures* figures) {
  const auto camera = static_cast<std::size_t>(image.camera.back() - '1');
  capture::Image stepped = image;
  stepped.stamp += clock_step_;
  stepped.clock_epoch = epochs_[camera];
  stepped.identity = rig_.cameras[camera].camera.identity;
  health_.addImage(stepped);

  tracking::CameraImage seen;
  seen.stamp = stepped.stamp;
  seen.arrival = stepped.stamp + kTransport;
  seen.stamp_stddev = kStampStddev;
  seen.clock_epoch = stepped.clock_epoch;
  for (const Eigen::Vector2d& pixel : stepped.spots) {
    tracking::Spot spot;
    spot.pixel = pixel;
    seen.spots.push_back(spot);
  }
  tracker_.add(camera, seen);
  ++figures->images;
  takePoints(figures);
}

void Month::takePoints(MonthFigures* figures) {
  while (const tracking::Snapshot* snapshot = tracker_.next()) {
    const double time = snapshot->time - WavedLed::kClock - clock_step_;
    const Eigen::Vector3d truth = led_.path.position(time, 0);
    std::set<std::uint32_t> ids;
    for (const tracking::TrackedLed& led : snapshot->leds) {
      ids.insert(led.id);
      figures->reused_ids += led.id <= highest_id_ && ids_.count(led.id) == 0 ? 1 : 0;
      if (led.state != tracking::TrackState::kTracked)
        continue;
      const double error = (led.position - truth).norm();
      // Also where it is NaN.
      const bool wrong =
          !(error <= std::max(0.05, 5.0 * std::sqrt(led.position_covariance.trace())));
      ++figures->points;
      figures->wrong += wrong ? 1 : 0;
      figures->squared += wrong ? 0.0 : error * error;
    }
    if (!ids.empty())
      highest_id_ = std::max<std::int64_t>(highest_id_, *ids.rbegin());
    ids_ = ids;
  }
}

/// What cameras at rest read.
void Month::addAccelerations(double time) {
  for (const geometry::RigCamera& camera : led_.truth) {
    const Eigen::Vector3d up = camera.camera.world_from_camera.linear().row(2);
    health_.addAcceleration(camera.camera.name, WavedLed::kClock + clock_step_ + time,
                            reading(9.81 * up, 0.03, kStep, random_));
  }
}

}  // namespace wiimote_tracker
