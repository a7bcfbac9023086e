#include "node_parts.h"

#include "capture/corner_capture.h"
#include "continuous/rig_changes.h"
#include "place/check_place.h"
#include "place/measure_place.h"
#include "remap/measured_points.h"
#include "wiimote_tracker_calibration/remap/fit.h"

#include <std_srvs/Trigger.h>
#include <wiimote_tracker_msgs/AddKnownPlace.h>
#include <wiimote_tracker_msgs/CheckPlace.h>
#include <wiimote_tracker_msgs/FitRemap.h>
#include <wiimote_tracker_msgs/text.h>
#include <wiimote_tracker_triangulation/ros/message_fields.h>

#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace wiimote_tracker {

using std_srvs::Trigger;
using wiimote_tracker_msgs::AddKnownPlace;
using wiimote_tracker_msgs::CheckPlace;
using wiimote_tracker_msgs::FitRemap;
using workflow::Reply;
using workflow::Step;

namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr double kLongest = 3600.0;  // [s]
// A known place that is measured farther off is a mistake [expected standard deviations].
constexpr double kMostError = 5.0;
// No correction moves a place farther, and rooms that are joined are nearer [m].
constexpr double kLargestRoom = 50.0;

/// How far the measured place is from the one that was typed.
std::string distanceText(const Eigen::Vector3d& measured, const Eigen::Vector3d& known) {
  const double distance = (measured - known).norm();
  return format(", %.3f m from the known place", distance) +
         (distance > kLargestRoom
              ? ": was that typed in millimetres? Then drop it, and give it in metres"
              : "");
}

void fill(const place::MeasuredPlace& place,
          const place::PlaceCheck& check,
          CheckPlace::Response* response) {
  response->measured = pointOf(place.position);
  Eigen::Map<Eigen::Matrix3d>(response->covariance.data()) = place.covariance;  // symmetric
  for (const place::CameraResidual& each : place.residuals) {
    response->cameras.push_back(each.camera);
    response->residual.push_back(each.residual.norm());
  }
  response->error = check.error;
  response->expected_stddev = check.expected_stddev;
  response->consistent = check.consistent;
}

void setUnknown(CheckPlace::Response* response) {
  response->measured = pointOf(Eigen::Vector3d::Constant(kUnknown));
  response->covariance.fill(kUnknown);
  response->error = kUnknown;
  response->expected_stddev = kUnknown;
}

square::KnownPlace knownPlace(const CheckPlace::Request& request, double usual_stddev) {
  return {vectorOf(request.known),
          request.known_stddev != 0.0 ? request.known_stddev : usual_stddev};
}

class PlaceServices {
 public:
  explicit PlaceServices(NodeContext* context) : context_(*context) {
    using Self = PlaceServices;
    context->offer("check", &Self::check, this);
    context->offer("measure_place", &Self::measurePlace, this);
    context->offer("known_places/add", &Self::add, this);
    context->offer("known_places/undo", &Self::undo, this);
    context->offer("known_places/clear", &Self::clear, this);
    context->offer("known_places/fit", &Self::fit, this);
  }

 private:
  Reply check(CheckPlace& call, Lock& lock) {
    setUnknown(&call.response);
    const square::KnownPlace known =
        knownPlace(call.request, context_.parameters(lock).solve.square.uncertainty.placement);
    return measure(known, call.request.duration, &lock,
                   [&](const auto& measured, const auto& rig, const auto&) {
                     const place::MeasuredPlace place = place::corrected(rig, measured);
                     const place::PlaceCheck check =
                         place::checkPlace(place, known.position, known.stddev);
                     fill(place, check, &call.response);
                     ROS_INFO("Check at (%.3f, %.3f, %.3f) m: %s.", known.position.x(),
                              known.position.y(), known.position.z(), check.message.c_str());
                     return Reply{true, check.message};
                   });
  }

  Reply measurePlace(CheckPlace& call, Lock& lock) {
    setUnknown(&call.response);
    // Before a person holds the LED still for nothing.
    if (const std::string reason = context_.calibration(lock).whyNoPlace(); !reason.empty())
      throw Refusal(reason);
    const square::KnownPlace known = knownPlace(call.request, square::KnownPlace().stddev);
    return measure(
        known, call.request.duration, &lock, [&](const auto& place, const auto&, const auto& seen) {
          const place::PlaceCheck check = place::checkPlace(place, known.position, known.stddev);
          fill(place, check, &call.response);
          if (!place.rays_agree || check.error > kMostError * check.expected_stddev)
            throw Refusal(check.message);
          return context_.calibration(lock).addPlace(known, seen);
        });
  }

  Reply add(AddKnownPlace& call, Lock& lock) {
    call.response.measured = pointOf(Eigen::Vector3d::Constant(kUnknown));
    const auto work = [&](remap::MeasuredPoints& places) {
      square::KnownPlace known;
      known.position = vectorOf(call.request.known);
      places.requireNew(known.position);
      return measure(
          known, call.request.duration, &lock,
          [&](const auto& place, const auto& rig, const auto&) {
            if (!place.rays_agree)
              throw Refusal(place::checkPlace(place, known.position, 0.0).message);
            context_.requireSameRig(rig.id(), lock);
            // Without the present correction: the one that is fitted will replace it.
            const remap::KnownPoint point{place.position, known.position};
            const std::string unmoved = places.describeUnmoved(point);
            places.add(point);
            call.response.measured = pointOf(place.position);
            return Reply{
                true, format("place %zu measured at (%.3f, %.3f, %.3f) m", places.points().size(),
                             place.position.x(), place.position.y(), place.position.z()) +
                          distanceText(place.position, known.position) + unmoved};
          });
    };
    const Reply reply = context_.withPlaces(work, lock);
    call.response.places = static_cast<std::uint32_t>(context_.knownPlaces(lock).points().size());
    return reply;
  }

  Reply undo(Trigger&, Lock& lock) {
    const auto work = [](remap::MeasuredPoints& places) {
      if (!places.undo())
        throw Refusal("there is no known place to drop");
      return Reply{true,
                   "the latest place was dropped; left: " + std::to_string(places.points().size())};
    };
    return context_.withPlaces(work, lock);
  }

  Reply clear(Trigger&, Lock& lock) {
    context_.knownPlaces(lock).clear();
    return {true, "all known places were dropped"};
  }

  Reply fit(FitRemap& call, Lock& lock) {
    call.response.uncorrected_error = kUnknown;
    call.response.expected_error = kUnknown;
    const auto work = [&](const remap::MeasuredPoints& places) {
      context_.calibration(lock).requireIdle();
      const std::string rig_id = context_.existingRig("to correct", lock).id();
      const std::vector<remap::KnownPoint> points = places.points();
      std::vector<remap::Model> allowed;
      for (const std::string& name : call.request.models)
        allowed.push_back(remap::modelFromName(name));
      const remap::FitResult result =
          context_.compute(&lock, [&] { return remap::fitRemap(points, rig_id, allowed); });
      context_.calibration(lock).requireIdle();
      context_.requireSameRig(rig_id, lock);
      geometry::Rig rig = *context_.rig(lock);
      rig.remap = result.remap;
      call.response.model = remap::nameOf(result.remap.model);
      call.response.uncorrected_error = result.uncorrected_error;
      call.response.expected_error = result.expected_error;
      call.response.table = remap::table(result);
      const std::string message =
          "the volume is corrected (" + call.response.model + ")" +
          format(": known places were off by %.1f mm, expected now %.1f mm",
                 1e3 * result.uncorrected_error, 1e3 * result.expected_error) +
          appendix(result.warnings);
      std::optional<geometry::Rig> goal = context_.calibration(lock).goal();
      if (goal)
        goal = continuous::appliedRig(*goal, rig);
      context_.setRig(rig, message, lock, goal);
      return Reply{true, message};
    };
    return context_.withPlaces(work, lock);
  }

  /// What is done with a measured place and the rig that measured it.
  using Use = std::function<workflow::Reply(const place::MeasuredPlace&,
                                            const geometry::Rig&,
                                            const capture::CapturedCorner&)>;
  /// Waits until the LED has lain still, measures where it is, and passes that on.
  /// @param known refused before anything is measured if it cannot be a place.
  /// @param duration longest wait [s]; 0: the parameter.
  Reply measure(const square::KnownPlace& known, double duration, Lock* lock, const Use& use) {
    place::requirePlace(known.position, known.stddev);
    capture::CornerCaptureOptions options = context_.parameters(*lock).calibration.capture;
    if (duration != 0.0)
      options.timeout = duration;
    if (!(options.timeout >= NodeContext::kShortestLook && options.timeout <= kLongest))
      throw Refusal("the duration must be within 0.05 and 3600 s: correct it");
    const geometry::Rig rig = context_.existingRig("to measure with", *lock);
    const Job job = {Step::kMeasuring, "keep the LED still on the place", "nothing was measured"};
    return context_.run(job, lock, [&] {
      const capture::CapturedCorner seen = captureStillLed(rig, options, lock);
      const double pixel_stddev = context_.parameters(*lock).solve.square.uncertainty.pixel;
      return use(place::measurePlace(rig, seen, pixel_stddev), rig, seen);
    });
  }

  /// Captures the LED with all cameras of the rig.
  /// @throws Refusal: it was not still or not seen for long enough, or the job was cancelled.
  capture::CapturedCorner captureStillLed(const geometry::Rig& rig,
                                          const capture::CornerCaptureOptions& options,
                                          Lock* lock) {
    using State = capture::CornerCapture::State;
    std::vector<std::string> names, ignored;
    for (const geometry::RigCamera& each : rig.cameras) {
      const std::string& name = each.camera.name;
      (context_.inputs().whyIgnored({name}).empty() ? names : ignored).push_back(name);
    }
    const double start = NodeContext::now();
    capture::CornerCapture led(names, options, start);
    const auto watching =
        context_.inputs().watch([&](const capture::Image& image, const Lock&) { led.add(image); });
    const double end_time = start + options.timeout + 2.0 * NodeContext::kUnderWay;
    context_.waitInOrder(lock, end_time, [&] {
      led.update(NodeContext::now() - NodeContext::kUnderWay);
      context_.setProgress(led.progress(), *lock);
      return context_.isCancelled(*lock) || led.state() != State::kCollecting;
    });
    if (context_.isCancelled(*lock) || led.state() != State::kDone)
      throw Refusal(led.message() + (ignored.empty() ? "" : "; ") +
                    context_.inputs().whyIgnored(ignored));
    return led.result();
  }

  NodeContext& context_;
};

}  // namespace

NodePart placeServices(NodeContext* context) {
  return std::make_shared<PlaceServices>(context);
}

}  // namespace wiimote_tracker
