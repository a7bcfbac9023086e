#include "health/health_watch.h"

#include "health/remedy.h"

#include <wiimote_tracker_msgs/text.h>
#include <wiimote_tracker_triangulation/geometry/so3.h>

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::health {

namespace {

std::string degrees(double radians) {
  return format("%.1f degrees", radians * 180.0 / M_PI);
}

std::string tiltText(const Tilt& tilt) {
  return "was moved: it is tilted by " + degrees(tilt.angle) + " (+- " + degrees(tilt.stddev) +
         ") against where it was calibrated";
}

std::string driftText(const Drift& drift) {
  const std::string size = format("%.1f px (+- %.1f px)", drift.bias.norm(), drift.stddev);
  if (!drift.or_camera.empty())
    return "drifted, or " + drift.or_camera + " did: their rays miss each other by " + size +
           " on average";
  const std::string off = "its images are " + size + " on average off what the other cameras see";
  if (drift.or_others)
    return "drifted, or others did: " + off;
  return "drifted: " + off;
}

/// The camera of a rig that is this device; empty: none.
std::string cameraOf(const geometry::Rig& rig, const std::string& device) {
  const auto found =
      std::find_if(rig.cameras.begin(), rig.cameras.end(), [&](const geometry::RigCamera& camera) {
        return !device.empty() && camera.camera.identity == device;
      });
  return found == rig.cameras.end() ? "" : found->camera.name;
}

/// What to do about two cameras that each stand in the other's place.
constexpr char kPutBackBoth[] =
    "put each where the other one is now, or calibrate all cameras again";

/// Whether what was found of a camera holds with another calibration of it, too.
bool isStillCalibratedAs(const geometry::RigCamera& before, const geometry::RigCamera& now) {
  // Half of what is found as drift, 3 m away.
  constexpr double kTurn = 0.00025;  // [rad]
  constexpr double kMove = 0.001;    // [m]
  const double turn = geometry::so3::angleBetween(before.camera.world_from_camera.linear(),
                                                  now.camera.world_from_camera.linear());
  return before.camera.identity == now.camera.identity && before.gravity == now.gravity &&
         turn < kTurn && (now.camera.center() - before.camera.center()).norm() < kMove;
}

}  // namespace

HealthWatch::Watched::Watched(const geometry::RigCamera& rig_camera, const TiltOptions& options)
    : calibrated(rig_camera) {
  if (calibrated.gravity && calibrated.gravity->norm() > 0.0)
    tilt.emplace(*calibrated.gravity, options);
}

HealthWatch::HealthWatch(const geometry::Rig& rig, const HealthOptions& options)
    : options_(options), rig_(rig), drift_(rig, options.drift) {
  for (const geometry::RigCamera& camera : rig.cameras)
    cameras_.emplace_back(camera, options.tilt);
}

bool HealthWatch::follow(const geometry::Rig& rig) {
  if (!geometry::haveSameCameras(rig_, rig))
    return false;
  bool any = false;
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    if (isStillCalibratedAs(cameras_[i].calibrated, rig.cameras[i]))
      continue;
    cameras_[i] = Watched(rig.cameras[i], options_.tilt);
    any = true;
  }
  for (std::size_t i = 0; i < cameras_.size() && any; ++i) {
    if (cameras_[i].health.by_images)  // judged against the others' old poses
      cameras_[i] = Watched(rig.cameras[i], options_.tilt);
  }
  rig_ = rig;
  drift_ = DriftWatch(rig, options_.drift);
  return true;
}

std::map<std::string, CameraHealth> HealthWatch::healths() const {
  std::map<std::string, CameraHealth> healths;
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    CameraHealth& health = healths[cameras_[i].calibrated.camera.name] = cameras_[i].health;
    if (!health.drift)
      health.no_drift = drift_.whyNotJudged(i);
  }
  return healths;
}

std::map<std::string, std::vector<std::string>> HealthWatch::notJudged() const {
  std::map<std::string, std::vector<std::string>> cameras;
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    if (!drift_.drifts()[i])
      cameras[drift_.whyNotJudged(i)].push_back(cameras_[i].calibrated.camera.name);
  }
  return cameras;
}

HealthWatch::Watched* HealthWatch::find(const std::string& name) {
  const auto found = std::find_if(cameras_.begin(), cameras_.end(), [&](const Watched& camera) {
    return camera.calibrated.camera.name == name;
  });
  return found == cameras_.end() ? nullptr : &*found;
}

void HealthWatch::addImage(const capture::Image& image) {
  Watched* const seen_by = find(image.camera);
  if (!seen_by)
    return;
  const std::string other_device =
      seen_by->calibrated.camera.isOtherDevice(image.identity) ? image.identity : "";
  if (other_device != seen_by->other_device) {
    seen_by->other_device = other_device;
    describe(seen_by);
  }
  if (!drift_.add(image))
    return;
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    const std::optional<Drift>& drift = drift_.drifts()[i];
    // Without a new judgement the last one stays.
    if (!drift)
      continue;
    Watched& judged = cameras_[i];
    judged.health.drift = drift;
    judged.drift_alarm.judge(drift->ratio);
    // The text of an alarm shows the latest judgement that supports it, not those that end it.
    if (!judged.drift_alarm.on() || drift->ratio >= 1.0)
      judged.drift_finding = *drift;
    describe(&judged);
  }
}

void HealthWatch::addAcceleration(const std::string& name,
                                  double time,
                                  const Eigen::Vector3d& specific_force) {
  Watched* const camera = find(name);
  // The accelerometer of another device cannot be compared.
  if (!camera || !camera->tilt || !camera->other_device.empty())
    return;
  const auto tilt = camera->tilt->add(time, specific_force);
  if (!tilt)
    return;
  camera->health.tilt = tilt;
  camera->tilt_alarm.judge(tilt->ratio);
  describe(camera);
}

std::vector<std::string> HealthWatch::takeNews(
    const std::function<bool(const std::string&)>& isSilent) {
  const auto first =
      std::stable_partition(news_.begin(), news_.end(), [&](const std::string& camera) {
        return !find(camera)->health.text.empty() && isSilent(camera);
      });
  std::vector<std::string> news(first, news_.end());
  news_.erase(first, news_.end());
  return news;
}

void HealthWatch::describe(Watched* camera) {
  CameraHealth& health = camera->health;
  const bool was_well = health.text.empty();
  std::vector<std::string> findings;
  health.advice.clear();
  // Of several findings the first one says what to do.
  const auto add = [&](const std::string& finding, const std::string& advice) {
    findings.push_back(finding);
    if (health.advice.empty())
      health.advice = advice;
  };
  const std::string& other_device = camera->other_device;
  const std::string calibrated_as = cameraOf(rig_, other_device);
  if (!calibrated_as.empty())
    add("is the device (" + other_device + ") that was calibrated as " + calibrated_as,
        "give the driver of each camera the address that was calibrated");
  else if (!other_device.empty())
    add("is another device (" + other_device + ") than was calibrated (" +
            camera->calibrated.camera.identity + ")",
        calibrateAgain(rig_));
  const Drift& drift = camera->drift_finding;
  const bool is_exchanged = camera->drift_alarm.on() && !drift.exchanged_with.empty();
  if (is_exchanged)
    add("seems exchanged with " + drift.exchanged_with + ": each sees what the other one should",
        kPutBackBoth);
  if (camera->tilt_alarm.on() && !is_exchanged)
    add(tiltText(*health.tilt), putBack(rig_, true));
  const bool is_drift = camera->drift_alarm.on() && !is_exchanged;
  const bool is_known = drift.or_camera.empty() && !drift.or_others;
  health.by_images = is_drift && findings.empty();
  health.or_others = health.by_images && !is_known;
  if (is_drift)
    add(driftText(drift), putBack(rig_, is_known));
  health.text = joined(findings, "; ");
  if (was_well && !health.text.empty())
    news_.push_back(camera->calibrated.camera.name);
}

}  // namespace wiimote_tracker::health
