#include "point_output.h"

#include "point_message.h"
#include "wiimote_tracker_triangulation/ros/message_fields.h"

#include <boost/make_shared.hpp>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace wiimote_tracker {
namespace {

using wiimote_tracker_msgs::TrackedPoint;
using wiimote_tracker_msgs::TrackedPointArray;

// After a longer silence of all cameras, outputs at a fixed rate are skipped [s].
constexpr double kLongestSilence = 0.5;

constexpr double kNever = -std::numeric_limits<double>::infinity();

/// Inserts points that the message does not have, in the order of their ids.
void insertMissing(const std::vector<TrackedPoint>& points, TrackedPointArray* message) {
  for (const TrackedPoint& point : points) {
    const auto place =
        std::lower_bound(message->points.begin(), message->points.end(), point.id,
                         [](const TrackedPoint& p, std::uint32_t id) { return p.id < id; });
    if (place == message->points.end() || place->id != point.id)
      message->points.insert(place, point);
  }
}

}  // namespace

PointOutput::PointOutput(const TrackingParameters& parameters,
                         const identity::LedLabels* labels,
                         MessageSink* sink)
    : options_(parameters.output),
      method_(methodWord(parameters.estimator)),
      labels_(labels),
      sink_(sink),
      zones_(parameters.zones),
      trigger_(parameters.trigger),
      refusals_(parameters.trigger) {
  newest_.time = kNever;
}

bool PointOutput::setRig(const geometry::Rig& rig,
                         const std::string& rig_id,
                         tracking::Estimator* estimator) {
  if (!haveSameCameras(rig, rig_)) {
    // Snapshots name cameras by their places in the rig: those from before would name others.
    newest_.time = kNever;
    trigger_.forget();
    is_used_.assign(rig.cameras.size(), true);
  }
  rig_ = rig;
  rig_id_ = rig_id;
  estimator_ = estimator;
  zones_.setZones(rig.zones);
  return correction_.take(rig);
}

void PointOutput::restart() {
  zones_.loseAll();
  trigger_.forget();
  lost_.clear();
  newest_.time = kNever;
  newest_output_ = kNever;
  newest_arrival_ = kNever;
  newest_tick_.reset();
}

/// The arrival times of images clock the outputs at a fixed rate. An image with a wrong clock,
/// which the estimator will drop, must not: after an output at its time, perhaps years ahead, there
/// would be no other.
void PointOutput::takeArrival(std::size_t camera, double arrival) {
  const double rate = options_.rate;
  if (!(rate > 0.0) || !is_used_[camera] || !(arrival <= newest_arrival_ + kLongestSilence))
    return;
  const auto last = static_cast<std::int64_t>(std::floor(arrival * rate));
  const auto longest = static_cast<std::int64_t>(kLongestSilence * rate);
  if (!newest_tick_ || last > *newest_tick_ + longest)
    newest_tick_ = last - 1;
  while (*newest_tick_ < last) {
    ++*newest_tick_;
    if (options_.predict_to_now)
      publishAt(*newest_tick_ / rate);
    else
      publish(newest_);
  }
}

void PointOutput::noteUse(std::size_t camera, double arrival, bool is_used) {
  is_used_[camera] = is_used;
  if (is_used)
    newest_arrival_ = std::max(newest_arrival_, arrival);
}

void PointOutput::takeSnapshot(const tracking::Snapshot& snapshot) {
  newest_ = snapshot;
  correction_.apply(&newest_);
  for (const tracking::TrackedLed& led : newest_.leds) {
    if (led.state == tracking::TrackState::kLost)
      lost_.push_back(trackedPoint(led, newest_.time, rig_, *labels_));
  }
  publishZoneEvents();
  trigger_.add(snapshot);
  answerTriggers();
  if (!options_.on_update)
    return;
  if (options_.predict_to_now)
    publishAt(std::max(snapshot.time, snapshot.latest_arrival));
  else
    publish(newest_);
}

void PointOutput::publishZoneEvents() {
  for (const events::ZoneCrossing& crossing : zones_.update(newest_)) {
    wiimote_tracker_msgs::ZoneEvent event;
    event.header.stamp = timeOf(crossing.time);
    event.header.frame_id = rig_.world_frame;
    event.zone = crossing.zone;
    event.id = crossing.led;
    event.label = labels_->of(crossing.led).name;
    event.event = crossing.entered ? wiimote_tracker_msgs::ZoneEvent::ENTERED
                                   : wiimote_tracker_msgs::ZoneEvent::LEFT;
    event.position = pointOf(crossing.position);
    sink_->onZoneEvent(event);
  }
}

void PointOutput::takeTrigger(const std_msgs::Header& trigger) {
  trigger_.ask(trigger.stamp.toSec(), trigger.stamp.toNSec());
  answerTriggers();
}

void PointOutput::finish() {
  trigger_.finish();
  answerTriggers();
  reportRefusals(std::numeric_limits<double>::infinity());
}

void PointOutput::answerTriggers() {
  while (const events::TriggerAnswer* answer = trigger_.next()) {
    ros::Time asked;  // to the nanosecond
    asked.fromNSec(answer->request);
    if (answer->result == events::TriggerResult::kAnswered) {
      corrected_ = answer->snapshot;
      correction_.apply(&corrected_);
      TrackedPointArray message = messageOf(corrected_);
      message.header.stamp = asked;
      sink_->onTriggeredPoints(message);
    } else {
      std::ostringstream stamp;
      stamp << asked;
      refusals_.add(answer->result, stamp.str());
    }
  }
  reportRefusals(newest_arrival_);
}

void PointOutput::reportRefusals(double now) {
  while (const auto sentence = refusals_.next(now))
    sink_->onProblem(*sentence);
}

void PointOutput::publishAt(double time) {
  if (time < newest_.time || !estimator_->predictTo(time, &corrected_))
    return;
  correction_.apply(&corrected_);
  publish(corrected_);
}

void PointOutput::publish(const tracking::Snapshot& corrected) {
  constexpr double kRounding = 1e-6;  // of a time since 1970 [s]
  if (!(corrected.time > newest_output_ &&
        corrected.time >= newest_output_ + options_.interval - kRounding))
    return;
  newest_output_ = corrected.time;
  const auto message = boost::make_shared<TrackedPointArray>(messageOf(corrected));
  insertMissing(lost_, message.get());
  lost_.clear();
  sink_->onPoints(message, corrected.views);
}

TrackedPointArray PointOutput::messageOf(const tracking::Snapshot& corrected) const {
  TrackedPointArray message = pointMessage(corrected, rig_, *labels_);
  message.method = method_;
  message.rig_id = rig_id_;
  message.late_frames = estimator_->counters().late;
  return message;
}

}  // namespace wiimote_tracker
