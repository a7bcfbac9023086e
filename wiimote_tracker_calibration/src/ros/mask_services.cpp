#include "mask_services.h"

#include "replies.h"

namespace wiimote_tracker {

namespace {

const char kToBeSaved[] = "; the rig is used so at once: save it to keep that";

}  // namespace

using workflow::Step;

MaskServices::MaskServices(NodeContext* context) : context_(*context) {
  ros::NodeHandle& nh = context_.nh();
  services_ = {nh.advertiseService("calibration/learn_masks", &MaskServices::learn, this),
               nh.advertiseService("calibration/clear_masks", &MaskServices::clear, this)};
  context_.inputs().subscribeImages([this](const capture::Image& image, const Lock&) {
    if (learner_)
      learner_->add(image);
  });
}

bool MaskServices::learn(wiimote_tracker_msgs::LearnMasks::Request& request,
                         wiimote_tracker_msgs::LearnMasks::Response& response) {
  const double duration = request.duration == 0.0 ? 2.0 : request.duration;
  if (!(duration > 0.0 && duration <= 60.0)) {
    response.message = "the duration must be within 0 and 60 s";
    return true;
  }
  context_.inputs().discover();
  Lock lock(context_.mutex());
  workflow::Reply reply =
      context_.begin(Step::kMasking, "looking for other lights: keep the LED off", lock);
  if (reply.success) {
    std::vector<std::string> names;
    for (const auto& camera : context_.inputs().cameras())
      names.push_back(camera.first);
    learner_.emplace(names, context_.parameters(lock).masks);
    const double start = NodeContext::now();
    const bool stopped = context_.waitUntil(&lock, start + duration, [&] {
      context_.setProgress((NodeContext::now() - start) / duration, lock);
      return context_.stopped(Step::kMasking, lock);
    });
    const auto result = learner_->result();
    learner_.reset();
    reply = stopped ? workflow::Reply{false, "it was cancelled; the masks are as they were"}
                    : learned(result, lock);
    context_.end(reply, lock);
  }
  fill(reply, &response);
  for (const auto& masks : context_.inputs().masks()) {
    response.cameras.push_back(masks.first);
    response.masks.push_back(static_cast<std::uint32_t>(masks.second.size()));
  }
  return true;
}

workflow::Reply MaskServices::learned(const std::map<std::string, capture::LearnedMasks>& learned,
                                      const Lock& lock) {
  capture::Masks masks = context_.inputs().masks();
  std::string problems;
  std::string found;
  std::string warnings;
  std::size_t with_one = 0;
  for (const auto& camera : learned) {
    if (!camera.second.problem.empty()) {
      problems += (problems.empty() ? "" : "; ") + camera.first + " " + camera.second.problem;
      continue;
    }
    const std::size_t count = camera.second.masks.size();
    masks[camera.first] = camera.second.masks;
    found += (found.empty() ? "" : ", ") + camera.first + " " + std::to_string(count);
    with_one += count == 1;
    const int most = context_.inputs().cameras().at(camera.first).max_blobs;
    if (most > 0 && static_cast<int>(count) >= most)
      warnings += "; " + camera.first + " reports " + std::to_string(most) +
                  " lights at most, so that the LED can be hidden: cover or switch off some";
  }
  if (learned.empty())
    problems = "no camera is there: start the drivers";
  if (!problems.empty())
    return {false, problems + "; the masks are as they were"};
  if (with_one == learned.size() && learned.size() > 1)
    warnings +=
        "; every camera sees exactly one light: if that is the LED, switch it off and learn "
        "again";
  if (context_.setMasks(masks, lock))
    warnings += kToBeSaved;
  return {true, "masked lights: " + found + warnings};
}

bool MaskServices::clear(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  const Lock lock(context_.mutex());
  response.success = true;
  response.message = "no light is masked any more";
  if (context_.setMasks({}, lock))
    response.message += kToBeSaved;
  context_.show(response.message, lock);
  return true;
}

}  // namespace wiimote_tracker
