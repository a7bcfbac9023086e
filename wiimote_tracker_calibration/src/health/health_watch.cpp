#include "health/health_watch.h"

#include <wiimote_tracker_msgs/text.h>

#include <cmath>
#include <utility>

namespace wiimote_tracker::health {

namespace {

const char kAdvice[] = "; put it back, or recalibrate this camera";

std::string degrees(double radians) {
  return format("%.1f degrees", radians * 180.0 / M_PI);
}

std::string tiltText(const Tilt& tilt) {
  return "was moved: it is tilted by " + degrees(tilt.angle) + " (+- " + degrees(tilt.stddev) +
         ") against where it was calibrated";
}

/// @param advise whether to say what to do
std::string driftText(const Drift& drift, bool advise) {
  const std::string size = format("%.1f px (+- %.1f px)", drift.bias.norm(), drift.stddev);
  if (!drift.together.empty())
    return "drifted, or " + drift.together + " did: their rays miss each other by " + size +
           " on average" +
           (advise ? "; see which of both was moved, put it back or recalibrate it" : "");
  return "drifted: its images are " + size + " on average off what the other cameras see" +
         (advise ? kAdvice : "");
}

}  // namespace

HealthWatch::HealthWatch(const geometry::Rig& rig, const HealthOptions& options)
    : drift_(rig, options.drift) {
  for (const geometry::RigCamera& rig_camera : rig.cameras) {
    const std::string& name = rig_camera.camera.name;
    order_.push_back(name);
    healths_[name];
    Camera& camera = cameras_[name];
    camera.calibrated_identity = rig_camera.camera.identity;
    if (rig_camera.gravity && rig_camera.gravity->norm() > 0.0)
      camera.tilt.emplace(*rig_camera.gravity, options.tilt);
  }
}

void HealthWatch::addImage(const capture::Image& image) {
  const auto found = cameras_.find(image.camera);
  if (found == cameras_.end())
    return;
  Camera& camera = found->second;
  const bool other = !image.identity.empty() && !camera.calibrated_identity.empty() &&
                     image.identity != camera.calibrated_identity;
  const std::string other_device = other ? image.identity : "";
  if (other_device != camera.other_device) {
    camera.other_device = other_device;
    describe(image.camera);
  }
  if (!drift_.add(image))
    return;
  for (std::size_t i = 0; i < order_.size(); ++i) {
    const std::optional<Drift>& drift = drift_.drifts()[i];
    // Without a new judgement the last one stays.
    if (!drift)
      continue;
    healths_[order_[i]].drift = drift;
    cameras_[order_[i]].drift_alarm.judge(drift->ratio);
    describe(order_[i]);
  }
}

void HealthWatch::addAcceleration(const std::string& name,
                                  double time,
                                  const Eigen::Vector3d& specific_force) {
  const auto found = cameras_.find(name);
  if (found == cameras_.end() || !found->second.tilt)
    return;
  // The accelerometer of another device cannot be compared.
  if (!found->second.other_device.empty())
    return;
  const auto tilt = found->second.tilt->add(time, specific_force);
  if (!tilt)
    return;
  healths_[name].tilt = tilt;
  found->second.tilt_alarm.judge(tilt->ratio);
  describe(name);
}

std::vector<std::string> HealthWatch::takeNews() {
  return std::exchange(news_, {});
}

void HealthWatch::describe(const std::string& name) {
  const Camera& camera = cameras_.at(name);
  CameraHealth& health = healths_.at(name);
  const bool was_well = health.text.empty();
  std::vector<std::string> findings;
  if (!camera.other_device.empty())
    findings.push_back("is another device (" + camera.other_device + ") than was calibrated (" +
                       camera.calibrated_identity + "): recalibrate this camera");
  if (camera.tilt_alarm.on())
    findings.push_back(tiltText(*health.tilt) + (findings.empty() ? kAdvice : ""));
  if (camera.drift_alarm.on())  // of several findings the first one says what to do
    findings.push_back(driftText(*health.drift, findings.empty()));
  health.text = joined(findings, "; ");
  if (was_well && !health.text.empty())
    news_.push_back(name + " " + health.text);
}

}  // namespace wiimote_tracker::health
