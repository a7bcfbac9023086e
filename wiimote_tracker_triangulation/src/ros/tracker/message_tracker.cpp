#include "message_tracker.h"

#include "body_message.h"
#include "wiimote_tracker_triangulation/estimators/make_estimator.h"
#include "wiimote_tracker_triangulation/geometry/error.h"
#include "wiimote_tracker_triangulation/geometry/point_sensitivity.h"
#include "wiimote_tracker_triangulation/ros/conversions.h"

#include <wiimote_tracker_msgs/text.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace wiimote_tracker {
namespace {

bool isSame(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return a.rows() == b.rows() && a.cols() == b.cols() && a == b;
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

/// Whether a camera is where it was: else all were calibrated anew, perhaps with another origin.
bool isSameWorld(const geometry::Rig& before, const geometry::Rig& rig) {
  return std::any_of(rig.cameras.begin(), rig.cameras.end(), [&](const auto& each) {
    const geometry::RigCamera* same = before.find(each.camera.name);
    return same && geometry::haveSamePose(same->camera, each.camera);
  });
}

/// Whether two cameras mask what is at a place, as they do with a lamp.
bool isMasked(const geometry::Rig& rig, const Eigen::Vector3d& place) {
  const std::vector<std::size_t> seeing = geometry::camerasSeeing(rig, place);
  const auto masked = std::count_if(seeing.begin(), seeing.end(), [&](std::size_t i) {
    const geometry::RigCamera& camera = rig.cameras[i];
    return geometry::isMasked(camera.masks, *rig.rayCamera(camera).project(place));
  });
  return masked >= 2;
}

}  // namespace

MessageTracker::MessageTracker(const TrackingParameters& parameters,
                               MessageSink* sink,
                               SnapshotFilter* filter)
    : parameters_(parameters),
      sink_(sink),
      filter_(filter),
      sightings_({parameters.identity.exposure, parameters.estimator.tracks.merging_distance}),
      labels_(parameters.labels),
      bodies_(parameters.bodies.options),
      points_(parameters, &labels_, sink) {
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
    change.points = true;
  } else if (rig.id() != rig_.id() || !isSame(rig.covariance, rig_.covariance)) {
    estimator_->setRig(rig);
    change.points = true;
  }
  if (change.points) {
    bodies_.setRig(rig);
    rig_id_ = idOf(message, rig);
    reported_faults_.useRig(rig_, rig, *estimator_);
    statistics_.setRig(rig);
    if (!isSameWorld(rig_, rig))
      labels_.forgetPlaces();
    const std::string sentence = describeLoneCamera(rig, parameters_.estimator);
    if (!std::exchange(lone_camera_, !sentence.empty()) && lone_camera_)
      sink_->onProblem(sentence);
  }
  rig_ = rig;
  forgetLamps();
  imu_reports_.setRig(rig);
  change.correction = points_.setRig(rig, rig_id_, estimator_.get());
  if (filter_)
    filter_->setRig(rig);
  return change;
}

bool MessageTracker::takeImage(const std::string& camera,
                               const wiimote_tracker_msgs::IrBlobArray& message) {
  const geometry::RigCamera* found = rig_.find(camera);
  if (!found)
    return false;
  const std::size_t index = found - rig_.cameras.data();
  if (const auto fault = readImage(message, found->camera, &image_)) {
    reportProblem(index, fault->sentence, reported_faults_.isNew(index, fault->kind));
    if (!fault->leavesImageUsable())
      return false;
  }
  statistics_.addImage(index, image_, message.frame);

  const tracking::ClockError clock = estimator_->clockError(index, image_.clock_epoch);
  statistics_.setClock(index, clock);
  // Takes the bodies' spots out of the image.
  bodies_.take(index, clock, &image_, estimator_->isDoubtful(index));
  if (const body::BodySnapshot* snapshot = bodies_.next())
    publishBodies(*snapshot);
  points_.takeArrival(index, image_.arrival);
  const std::uint64_t dropped = estimator_->counters().dropped;
  estimator_->add(index, image_);
  if (const auto camera_fault = estimator_->cameraFault(index))
    reportProblem(index, describe(*camera_fault, camera),
                  reported_faults_.isNew(index, camera_fault->kind));
  if (estimator_->counters().resets != resets_)
    restart();
  points_.noteUse(index, image_.arrival, estimator_->counters().dropped == dropped);
  while (const tracking::Snapshot* snapshot = estimator_->next())
    takeSnapshot(*snapshot);
  return true;
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
    if (const auto sentence = imu_reports_.addSample())
      sink_->onProblem(*sentence);
    const auto sample = inertialSample(message, *bodies[b].imu);
    if (sample && imu_reports_.isLevel())
      bodies_.addInertial(b, *sample);
  }
}

void MessageTracker::publishBodies(const body::BodySnapshot& snapshot) {
  const std::vector<body::Constellation>& bodies = bodies_.constellations();
  bridged_.clear();
  std::size_t tracked = 0;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const std::optional<body::BodyEstimate>& body = snapshot.bodies[b];
    if (!body)
      continue;
    tracked += body->tracked ? 1 : 0;
    if (const auto sentence = imu_reports_.add(bodies[b], *body, snapshot.time))
      sink_->onProblem(*sentence);
    bridged_.push_back(body->inertial && !body->tracked);
  }
  statistics_.setBodies(tracked);
  sink_->onBodies(bodyMessage(snapshot, bodies, rig_, rig_id_), bridged_);
}

/// Starts bodies whose LEDs are identified by blinking.
void MessageTracker::startBodies(const tracking::Snapshot& snapshot) {
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
  points_.restart();
  sink_->onProblem(
      "time jumped back, tracking starts anew; unless a bag was restarted, synchronise the clocks "
      "of the computers");
}

void MessageTracker::takeSnapshot(const tracking::Snapshot& tracked) {
  statistics_.addSnapshot(tracked);
  if (identifier_)
    sightings_.add(rig_, tracked, identifier_.get());
  labels_.update(tracked.time, tracked.leds, identifier_.get());
  // The track of a lamp ends after its masks came.
  if (std::any_of(tracked.leds.begin(), tracked.leds.end(),
                  [](const auto& led) { return led.state == tracking::TrackState::kLost; }))
    forgetLamps();
  reportDoubtfulLabels();
  if (identifier_)
    startBodies(tracked);
  points_.takeSnapshot(filter_ ? filter_->apply(tracked) : tracked);
}

void MessageTracker::forgetLamps() {
  if (std::all_of(rig_.cameras.begin(), rig_.cameras.end(),
                  [](const auto& camera) { return camera.masks.empty(); }))
    return;
  labels_.forgetLamps([this](const auto& place) { return isMasked(rig_, place); });
}

void MessageTracker::reportDoubtfulLabels() {
  std::string labels;
  for (const std::string& label : labels_.doubtful())
    labels += format("%s%s (%.2f)", labels.empty() ? "" : ", ", label.c_str(),
                     labels_.places().at(label).confidence);
  if (!labels.empty() && parameters_.allLabels().size() > 1)
    sink_->onProblem(
        "labels may be wrong after LEDs were out of sight or met (probability of being right): " +
        labels +
        "; see which LED has which, and say it: rosservice call set_label LABEL RIGHT_LABEL; or "
        "let LEDs blink by codes");
}

}  // namespace wiimote_tracker
