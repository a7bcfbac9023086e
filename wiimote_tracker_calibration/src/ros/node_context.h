#pragma once

#include "remap/measured_points.h"
#include "samples/verdict.h"
#include "workflow/calibration.h"

#include "camera_inputs.h"
#include "parameters.h"
#include "requests.h"
#include "status_publisher.h"

#include <ros/node_handle.h>
#include <tf2_ros/static_transform_broadcaster.h>

#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace wiimote_tracker {

/// A step that takes time, and that `cancel` stops.
struct Job {
  workflow::Step step;
  std::string message;    ///< Shown meanwhile.
  std::string kept;       ///< What a cancel leaves as it was, for the reply.
  bool is_waved = false;  ///< The LED is waved meanwhile.
};

/// What the node's parts share. A part is constructed from it, offers its services, subscribes to
/// inputs() and lives as long as the node. Nobody holds the mutex while solving, writing files,
/// or calling a service.
class NodeContext {
 public:
  NodeContext(const ros::NodeHandle& nh, const Parameters& parameters);

  ros::NodeHandle& nh() { return nh_; }
  std::mutex& mutex() { return mutex_; }

  /// Notified at each image, and by notify().
  void notify() { changed_.notify_all(); }

  /// The clock of the images' stamps: ROS time, simulated or not [s].
  static double now();

  /// An image may arrive this long after its stamp [s]. A decision by stamps waits for so long.
  static constexpr double kUnderWay = 1.0;

  /// A request that watches the cameras for a shorter time may find no image of one that sends
  /// twenty in a second [s].
  static constexpr double kShortestLook = 0.05;

  CameraInputs& inputs() { return inputs_; }

  /// Offers the service calibration/<name> of this type. Its handler has the mutex locked, returns
  /// the reply, and fills the other fields of the response. What it throws becomes a refusal.
  /// @param shows_reply whether the status shows the reply.
  template <typename Part, typename Service>
  void offer(const std::string& name,
             workflow::Reply (Part::*handler)(Service&, Lock&),
             Part* part,
             bool shows_reply = true) {
    services_.push_back(nh_.advertiseService<typename Service::Request, typename Service::Response>(
        "calibration/" + name, [=](auto& request, auto& response) {
          Service call{request, {}};
          const workflow::Reply reply = replyOf([&] {
            Lock lock(mutex_);
            const workflow::Reply own = replyOf([&] { return (part->*handler)(call, lock); });
            return shows_reply ? show(own, lock) : own;
          });
          response = call.response;
          response.success = reply.success;
          response.message = reply.message;
          return true;
        }));
  }

  /// Calls twice a second, never two at a time of the same timer.
  ros::WallTimer everyHalfSecond(const std::string& name, const std::function<void()>& call);

  /// Before the parts are destroyed: returns when no request and no image reaches them any more.
  void stop();

  // --- All of the following with the mutex locked.

  /// Does a job: begins its step, does the work and ends the step, whatever the work throws. The
  /// calibration refuses everything but `cancel` meanwhile. @returns the reply to the request.
  workflow::Reply run(const Job& job, Lock* lock, const std::function<workflow::Reply()>& work);

  /// Whether the job that runs was cancelled and should end, by refusing.
  bool isCancelled(const Lock&) const { return calibration_.isStopping(); }
  /// @throws Refusal: it was.
  void requireNotCancelled(const Lock& lock) const {
    if (isCancelled(lock))
      throw Refusal("it was cancelled");
  }
  void setProgress(double progress, const Lock&) { calibration_.setProgress(progress); }

  /// Waits until done() is true (checked with the mutex locked at each image, and ten times a
  /// second at least), until now() is beyond `end`, or until the node is to end. Simulated time
  /// that stands still for ten seconds, as of a bag that is over, ends the wait too. Time that
  /// jumps back, as of a bag that starts over, takes `end` with it.
  /// @returns done().
  bool waitUntil(Lock* lock, double end, const std::function<bool()>& done);

  /// Why a capture cannot go on; what to do follows.
  static constexpr char kTimeJumpedBack[] =
      "time jumped back, as where a bag starts over or a clock is set: ";

  /// Why waitUntil() returned false before its end.
  static const char* whyEndedEarly();

  /// As waitUntil(), for what needs images in the order of time.
  /// @throws Refusal: time jumped back before done(), or the wait ended before its end.
  void waitInOrder(Lock* lock, double end, const std::function<bool()>& done);

  /// Waits for some time, and sets the progress meanwhile.
  /// @throws Refusal: as waitInOrder(), or the job was cancelled.
  void waitFor(double duration, Lock* lock);

  /// Works without the lock. It is locked again afterwards, whatever is thrown.
  template <typename Work>
  static auto unlocked(Lock* lock, const Work& work) {
    lock->unlock();
    const AtEnd relock{[&] { lock->lock(); }};
    return work();
  }

  /// The same, for a request.
  template <typename Compute>
  auto compute(Lock* lock, const Compute& compute) {
    return unlocked(lock, [&, fault_now = fault] {
      fault_now();
      return compute();
    });
  }

  /// Looks for cameras that have appeared, without the lock.
  void discover(Lock* lock);

  /// For tests: called while a request waits or computes. It may throw.
  std::function<void()> fault = [] {};

  /// A part may copy them, and change its own, such as a camera's intrinsics.
  Parameters& parameters(const Lock&) { return parameters_; }
  workflow::Calibration& calibration(const Lock&) { return calibration_; }
  StatusPublisher& status(const Lock&) { return status_; }
  /// Works with the known places, after those that another rig measured were dropped; the reply
  /// says so.
  workflow::Reply withPlaces(
      const std::function<workflow::Reply(remap::MeasuredPoints& places)>& work,
      const Lock&);
  /// Measured with the current rig, or with another one.
  remap::MeasuredPoints& knownPlaces(const Lock&) { return known_places_; }

  /// Shows a reply in the status at once. @returns it.
  workflow::Reply show(const workflow::Reply& reply, const Lock& lock);

  /// What is known of these cameras, for a calibration that is captured live.
  /// @throws Refusal: starting intrinsics do not fit the size of a camera's images.
  workflow::CameraFacts facts(const std::vector<std::string>& cameras, const Lock&) const;
  /// All that was captured so far, to be solved or saved. @throws Refusal as facts().
  samples::Samples samples(const Lock& lock) const;
  /// Continues from samples, with their masks.
  workflow::Reply setSamples(const samples::Samples& samples, const Lock& lock);

  /// Cameras that a person removed from the rig: nobody is advised to add them.
  std::set<std::string>& removedCameras(const Lock&) { return removed_cameras_; }

  /// Why no rig was loaded at the start, and what to do; set by the part that loads it.
  std::string& whyNoRig(const Lock&) { return why_no_rig_; }

  /// Nothing while there is none.
  const std::optional<geometry::Rig>& rig(const Lock&) const { return calibration_.rig(); }
  /// @param purpose for the refusal, such as "to save". @throws Refusal: there is no rig.
  const geometry::Rig& existingRig(const std::string& purpose, const Lock&) const;
  /// The rig in use, or the corrected one that it approaches.
  /// @param purpose for the refusal, such as "to save". @throws Refusal: there is no rig.
  geometry::Rig rigToChange(const std::string& purpose, const Lock& lock) const;
  static constexpr char kReplaced[] = "the rig was replaced meanwhile: send the request again";
  /// @throws Refusal: the rig in use has another id.
  void requireSameRig(const std::string& id, const Lock&) const;
  /// Replaces the rig by a changed one, such as with a recalibrated camera or a correction of the
  /// volume, and publishes it.
  /// @param goal which rig that one approaches, see workflow::Calibration::setGoal().
  void setRig(const geometry::Rig& rig,
              const std::string& message,
              const Lock& lock,
              const std::optional<geometry::Rig>& goal = std::nullopt);
  /// Publishes the current rig, the transforms of its cameras, and its verdict.
  void publishRig(const samples::Verdict& verdict, const Lock&);

  /// Sets the masks of the images and of the rig, which is then published.
  /// @returns whether there is a rig and it changed.
  bool setMasks(const capture::Masks& masks, const Lock& lock);

  void publishStatus(const Lock&) { status_.publish(verdict_); }

 private:
  ros::NodeHandle nh_;
  std::mutex mutex_;
  std::condition_variable changed_;
  Parameters parameters_;
  workflow::Calibration calibration_;
  remap::MeasuredPoints known_places_;
  std::set<std::string> removed_cameras_;
  std::string why_no_rig_;
  samples::Verdict verdict_;  // of the current rig
  ros::Publisher rig_publisher_;
  ros::Publisher verdict_publisher_;
  tf2_ros::StaticTransformBroadcaster transforms_;
  CameraInputs inputs_;
  StatusPublisher status_;
  std::vector<ros::ServiceServer> services_;
};

}  // namespace wiimote_tracker
