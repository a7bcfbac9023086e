#include "capture/mask_learner.h"

#include "capture/camera_monitor.h"

#include <wiimote_tracker_msgs/text.h>

#include <algorithm>

namespace wiimote_tracker::capture {

namespace {

constexpr std::size_t kFewestImages = 20;     // to learn masks from
constexpr std::size_t kFewestDetections = 3;  // fewer are false detections
// A light that gets farther than this from its centre is moving: it is no lamp [px].
constexpr double kReach = 15.0;

}  // namespace

MaskLearner::MaskLearner(const std::vector<std::string>& cameras, const MaskOptions& options)
    : options_(options) {
  for (const std::string& name : cameras)
    cameras_[name];
}

void MaskLearner::add(const Image& image) {
  const auto found = cameras_.find(image.camera);
  if (found == cameras_.end())
    return;
  ++found->second.images;
  for (const Blobs* spots : {&image.spots, &image.masked}) {
    for (const Eigen::Vector2d& spot : *spots) {
      if (spot.allFinite())
        addSpot(spot, &found->second);
    }
  }
}

void MaskLearner::addSpot(const Eigen::Vector2d& spot, Camera* camera) {
  Light* nearest = nullptr;
  for (Light& light : camera->lights) {
    if (nearest == nullptr || (light.mean - spot).norm() < (nearest->mean - spot).norm())
      nearest = &light;
  }
  if (nearest == nullptr || (nearest->mean - spot).norm() > 2.0 * kReach) {
    camera->lights.push_back({spot, spot, spot, 1});
    return;
  }
  ++nearest->images;
  nearest->mean += (spot - nearest->mean) / static_cast<double>(nearest->images);
  nearest->lower = nearest->lower.cwiseMin(spot);
  nearest->upper = nearest->upper.cwiseMax(spot);
}

std::map<std::string, LearnedMasks> MaskLearner::result() const {
  std::map<std::string, LearnedMasks> result;
  for (const auto& camera : cameras_)
    result[camera.first] = learned(camera.second);
  return result;
}

LearnedMasks MaskLearner::learned(const Camera& camera) const {
  LearnedMasks result;
  if (camera.images < kFewestImages) {
    result.problem = camera.images == 0 ? kSendsNoImages
                                        : "sent " + counted(camera.images, "image") +
                                              " only: look for a longer time";
    return result;
  }
  const double needed = std::max(options_.share * static_cast<double>(camera.images),
                                 static_cast<double>(kFewestDetections));
  std::size_t moving = 0;  // detections of lights that move
  for (const Light& light : camera.lights) {
    const double radius = 0.5 * (light.upper - light.lower).norm();
    if (radius > kReach) {
      moving += light.images;
    } else if (static_cast<double>(light.images) >= needed) {
      result.masks.push_back({0.5 * (light.lower + light.upper), radius + options_.margin});
    }
  }
  if (static_cast<double>(moving) >= needed) {
    result.masks.clear();
    result.problem =
        "sees a light that moves: switch the LED off, keep out of its view with all that shines or "
        "reflects, and learn again";
  }
  return result;
}

}  // namespace wiimote_tracker::capture
