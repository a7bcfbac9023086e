#include "node_parts.h"

#include "capture/camera_monitor.h"
#include "capture/mask_learner.h"

#include <std_srvs/Trigger.h>
#include <wiimote_tracker_msgs/LearnMasks.h>
#include <wiimote_tracker_msgs/text.h>

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace wiimote_tracker {

using wiimote_tracker_msgs::LearnMasks;
using workflow::Step;

namespace {

const char kToBeSaved[] = "; the rig in use has the masks now: save it to keep that";
const char kNoneToBeSaved[] = "; the rig in use has no masks now: save it to keep that";

// Until the images of an LED that is switched off only at the request, as by the simulated hand,
// have arrived [s].
constexpr double kSettle = 0.3;

class MaskServices {
 public:
  explicit MaskServices(NodeContext* context) : context_(*context) {
    context->offer("learn_masks", &MaskServices::learn, this);
    context->offer("clear_masks", &MaskServices::clear, this);
  }

 private:
  workflow::Reply learn(LearnMasks& call, Lock& lock) {
    const double duration = call.request.duration == 0.0 ? 2.0 : call.request.duration;
    if (!(duration >= NodeContext::kShortestLook && duration <= 60.0))
      throw Refusal("the duration must be within 0.05 and 60 s");
    context_.discover(&lock);
    const Job job = {Step::kMasking, "looking for other lights: keep the LED off",
                     "the masks are as they were"};
    const workflow::Reply reply = context_.run(job, &lock, [&] {
      context_.waitUntil(&lock, NodeContext::now() + kSettle,
                         [&] { return context_.isCancelled(lock); });
      capture::MaskLearner learner(context_.inputs().names(), context_.parameters(lock).masks);
      const auto watching = context_.inputs().watch(
          [&](const capture::Image& image, const Lock&) { learner.add(image); });
      context_.waitFor(duration, &lock);
      return useMasks(learner.result(), lock);
    });
    for (const auto& masks : context_.inputs().masks()) {
      call.response.cameras.push_back(masks.first);
      call.response.masks.push_back(static_cast<std::uint32_t>(masks.second.size()));
    }
    return reply;
  }

  workflow::Reply clear(std_srvs::Trigger&, Lock& lock) {
    context_.calibration(lock).requireIdle();
    context_.calibration(lock).preparation() = {};  // as before any light was learned
    const std::string saved = context_.setMasks({}, lock) ? kNoneToBeSaved : "";
    return {true, "no light is masked any more" + saved};
  }

  workflow::Reply useMasks(const std::map<std::string, capture::LearnedMasks>& learned,
                           const Lock& lock) {
    if (learned.empty())
      throw Refusal("no camera is there: start the drivers; the masks are as they were");
    capture::Masks masks = context_.inputs().masks();
    std::vector<std::pair<std::string, std::string>> problems;
    std::vector<std::string> counts;
    std::vector<std::string> warnings;
    bool one_each = learned.size() > 1;
    for (const auto& [name, camera] : learned) {
      if (!camera.problem.empty()) {
        problems.emplace_back(name, camera.problem);
        continue;
      }
      const std::size_t count = camera.masks.size();
      masks[name] = camera.masks;
      counts.push_back(name + " " + std::to_string(count));
      one_each = one_each && count == 1;
      const auto& inputs = context_.inputs().cameras();
      const auto input = inputs.find(name);  // it may have been left to another tracker meanwhile
      const int most = input == inputs.end() ? 0 : input->second.max_blobs;
      if (most > 0 && static_cast<int>(count) >= most)
        warnings.push_back(
            name + " reports " + std::to_string(most) +
            " lights at most, and lamps may leave none for the LED: cover or switch off some");
    }
    if (!problems.empty())
      throw Refusal(capture::listOfProblems(problems) + "; the masks are as they were");
    if (one_each)
      warnings.emplace_back(
          "every camera sees exactly one light: if that is the LED, switch it off and learn again");
    // With other masks the cameras see something else.
    context_.calibration(lock).preparation() = {true, false};
    return {true, "masked lights: " + joined(counts) + appendix(warnings) +
                      (context_.setMasks(masks, lock) ? kToBeSaved : "")};
  }

  NodeContext& context_;
};

}  // namespace

NodePart maskServices(NodeContext* context) {
  return std::make_shared<MaskServices>(context);
}

}  // namespace wiimote_tracker
