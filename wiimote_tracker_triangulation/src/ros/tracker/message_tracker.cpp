#include "message_tracker.h"

#include "body_message.h"
#include "wiimote_tracker_triangulation/estimators/make_estimator.h"
#include "wiimote_tracker_triangulation/geometry/error.h"
#include "wiimote_tracker_triangulation/ros/conversions.h"

#include <wiimote_tracker_msgs/text.h>
#include <boost/make_shared.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <sstream>
#include <utility>

namespace wiimote_tracker {
namespace {

using wiimote_tracker_msgs::TrackedPoint;
using wiimote_tracker_msgs::TrackedPointArray;

// After a longer silence of all cameras, outputs at a fixed rate are skipped [s].
constexpr double kLongestSilence = 0.5;

// Of the world's z axis, with which the IMU of a body is used [rad].
constexpr double kMostTilt = 10.0 * M_PI / 180.0;

constexpr double kNever = -std::numeric_limits<double>::infinity();

bool isSame(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return a.rows() == b.rows() && a.cols() == b.cols() && a == b;
}

/// The angle between the world's z axis and up, by the cameras' accelerometers [rad]; 0: not known.
double tiltOf(const geometry::Rig& rig) {
  Eigen::Vector3d up = Eigen::Vector3d::Zero();
  for (const geometry::RigCamera& camera : rig.cameras) {
    if (camera.gravity)
      up += (camera.camera.world_from_camera.linear() * *camera.gravity).normalized();
  }
  return std::atan2(up.head<2>().norm(), up.z());
}

/// @throws geometry::InvalidRigError: a frame of the rig has the name of an LED or of a body.
void checkFrames(const geometry::Rig& rig,
                 const std::vector<std::string>& labels,
                 const std::vector<body::Constellation>& bodies) {
  for (const std::string& frame : rig.frames()) {
    if (std::find(labels.begin(), labels.end(), frame) != labels.end())
      throw geometry::InvalidRigError("its frame '" + frame +
                                      "' has the name of an LED: rename that LED in labels");
    if (std::any_of(bodies.begin(), bodies.end(),
                    [&](const auto& body) { return body.name == frame; }))
      throw geometry::InvalidRigError(
          "its frame '" + frame +
          "' has the name of a body: rename that body in its file (bodies/file)");
  }
}

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

MessageTracker::MessageTracker(const TrackingParameters& parameters, MessageSink* sink)
    : parameters_(parameters),
      sink_(sink),
      bodies_(parameters.bodies.options),
      sightings_({parameters.identity.exposure, parameters.estimator.tracks.merging_distance}),
      labels_(parameters.labels),
      zones_(parameters.zones),
      trigger_(parameters.trigger),
      refusals_(parameters.trigger) {
  newest_.time = kNever;
  bodies_.setBodies(parameters.bodies.known);
  if (parameters.identity.codes)
    identifier_ = std::make_unique<identity::Identifier>(*parameters.identity.codes,
                                                         parameters.identity.identifier);
}

MessageTracker::RigChange MessageTracker::takeRig(
    const wiimote_tracker_msgs::RigCalibration& message) {
  const geometry::Rig rig = fromMessage(message);
  checkFrames(rig, parameters_.allLabels(), bodies_.constellations());
  RigChange change;
  if (!estimator_) {
    estimator_ = estimators::makeEstimator(rig, parameters_.estimator);
    change.cameras = true;
  } else if (rig.id() != rig_.id() || !isSame(rig.covariance, rig_.covariance)) {
    estimator_->setRig(rig);
    change.cameras = true;
  }
  if (change.cameras) {
    bodies_.setRig(rig);
    rig_id_ = idOf(message, rig);
    useCameras(rig);
    reported_faults_.useRig(rig_, rig, *estimator_);
    statistics_.setRig(rig);
    std::string sentence = rig.describeFarCamera();
    if (sentence.empty())
      sentence = describeRange(rig, parameters_.estimator);
    if (!std::exchange(alone_reported_, !sentence.empty()) && alone_reported_)
      sink_->onProblem(sentence);
  }
  rig_ = rig;
  tilt_ = tiltOf(rig);
  tilt_reported_ = tilt_reported_ && tilt_ > kMostTilt;
  zones_.setZones(rig_.zones);
  change.correction = correction_.take(rig_);
  sink_->onRig(rig_);
  return change;
}

/// Snapshots name cameras by their places in the rig: those from before would name others.
void MessageTracker::useCameras(const geometry::Rig& rig) {
  std::map<std::string, std::size_t> index;
  for (std::size_t i = 0; i < rig.cameras.size(); ++i)
    index[rig.cameras[i].camera.name] = i;
  if (index == camera_index_)
    return;
  camera_index_ = std::move(index);
  is_used_.assign(rig.cameras.size(), true);
  newest_.time = kNever;
  trigger_.forget();
}

void MessageTracker::takeImage(const std::string& camera,
                               const wiimote_tracker_msgs::IrBlobArray& message) {
  const auto found = camera_index_.find(camera);
  if (found == camera_index_.end())
    return;
  const std::size_t index = found->second;
  const ImageFault fault = readImage(message, rig_.cameras[index].camera, &image_);
  if (fault != ImageFault::kNone)
    reportProblem(index, describe(fault, message, rig_.cameras[index].camera),
                  reported_faults_.isNew(index, fault));
  if (!isUsable(fault))
    return;
  statistics_.addImage(index, image_, message.frame);

  const tracking::ClockError clock = estimator_->clockError(index, image_.clock_epoch);
  statistics_.setClock(index, clock);
  bodies_.take(index, clock, &image_);
  publishBodies();
  if (clocksOutputs(index, image_.arrival))
    publishTicksUntil(image_.arrival);
  const std::uint64_t dropped = estimator_->counters().dropped;
  estimator_->add(index, image_);
  if (const auto camera_fault = estimator_->cameraFault(index))
    reportProblem(index, describe(*camera_fault, camera),
                  reported_faults_.isNew(index, camera_fault->kind));
  if (estimator_->counters().resets != resets_)
    restart();
  is_used_[index] = estimator_->counters().dropped == dropped;
  if (is_used_[index])
    newest_arrival_ = std::max(newest_arrival_, image_.arrival);
  while (const tracking::Snapshot* snapshot = estimator_->next())
    takeSnapshot(*snapshot);
}

void MessageTracker::setBodies(const std::vector<body::Constellation>& bodies) {
  const std::vector<body::Constellation> before = bodies_.constellations();
  const body::BodySnapshot lost = bodies_.setBodies(bodies);
  const auto message = bodyMessage(lost, before, rig_, rig_id_);
  if (!message.bodies.empty())
    sink_->onBodies(message, std::vector<bool>(message.bodies.size(), false));
  statistics_.setBodies(0);  // until the next image
}

void MessageTracker::takeInertial(const std::string& body, const sensor_msgs::Imu& message) {
  const std::vector<body::Constellation>& bodies = bodies_.constellations();
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (bodies[b].name != body || !bodies[b].imu)
      continue;
    if (tilt_ > kMostTilt) {
      reportTilt();
      return;
    }
    if (const auto sample = inertialSample(message, *bodies[b].imu))
      bodies_.addInertial(b, *sample);
  }
}

void MessageTracker::reportTilt() {
  if (std::exchange(tilt_reported_, true))
    return;
  sink_->onProblem(
      format("the world's z axis is %.0f degrees from up by the cameras' accelerometers, so the "
             "IMUs of bodies are not used: calibrate with a level square, its corners taken "
             "counter-clockwise",
             tilt_ * 180.0 / M_PI));
}

void MessageTracker::publishBodies() {
  const body::BodySnapshot* snapshot = bodies_.next();
  if (!snapshot)
    return;
  bridged_.clear();
  std::size_t tracked = 0;
  for (std::size_t b = 0; b < snapshot->bodies.size(); ++b) {
    const body::Constellation& constellation = bodies_.constellations()[b];
    const std::optional<body::BodyEstimate>& body = snapshot->bodies[b];
    if (!body)
      continue;
    tracked += body->tracked ? 1 : 0;
    if (tilt_ <= kMostTilt) {
      if (const auto sentence = imu_reports_.add(constellation, *body, snapshot->time))
        sink_->onProblem(*sentence);
    }
    bridged_.push_back(body->inertial && !body->tracked);
  }
  statistics_.setBodies(tracked);
  sink_->onBodies(bodyMessage(*snapshot, bodies_.constellations(), rig_, rig_id_), bridged_);
}

/// Starts bodies whose LEDs are identified by blinking.
void MessageTracker::findBodiesByLabels(const tracking::Snapshot& snapshot) {
  labelled_.clear();
  for (const tracking::TrackedLed& led : snapshot.leds) {
    const identity::LedLabel label = labels_.of(led.id);
    if (label.identified && led.state == tracking::TrackState::kTracked)
      labelled_.push_back({label.name, led.position, led.position_covariance});
  }
  if (labelled_.size() >= 3)
    bodies_.startFromLabels(labelled_);
}

void MessageTracker::reportProblem(std::size_t camera, const std::string& sentence, bool is_new) {
  statistics_.addProblem(camera, sentence);
  if (is_new)
    sink_->onProblem(sentence);
}

void MessageTracker::restart() {
  resets_ = estimator_->counters().resets;
  if (identifier_)
    identifier_->reset();
  labels_.clear();
  zones_.loseAll();
  trigger_.forget();
  lost_.clear();
  newest_.time = kNever;
  newest_output_ = kNever;
  newest_arrival_ = kNever;
  newest_tick_.reset();
  sink_->onProblem(
      "time jumped back, tracking starts anew; unless a bag was restarted, synchronise the clocks "
      "of the computers");
}

void MessageTracker::takeSnapshot(const tracking::Snapshot& tracked) {
  statistics_.addSnapshot(tracked);
  if (identifier_)
    sightings_.add(rig_, tracked, identifier_.get());
  labels_.update(tracked.time, tracked.leds, identifier_.get());
  reportDoubtfulLabels();
  if (identifier_)
    findBodiesByLabels(tracked);
  const tracking::Snapshot& snapshot = sink_->onSnapshot(tracked);
  newest_ = snapshot;
  correction_.apply(&newest_);
  for (const tracking::TrackedLed& led : newest_.leds) {
    if (led.state == tracking::TrackState::kLost)
      lost_.push_back(trackedPoint(led, newest_.time, rig_, labels_));
  }
  publishZoneEvents(newest_);
  trigger_.add(snapshot);
  answerTriggers();
  if (!parameters_.output.on_update)
    return;
  if (parameters_.output.predict_to_now)
    publishAt(std::max(snapshot.time, snapshot.latest_arrival));
  else
    publish(newest_);
}

void MessageTracker::reportDoubtfulLabels() {
  std::string labels;
  for (const std::string& label : labels_.doubtful())
    labels += format("%s%s (%.2f)", labels.empty() ? "" : ", ", label.c_str(),
                     labels_.places().at(label).confidence);
  if (!labels.empty())
    sink_->onProblem(
        "labels may be wrong after LEDs were out of sight or met (probability of being right): " +
        labels + "; check which LED has which, or let LEDs blink by codes");
}

void MessageTracker::publishZoneEvents(const tracking::Snapshot& snapshot) {
  for (const events::ZoneCrossing& crossing : zones_.update(snapshot)) {
    wiimote_tracker_msgs::ZoneEvent event;
    event.header.stamp = timeOf(crossing.time);
    event.header.frame_id = rig_.world_frame;
    event.zone = crossing.zone;
    event.id = crossing.led;
    event.label = labels_.of(crossing.led).name;
    event.event = crossing.entered ? wiimote_tracker_msgs::ZoneEvent::ENTERED
                                   : wiimote_tracker_msgs::ZoneEvent::LEFT;
    event.position = pointOf(crossing.position);
    sink_->onZoneEvent(event);
  }
}

void MessageTracker::takeTrigger(const std_msgs::Header& trigger) {
  trigger_.ask(trigger.stamp.toSec(), trigger.stamp.toNSec());
  answerTriggers();
}

void MessageTracker::finish() {
  trigger_.finish();
  answerTriggers();
  reportRefusals(std::numeric_limits<double>::infinity());
}

void MessageTracker::answerTriggers() {
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

void MessageTracker::reportRefusals(double now) {
  while (const auto sentence = refusals_.next(now))
    sink_->onProblem(*sentence);
}

/// Whether an image may clock outputs. One with a wrong clock, which the estimator will drop, must
/// not: after an output at its time, perhaps years ahead, there would be no other.
bool MessageTracker::clocksOutputs(std::size_t camera, double arrival) const {
  return is_used_[camera] && arrival <= newest_arrival_ + kLongestSilence;
}

/// Output at a fixed rate, clocked by the arrival times of images: an output is published when the
/// first image arrives at or after its time, without using that image.
void MessageTracker::publishTicksUntil(double now) {
  const double rate = parameters_.output.rate;
  if (!(rate > 0.0))
    return;
  const auto last = static_cast<std::int64_t>(std::floor(now * rate));
  const auto longest = static_cast<std::int64_t>(kLongestSilence * rate);
  if (!newest_tick_ || last > *newest_tick_ + longest)
    newest_tick_ = last - 1;
  while (*newest_tick_ < last) {
    ++*newest_tick_;
    if (parameters_.output.predict_to_now)
      publishAt(*newest_tick_ / rate);
    else
      publish(newest_);
  }
}

void MessageTracker::publishAt(double time) {
  if (time < newest_.time || !estimator_->predictTo(time, &corrected_))
    return;
  correction_.apply(&corrected_);
  publish(corrected_);
}

void MessageTracker::publish(const tracking::Snapshot& corrected) {
  constexpr double kRounding = 1e-6;  // of a time since 1970 [s]
  if (!(corrected.time > newest_output_ &&
        corrected.time >= newest_output_ + parameters_.output.interval - kRounding))
    return;
  newest_output_ = corrected.time;
  const auto message = boost::make_shared<TrackedPointArray>(messageOf(corrected));
  insertMissing(lost_, message.get());
  lost_.clear();
  sink_->onPoints(message, corrected.views);
}

TrackedPointArray MessageTracker::messageOf(const tracking::Snapshot& corrected) const {
  TrackedPointArray message = pointMessage(corrected, rig_, labels_);
  message.method = methodWord(parameters_.estimator);
  message.rig_id = rig_id_;
  message.late_frames = estimator_->counters().late;
  return message;
}

}  // namespace wiimote_tracker
