#include "node_parts.h"
#include "rig_storage.h"

#include "continuous/continuous_calibration.h"
#include "continuous/rig_changes.h"
#include "health/remedy.h"
#include "recalibrate/rig_cameras.h"

#include <std_srvs/Trigger.h>
#include <wiimote_tracker_msgs/text.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace wiimote_tracker {

using continuous::Cause;
using std_srvs::Trigger;
using workflow::Reply;
using workflow::Step;

namespace {

const std::string kSteps = format("in steps of %.1f mm, one in %.0f s",
                                  1000.0 * continuous::Approach::kLongestStep,
                                  continuous::Approach::kPeriod);

class ContinuousServices {
 public:
  ContinuousServices(NodeContext* context, InputQueue* one_led_inputs)
      : context_(*context), one_led_inputs_(*one_led_inputs) {
    using Self = ContinuousServices;
    context->offer("continuous/apply", &Self::apply, this);
    context->offer("continuous/revert", &Self::revert, this);
    const Lock lock(context_.mutex());
    policy_ = context_.parameters(lock).continuous_policy;
    options_.recalibrate = context_.parameters(lock).recalibrateOptions();
    timer_ = context_.everyHalfSecond("continuous calibration", [this] { update(); });
  }

 private:
  /// Whether a rig is in use and no calibration is going on.
  bool isCalibrated(const Lock& lock) const {
    const Step step = context_.calibration(lock).step();
    return context_.rig(lock) &&
           (step == Step::kIdle || step == Step::kSolved || step == Step::kSaved);
  }

  /// Only the timer calls it, once at a time.
  void update() {
    Lock lock(context_.mutex());
    const std::vector<Input> inputs = one_led_inputs_.take(lock);
    if (policy_ == ContinuousPolicy::kOff)
      return;
    watchRig(lock);
    tellGoal(lock);
    if (inputs.empty() || !isCalibrated(lock))
      return;
    stepTowardsGoal(inputs, lock);
    const auto proposal = NodeContext::unlocked(&lock, [&] { return newestProposal(inputs); });
    new_clocks_ = continuous_->newClocks();
    if (proposal_ && !continuous_->isCurrent(*proposal_))
      forgetProposal(lock);
    sayContradiction();
    // Meanwhile the rig may have been replaced, or what was proposed before applied.
    if (!proposal || !changes_.isInUse(context_.rig(lock)) || idToWatch(lock) != watched_ ||
        !isCalibrated(lock))
      return;
    const bool applies = !changes_.isReverted() && appliesItself(proposal->cause);
    if (!applies && proposal->cause == Cause::kDrift && proposal->gain < continuous::kWorthAsking) {
      if (proposal_ && proposal_->cause == Cause::kDrift)
        forgetProposal(lock);
      return;
    }
    const bool is_news = !proposal_ || proposal_->cameras != proposal->cameras;
    proposal_ = proposal;
    const std::string text = proposal->message + "; apply (A in calibrate) uses that";
    context_.status(lock).setProposal(*proposal, text);
    if (applies) {
      const Reply applied = applyProposal(lock);
      ROS_WARN_STREAM(applied.message);
    } else if (is_news) {
      ROS_WARN_STREAM(text);
    }
  }

  /// Once for each.
  void sayContradiction() {
    if (continuous_->contradiction() == contradiction_)
      return;
    contradiction_ = continuous_->contradiction();
    if (!contradiction_.empty())
      ROS_WARN_STREAM(contradiction_);
  }

  bool appliesItself(Cause cause) const {
    return policy_ == ContinuousPolicy::kAll ||
           (policy_ == ContinuousPolicy::kKnocked && cause != Cause::kDrift);
  }

  /// idWithoutMasks() of the rig in use, or of the one that it approaches. Empty: there is none.
  std::string idToWatch(const Lock& lock) const {
    const auto& rig = context_.rig(lock);
    return rig ? continuous::idWithoutMasks(changes_.goal(*rig)) : "";
  }

  /// Watches the rig in use from now on, or the one that it approaches.
  void watchRig(const Lock& lock) {
    const auto& rig = context_.rig(lock);
    changes_.follow(rig);
    if (idToWatch(lock) == watched_)
      return;
    watched_ = idToWatch(lock);
    continuous_.reset();
    new_clocks_.clear();
    contradiction_.clear();
    forgetProposal(lock);
    if (rig)
      continuous_.emplace(changes_.goal(*rig), options_);
  }

  /// Lets update() begin anew, with later images only. By itself it would not notice a rig that was
  /// changed and changed back since its last call.
  void watchAnew(const Lock& lock) {
    watched_.clear();
    one_led_inputs_.take(lock);
  }

  void stepTowardsGoal(const std::vector<Input>& inputs, const Lock& lock) {
    double newest = 0.0;  // [s]
    for (const Input& input : inputs) {
      if (!input.specific_force)
        newest = std::max(newest, input.image.stamp);
    }
    if (newest == 0.0)
      return;
    const geometry::Rig before = *context_.rig(lock);
    const auto rig = changes_.step(before, newest);
    if (!rig)
      return;
    context_.knownPlaces(lock).renameRig(before.id(), rig->id());
    context_.setRig(*rig,
                    changes_.isApproaching() ? "the adjusted rig is approached " + kSteps
                                             : "the adjusted rig is in use",
                    lock, goalFrom(*rig));
  }

  /// The rig that this one approaches, so that a person waits, and `save` keeps it; nothing: none.
  std::optional<geometry::Rig> goalFrom(const geometry::Rig& rig) const {
    if (!changes_.isApproaching())
      return std::nullopt;
    return continuous::appliedRig(changes_.goal(rig), rig);
  }

  void tellGoal(const Lock& lock) {
    const auto& rig = context_.rig(lock);
    context_.calibration(lock).setGoal(rig ? goalFrom(*rig) : std::nullopt);
  }

  void forgetProposal(const Lock& lock) {
    proposal_.reset();
    context_.status(lock).forgetProposal();
  }

  std::optional<continuous::Proposal> newestProposal(const std::vector<Input>& inputs) {
    std::optional<continuous::Proposal> newest;
    for (const Input& input : inputs) {
      if (input.specific_force)
        continuous_->addAcceleration(input.image.camera, *input.specific_force);
      else if (auto proposal = continuous_->add(input.image))
        newest = std::move(proposal);
    }
    return newest;
  }

  std::string whatIsNeeded(const geometry::Rig& rig) const {
    if (!health::isCorrectable(rig))
      return "no camera of this rig can be solved against the others: if one was moved, " +
             health::putBack(rig, true);
    if (!contradiction_.empty())
      return contradiction_;
    if (new_clocks_.size() > 1)
      return joined(new_clocks_) +
             " have new clocks since they were calibrated, which are solved while an LED moves "
             "where three cameras see it that were not moved; then one that was moved is solved";
    return "a camera that no longer fits the others is solved while an LED moves where it and two "
           "others see it";
  }

  Reply apply(Trigger&, Lock& lock) { return applyProposal(lock); }

  /// The rig before is kept for revert(), the new one in a file beside the rig file.
  Reply applyProposal(Lock& lock) {
    if (policy_ == ContinuousPolicy::kOff)
      throw Refusal(
          ros::this_node::getName() +
          "/continuous_policy is off, so nothing is proposed: set it to propose, and start "
          "the node again");
    requireCalibrated(lock);
    const geometry::Rig before = context_.existingRig("to change", lock);
    if (!proposal_)
      throw Refusal("nothing is proposed: " + whatIsNeeded(before));
    if (!changes_.isInUse(before))
      throw Refusal(NodeContext::kReplaced);
    const continuous::Proposal proposal = *proposal_;
    forgetProposal(lock);
    const auto rig = changes_.apply(proposal, before);
    watchAnew(lock);
    if (rig) {
      context_.status(lock).setHealth({});  // of the poses before
      if (proposal.cause == Cause::kDrift)  // too little for what was measured to change
        context_.knownPlaces(lock).renameRig(before.id(), rig->id());
      context_.setRig(*rig, proposal.message, lock, goalFrom(*rig));
    } else {
      tellGoal(lock);
    }
    const geometry::Rig goal = changes_.goal(*context_.rig(lock));
    return {true, (rig ? "in use: " : "approached " + kSteps + ": ") + proposal.message +
                      recalibrate::describeOldMasks(before, goal) + "; " +
                      keepVersion(goal, &lock) +
                      "; revert (b in calibrate) goes back, and save keeps it"};
  }

  /// Writes a rig beside the rig file. @returns where, or why not.
  std::string keepVersion(const geometry::Rig& rig, Lock* lock) {
    const std::string rig_file = context_.parameters(*lock).rig_file;
    try {
      return "kept in " + context_.compute(lock, [&] {
        return wiimote_tracker::keepVersion(rig, NodeContext::now(), rig_file);
      });
    } catch (const Error& error) {
      return std::string("there is no file of it: ") + error.what();
    }
  }

  Reply revert(Trigger&, Lock& lock) {
    requireCalibrated(lock);
    const auto before = changes_.revert(context_.existingRig("to change", lock));
    if (!before)
      throw Refusal("no change of continuous calibration is left to undo; " +
                    describeEarlierRigs(context_.parameters(lock).rig_file));
    watchAnew(lock);
    const std::string message =
        "the rig before the last change is in use again; changes are only proposed from now on";
    context_.setRig(*before, message, lock);
    return {true, message};
  }

  void requireCalibrated(const Lock& lock) const {
    context_.existingRig("to change", lock);
    if (!isCalibrated(lock))
      throw Refusal("a calibration is going on: solve it, or cancel it, first");
  }

  NodeContext& context_;
  InputQueue& one_led_inputs_;
  ContinuousPolicy policy_;
  continuous::Options options_;
  continuous::RigChanges changes_;
  std::string watched_;                                          // idToWatch() of the last update.
  std::optional<continuous::ContinuousCalibration> continuous_;  // Nothing without a rig.
  std::vector<std::string> new_clocks_;                          // Of the rig that is watched.
  std::optional<continuous::Proposal> proposal_;                 // For the rig that is watched.
  std::string contradiction_;  // The warning on the watched rig that was logged last; empty: none.
  ros::WallTimer timer_;
};

}  // namespace

NodePart continuousServices(NodeContext* context, InputQueue* one_led_inputs) {
  return std::make_shared<ContinuousServices>(context, one_led_inputs);
}

}  // namespace wiimote_tracker
