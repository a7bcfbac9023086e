#include "place_services.h"

#include "wiimote_tracker_calibration/place/check_place.h"
#include "wiimote_tracker_calibration/remap/fit.h"

#include "replies.h"

#include <wiimote_tracker_triangulation/geometry/error.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace wiimote_tracker {

using workflow::Step;

namespace {

constexpr double kLongest = 3600.0;  // [s]

Eigen::Vector3d fromMessage(const geometry_msgs::Point& point) {
  return {point.x, point.y, point.z};
}

geometry_msgs::Point toMessage(const Eigen::Vector3d& point) {
  geometry_msgs::Point message;
  message.x = point.x();
  message.y = point.y();
  message.z = point.z();
  return message;
}

std::string metres(const Eigen::Vector3d& point) {
  char text[96];
  std::snprintf(text, sizeof text, "(%.3f, %.3f, %.3f) m", point.x(), point.y(), point.z());
  return text;
}

}  // namespace

PlaceServices::PlaceServices(NodeContext* context) : context_(*context) {
  ros::NodeHandle& nh = context_.nh();
  services_ = {nh.advertiseService("calibration/check", &PlaceServices::check, this),
               nh.advertiseService("calibration/known_places/add", &PlaceServices::add, this),
               nh.advertiseService("calibration/known_places/undo", &PlaceServices::undo, this),
               nh.advertiseService("calibration/known_places/clear", &PlaceServices::clear, this),
               nh.advertiseService("calibration/known_places/fit", &PlaceServices::fit, this)};
  context_.inputs().subscribeImages([this](const capture::Image& image, const Lock&) {
    if (capture_)
      capture_->add(image);
  });
}

PlaceServices::Outcome PlaceServices::measure(double duration, Lock* lock) {
  Outcome outcome;
  capture::CornerCaptureOptions options = context_.parameters(*lock).calibration.capture;
  if (duration != 0.0)
    options.timeout = duration;
  if (!(options.timeout > 0.0 && options.timeout <= kLongest)) {
    outcome.reply = {false, "the duration must be within 0 and 3600 s: correct it"};
    return outcome;
  }
  if (!context_.rig(*lock)) {
    outcome.reply = {false, "there is no rig to measure with: solve or load one first"};
    return outcome;
  }
  outcome.rig = *context_.rig(*lock);
  outcome.reply = context_.begin(Step::kMeasuring, "keep the LED still on the place", *lock);
  outcome.begun = outcome.reply.success;
  if (!outcome.begun)
    return outcome;
  std::vector<std::string> names;
  for (const geometry::RigCamera& camera : outcome.rig.cameras)
    names.push_back(camera.camera.name);
  const double start = NodeContext::now();
  capture_.emplace(names, options, start);
  bool stopped = false;
  context_.waitUntil(lock, start + options.timeout + 2.0 * NodeContext::kUnderWay, [&] {
    stopped = context_.stopped(Step::kMeasuring, *lock);
    capture_->update(NodeContext::now() - NodeContext::kUnderWay);
    context_.setProgress(capture_->progress(), *lock);
    return stopped || capture_->state() != capture::CornerCapture::State::kCollecting;
  });
  const capture::CornerCapture capture = *capture_;
  capture_.reset();
  if (stopped) {
    outcome.reply = {false, "it was cancelled; nothing was measured"};
  } else if (capture.state() != capture::CornerCapture::State::kDone) {
    outcome.reply = {false, capture.message()};
  } else {
    try {
      outcome.place = place::measurePlace(
          outcome.rig, capture.result(), context_.parameters(*lock).solve.square.uncertainty.pixel);
    } catch (const geometry::Error& error) {
      outcome.reply = {false, error.what()};
    }
  }
  return outcome;
}

void PlaceServices::finish(const Outcome& outcome, const Lock& lock) {
  if (outcome.begun)
    context_.end(outcome.reply, lock);
  else
    context_.show(outcome.reply.message, lock);
}

bool PlaceServices::check(wiimote_tracker_msgs::CheckPlace::Request& request,
                          wiimote_tracker_msgs::CheckPlace::Response& response) {
  const double kNan = std::numeric_limits<double>::quiet_NaN();
  response.measured = toMessage(Eigen::Vector3d::Constant(kNan));
  response.covariance.fill(kNan);
  response.error = kNan;
  response.expected_stddev = kNan;
  Lock lock(context_.mutex());
  const double known_stddev = request.known_stddev != 0.0
                                  ? request.known_stddev
                                  : context_.parameters(lock).solve.square.uncertainty.placement;
  Outcome outcome = measure(request.duration, &lock);
  if (outcome.place) {
    try {
      const place::MeasuredPlace place = place::corrected(outcome.rig, *outcome.place);
      const place::PlaceCheck check =
          place::checkPlace(place, fromMessage(request.known), known_stddev);
      response.measured = toMessage(place.position);
      for (Eigen::Index row = 0; row < 3; ++row) {
        for (Eigen::Index column = 0; column < 3; ++column)
          response.covariance[static_cast<std::size_t>(3 * row + column)] =
              place.covariance(row, column);
      }
      for (const place::PlaceView& view : place.views) {
        response.cameras.push_back(view.camera);
        response.residual.push_back(view.residual.norm());
      }
      response.error = check.error;
      response.expected_stddev = check.expected_stddev;
      response.consistent = check.consistent;
      outcome.reply = {true, check.message};
    } catch (const geometry::Error& error) {
      outcome.reply = {false, error.what()};
    }
  }
  finish(outcome, lock);
  fill(outcome.reply, &response);
  return true;
}

std::string PlaceServices::dropPlacesOfOtherRigs(const Lock& lock) {
  const auto& rig = context_.rig(lock);
  const std::size_t dropped = context_.knownPlaces(lock).useRig(rig ? rig->id() : "");
  return dropped == 0 ? ""
                      : "; " + std::to_string(dropped) +
                            " places that were measured with another calibration were dropped";
}

bool PlaceServices::add(wiimote_tracker_msgs::AddKnownPlace::Request& request,
                        wiimote_tracker_msgs::AddKnownPlace::Response& response) {
  const double kNan = std::numeric_limits<double>::quiet_NaN();
  response.measured = toMessage(Eigen::Vector3d::Constant(kNan));
  Lock lock(context_.mutex());
  const Eigen::Vector3d known = fromMessage(request.known);
  Outcome outcome;
  if (known.allFinite())
    outcome = measure(request.duration, &lock);
  else
    outcome.reply = {false, "the known place is not finite: give x, y and z in metres"};
  const std::string dropped = dropPlacesOfOtherRigs(lock);
  if (outcome.place && !outcome.place->rays_agree) {
    outcome.reply = {false, place::checkPlace(*outcome.place, known, 0.0).message};
  } else if (outcome.place) {
    // Without correction: what is fitted is to replace the one there is.
    context_.knownPlaces(lock).add({known, outcome.place->position});
    response.measured = toMessage(outcome.place->position);
    outcome.reply = {true, "place " + std::to_string(context_.knownPlaces(lock).places().size()) +
                               " measured at " + metres(outcome.place->position)};
  }
  outcome.reply.message += dropped;
  finish(outcome, lock);
  fill(outcome.reply, &response);
  response.places = static_cast<std::uint32_t>(context_.knownPlaces(lock).places().size());
  return true;
}

bool PlaceServices::undo(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  const Lock lock(context_.mutex());
  const std::string dropped = dropPlacesOfOtherRigs(lock);
  response.success = context_.knownPlaces(lock).undo();
  response.message =
      (response.success
           ? "the latest place was dropped, " +
                 std::to_string(context_.knownPlaces(lock).places().size()) + " are left"
           : "there is no known place to drop") +
      dropped;
  context_.show(response.message, lock);
  return true;
}

bool PlaceServices::clear(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  const Lock lock(context_.mutex());
  context_.knownPlaces(lock).clear();
  response.success = true;
  response.message = "all known places were dropped";
  context_.show(response.message, lock);
  return true;
}

bool PlaceServices::fit(wiimote_tracker_msgs::FitRemap::Request& request,
                        wiimote_tracker_msgs::FitRemap::Response& response) {
  response.uncorrected_error = std::numeric_limits<double>::quiet_NaN();
  response.expected_error = std::numeric_limits<double>::quiet_NaN();
  Lock lock(context_.mutex());
  const std::string dropped = dropPlacesOfOtherRigs(lock);
  std::vector<remap::KnownPoint> points;
  for (const place::KnownPlace& place : context_.knownPlaces(lock).places())
    points.push_back({place.measured, place.known});
  const std::string rig_id = context_.knownPlaces(lock).rigId();
  lock.unlock();
  workflow::Reply reply;
  std::optional<remap::FitResult> result;
  try {
    remap::FitOptions options;
    if (!request.models.empty()) {
      options.models.clear();
      for (const std::string& name : request.models)
        options.models.push_back(remap::modelFromName(name));
    }
    if (rig_id.empty())
      reply = {false, "there is no rig: solve or load one, then measure known places"};
    else
      result = remap::fitRemap(points, rig_id, options);
  } catch (const geometry::Error& error) {
    reply = {false, error.what()};
  }
  lock.lock();
  if (result && (!context_.rig(lock) || context_.rig(lock)->id() != rig_id)) {
    reply = {false, "the calibration was changed meanwhile: measure the known places again"};
  } else if (result) {
    geometry::Rig rig = *context_.rig(lock);
    rig.remap = result->remap;
    char errors[96];
    std::snprintf(errors, sizeof errors, "known places were off by %.1f mm, expected now %.1f mm",
                  1000.0 * result->uncorrected_error, 1000.0 * result->expected_error);
    reply = {true, std::string("the volume is corrected (") + remap::nameOf(result->remap.model) +
                       "): " + errors + joined(result->warnings)};
    response.model = remap::nameOf(result->remap.model);
    response.uncorrected_error = result->uncorrected_error;
    response.expected_error = result->expected_error;
    response.table = remap::table(*result);
    context_.setRig(rig, reply.message, lock);
  }
  reply.message += dropped;
  if (!reply.success)
    context_.show(reply.message, lock);
  fill(reply, &response);
  return true;
}

}  // namespace wiimote_tracker
