#include "node_parts.h"

#include "health/health_watch.h"
#include "health/led_selection.h"
#include "health/remedy.h"

#include <wiimote_tracker_msgs/text.h>
#include <wiimote_tracker_triangulation/ros/steady_updater.h>

#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace wiimote_tracker {

namespace {

class HealthMonitor {
 public:
  HealthMonitor(NodeContext* context, InputQueue* one_led_inputs)
      : context_(*context), one_led_inputs_(*one_led_inputs) {
    context_.inputs().subscribeImages([this](const capture::Image& image, const Lock& lock) {
      if (watch_)
        inputs_.add({image, std::nullopt}, lock);
    });
    context_.inputs().subscribeGravity([this](const std::string& camera, double stamp,
                                              const Eigen::Vector3d& specific_force,
                                              const Lock& lock) {
      if (watch_)
        inputs_.add({{camera, stamp, 0, {}, {}}, specific_force}, lock);
    });
    diagnostics_.setHardwareID("none");
    diagnostics_.add("cameras", this, &HealthMonitor::report);
    timer_ = context_.everyHalfSecond("the health of the cameras", [this] { update(); });
  }

 private:
  /// Only the timer calls it, once at a time.
  void update() {
    {
      Lock lock(context_.mutex());
      std::vector<Input> inputs = inputs_.take(lock);
      if (watch_)
        NodeContext::unlocked(&lock, [&] { watch(&inputs); });
      for (Input& input : inputs)
        one_led_inputs_.add(std::move(input), lock);
      const auto& rig = context_.rig(lock);
      const std::string id = rig ? rig->id() : "";
      if (id != rig_id_) {
        rig_id_ = id;
        useRig(rig, lock);
      }
      StatusPublisher& status = context_.status(lock);
      status.setHealth({});
      if (watch_) {
        status.setHealth(watch_->healths());
        // What is proposed may explain a camera. If that goes without a cure, the camera is named.
        const auto isExplained = [&](const std::string& camera) {
          return status.health(camera).empty();
        };
        for (const std::string& camera : watch_->takeNews(isExplained)) {
          const std::string text = status.health(camera);
          if (!text.empty())  // It may be well again.
            ROS_WARN_STREAM(camera << " " << text);
        }
        warnOfUnknownCameras(*rig, lock);
      }
    }
    diagnostics_.update();
  }

  void useRig(const std::optional<geometry::Rig>& rig, const Lock& lock) {
    if (rig && !(selection_ && selection_->suits(*rig)))
      selection_.emplace(*rig);
    if (rig && watch_ && watch_->follow(*rig))
      return;
    watch_.reset();
    unknown_cameras_.clear();
    if (rig)
      watch_.emplace(*rig, context_.parameters(lock).health);
  }

  /// Judging drift takes longer than images may wait. Leaves one LED in the images.
  void watch(std::vector<Input>* inputs) {
    for (Input& input : *inputs) {
      if (input.specific_force) {
        watch_->addAcceleration(input.image.camera, input.image.stamp, *input.specific_force);
      } else {
        input.image = selection_->select(input.image);
        watch_->addImage(input.image);
      }
    }
  }

  void warnOfUnknownCameras(const geometry::Rig& rig, const Lock& lock) {
    const workflow::Step step = context_.calibration(lock).step();
    const bool is_in_use = step == workflow::Step::kIdle || step == workflow::Step::kSolved ||
                           step == workflow::Step::kSaved;
    if (!is_in_use) {  // A new rig may be on the way, with them.
      unknown_cameras_.clear();
      return;
    }
    for (const auto& camera : context_.inputs().cameras()) {
      if (rig.find(camera.first)) {
        context_.removedCameras(lock).erase(camera.first);
        continue;
      }
      if (context_.removedCameras(lock).count(camera.first) > 0)
        continue;
      if (!camera.second.monitor.summary(NodeContext::now()).connected) {
        unknown_cameras_.erase(camera.first);
        continue;
      }
      const std::string text = camera.first + " is not in the rig and makes no points: " +
                               health::addCamera(rig, camera.first) + ", or end its driver";
      if (std::exchange(unknown_cameras_[camera.first], text) != text)
        ROS_WARN_STREAM(text);
    }
  }

  void report(diagnostic_updater::DiagnosticStatusWrapper& status) {
    const Lock lock(context_.mutex());
    if (!watch_) {
      status.summary(diagnostic_msgs::DiagnosticStatus::WARN, context_.whyNoRig(lock));
      return;
    }
    std::vector<std::string> troubles;
    for (const auto& camera : watch_->healths()) {
      const health::CameraHealth& health = camera.second;
      const std::string text = context_.status(lock).health(camera.first);
      if (!text.empty())
        troubles.push_back(camera.first + " " + text);
      status.add(camera.first + " tilt [degrees]",
                 health.tilt ? format("%.2f +- %.2f", health.tilt->angle * 180.0 / M_PI,
                                      health.tilt->stddev * 180.0 / M_PI)
                             : std::string("not judged"));
      status.add(camera.first + " drift [px]",
                 health.drift
                     ? format("%.2f +- %.2f", health.drift->bias.norm(), health.drift->stddev)
                     : "not judged: " + health.no_drift);
    }
    for (const auto& camera : unknown_cameras_)
      troubles.push_back(camera.second);
    if (troubles.empty())
      status.summary(diagnostic_msgs::DiagnosticStatus::OK,
                     "no camera seems to have moved" + describeNotJudged());
    else
      status.summary(diagnostic_msgs::DiagnosticStatus::WARN, joined(troubles, "; "));
  }

  /// Whose images are not judged now, and why.
  std::string describeNotJudged() const {
    std::string text;
    for (const auto& [reason, cameras] : watch_->notJudged()) {
      const bool are_all = cameras.size() == watch_->healths().size();
      text +=
          "; the images" + (are_all ? "" : " of " + joined(cameras)) + " are not judged: " + reason;
    }
    return text;
  }

  NodeContext& context_;
  InputQueue inputs_;
  InputQueue& one_led_inputs_;
  std::string rig_id_;
  std::optional<health::LedSelection> selection_;  // Suits the rig.
  std::optional<health::HealthWatch> watch_;       // Nothing without a rig.
  // What to do about cameras that the rig does not have, by their names.
  std::map<std::string, std::string> unknown_cameras_;
  SteadyUpdater diagnostics_;
  ros::WallTimer timer_;
};

}  // namespace

NodePart healthMonitor(NodeContext* context, InputQueue* one_led_inputs) {
  return std::make_shared<HealthMonitor>(context, one_led_inputs);
}

}  // namespace wiimote_tracker
