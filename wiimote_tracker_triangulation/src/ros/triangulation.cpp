#include "triangulation.h"

#include "callbacks.h"
#include "identity/label_places_file.h"
#include "wiimote_tracker_triangulation/geometry/error.h"

#include <visualization_msgs/MarkerArray.h>
#include <wiimote_tracker_msgs/CalibrationStatus.h>
#include <wiimote_tracker_msgs/text.h>

#include <chrono>
#include <future>
#include <string>
#include <utility>
#include <vector>

namespace wiimote_tracker {

using wiimote_tracker_msgs::CalibrationStatus;
using wiimote_tracker_msgs::IrBlobArray;
using wiimote_tracker_msgs::RigCalibration;
using wiimote_tracker_msgs::SetLabel;
using wiimote_tracker_msgs::TrackedPointArray;
using wiimote_tracker_msgs::TrackedPointArrayConstPtr;

namespace {

// Images of one camera that may wait: ten seconds of a Wii Remote. The same for samples of an IMU.
constexpr std::uint32_t kImageQueue = 1000;

// After a longer time nobody expects the same labels.
constexpr std::chrono::minutes kLongestRestart{10};

// Somebody may load a rig or begin a calibration meanwhile [s].
constexpr int kUntilAdvice = 10;

/// What a command in a terminal begins with, so that it runs in a namespace.
std::string shellPrefix(std::string name_space) {
  name_space.erase(0, name_space.find_first_not_of('/'));  // all of it: the root
  return name_space.empty() ? "" : "ROS_NAMESPACE=" + name_space + " ";
}

}  // namespace

Triangulation::Triangulation(const ros::NodeHandle& nh, const ros::NodeHandle& private_nh)
    : nh_(nh),
      parameters_(TrackingParameters::read(ParameterReader(private_nh))),
      tracker_(parameters_, this),
      markers_(parameters_.markers),
      single_publishers_(nh, parameters_.allLabels(), parameters_.output),
      body_markers_(parameters_.markers.rate),
      body_diagnostics_(nh, private_nh),
      learning_(nh,
                parameters_.bodies.file,
                parameters_.bodies.known,
                parameters_.allLabels(),
                parameters_.blinkingLabels()),
      diagnostics_(nh, private_nh, &tracker_, &shedding_, parameters_.clock_tolerance) {
  parameters_.label_places = identity::placesFile(parameters_.label_places, nh_.getNamespace());
  if (parameters_.identity.codes)
    ROS_INFO("%s.", describeIdentity(parameters_).c_str());
  const std::string missing_bodies = describeMissingFile(parameters_.bodies.file);
  if (!missing_bodies.empty())
    ROS_INFO("%s.", missing_bodies.c_str());
  useBodies(parameters_.bodies.known);
  points_publisher_ = nh_.advertise<TrackedPointArray>("points", 100);
  bodies_publisher_ = nh_.advertise<wiimote_tracker_msgs::TrackedBodyArray>("bodies", 100);
  markers_publisher_ = nh_.advertise<visualization_msgs::MarkerArray>("markers", 5);
  zone_publisher_ = nh_.advertise<wiimote_tracker_msgs::ZoneEvent>("zone_events", 100);
  triggered_publisher_ = nh_.advertise<TrackedPointArray>("triggered_points", 100);
  set_label_ = nh_.advertiseService("set_label", &Triangulation::setLabel, this);
  status_subscription_ =
      subscribe<CalibrationStatus>(nh_, "calibration/status", 1, [this](auto& event) {
        is_calibrating_ = event.getConstMessage()->step != CalibrationStatus::IDLE;
      });
  rig_subscription_.start(nh_, [this](const RigCalibration& message) { takeRig(message); });
  trigger_subscriber_ = subscribe<std_msgs::Header>(nh_, "trigger", 100, [this](const auto& event) {
    tracker_.takeTrigger(*event.getConstMessage());
  });
  timer_ = nh_.createWallTimer(ros::WallDuration(1.0), [this](const ros::WallTimerEvent&) {
    logExceptions("timer", [this] { onTimer(); });
  });
}

void Triangulation::takeRig(const RigCalibration& message) {
  const bool had_rig = tracker_.hasRig();
  MessageTracker::RigChange change;
  try {
    change = tracker_.takeRig(message);
  } catch (const geometry::Error& e) {
    ROS_ERROR("The rig calibration on %s is refused%s: %s", rig_subscription_.topic().c_str(),
              had_rig ? ", the one before stays in use" : "", e.what());
    return;
  }
  if (change.points) {
    markers_.setRig(tracker_.rig());
    body_markers_.setRig(tracker_.rig());
    learning_.setRig(tracker_.rig());
    diagnostics_.setRig();
    subscribeToCameras();
    status_subscription_.shutdown();
    ROS_INFO("Rig %s with %s is in use.", tracker_.rigId().c_str(),
             counted(tracker_.rig().cameras.size(), "camera").c_str());
  }
  const VolumeCorrection& correction = tracker_.correction();
  if (change.correction && correction.problem().empty())
    ROS_INFO("Correction of the volume: %s.", correction.state().c_str());
  else if (change.correction)
    ROS_WARN("Points are not corrected: %s.", correction.problem().c_str());
}

/// A camera that stays keeps its subscription, so that none of its images is lost.
void Triangulation::subscribeToCameras() {
  std::map<std::string, ros::Subscriber> subscribers;
  for (const geometry::RigCamera& rig_camera : tracker_.rig().cameras) {
    const std::string& camera = rig_camera.camera.name;
    ros::Subscriber& subscriber = subscribers[camera] = image_subscribers_[camera];
    if (!subscriber)
      subscriber =
          subscribe<IrBlobArray>(nh_, camera + "/ir_blobs", kImageQueue,
                                 [this, camera](const auto& event) { onImage(camera, event); });
  }
  image_subscribers_ = std::move(subscribers);
}

void Triangulation::onImage(const std::string& camera,
                            const ros::MessageEvent<const IrBlobArray>& event) {
  if (const auto bodies = learning_.change())
    useBodies(*bodies);
  if (!std::exchange(former_places_read_, true))  // now, since their ages count from here
    tracker_.labels().setFormerPlaces(
        identity::readPlaces(parameters_.label_places, tracker_.rigId(), kLongestRestart));
  const IrBlobArray& image = *event.getConstMessage();
  const ros::Time receipt = event.getReceiptTime();
  diagnostics_.addArrival(camera, image.arrival, receipt, event.getPublisherName());
  if (isShed(receipt))
    return;
  tracker_.takeImage(camera, image);
}

/// Whether to drop an image because it waited too long. Simulated time is too coarse to tell.
bool Triangulation::isShed(const ros::Time& receipt) {
  if (ros::Time::isSimTime())
    return false;
  if (!shedding_.drops((ros::Time::now() - receipt).toSec(), ros::SteadyTime::now().toSec()))
    return false;
  ROS_WARN_THROTTLE(10.0, "%s.", LoadShedding::kAdvice);
  return true;
}

void Triangulation::useBodies(const std::vector<body::Constellation>& bodies) {
  tracker_.setBodies(bodies);
  subscribeToImus(bodies);
  single_publishers_.setBodies(bodies);
  body_diagnostics_.setBodies(bodies);
  std::vector<std::string> warnings = shapeWarnings(bodies);
  for (std::string& warning : labelWarnings(bodies, parameters_.blinkingLabels()))
    warnings.push_back(std::move(warning));
  for (const std::string& sentence : warnings) {
    // Learning a body sets all others again.
    if (warned_of_.insert(sentence).second)
      ROS_WARN("%s.", sentence.c_str());
  }
  if (!bodies.empty())
    ROS_INFO("Rigid bodies to track: %zu.", bodies.size());
}

/// An IMU whose body and topic stay keeps its subscription, too.
void Triangulation::subscribeToImus(const std::vector<body::Constellation>& bodies) {
  std::map<std::string, ros::Subscriber> subscribers;
  for (const body::Constellation& body : bodies) {
    if (!body.imu)
      continue;
    ros::Subscriber& subscriber = subscribers[body.name] = imu_subscribers_[body.name];
    if (subscriber.getTopic() != nh_.resolveName(body.imu->topic))
      subscriber = subscribe<sensor_msgs::Imu>(
          nh_, body.imu->topic, kImageQueue, [this, name = body.name](const auto& event) {
            tracker_.takeInertial(name, *event.getConstMessage());
          });
  }
  imu_subscribers_ = std::move(subscribers);
}

bool Triangulation::setLabel(SetLabel::Request& request, SetLabel::Response& response) {
  const std::string& label = request.label;
  const std::string& right = request.right_label;
  response.message = tracker_.labels().correct(label, right);
  response.success = response.message.empty();
  if (response.success)
    response.message = label == right ? "'" + right + "' is right from now on"
                                      : "the LED that was '" + label + "' is '" + right +
                                            "' now, and one that was '" + right + "' is not";
  return true;
}

void Triangulation::onPoints(const TrackedPointArrayConstPtr& points,
                             const std::vector<tracking::CameraView>& views) {
  single_publishers_.publish(*points);
  points_publisher_.publish(points);
  tracker_.statistics().addLatency(ros::Time::now().toSec() - points->latest_arrival.toSec());
  learning_.addPoints(*points);
  if (markers_publisher_.getNumSubscribers() > 0 && markers_.isDue(points->header.stamp.toSec()))
    markers_publisher_.publish(markers_.build(*points, views));
}

void Triangulation::onBodies(const wiimote_tracker_msgs::TrackedBodyArray& bodies,
                             const std::vector<bool>& bridged) {
  bodies_publisher_.publish(bodies);
  single_publishers_.publish(bodies, bridged);
  body_diagnostics_.addBodies(bodies);
  if (markers_publisher_.getNumSubscribers() > 0 &&
      body_markers_.isDue(bodies.header.stamp.toSec()))
    markers_publisher_.publish(body_markers_.build(bodies));
}

void Triangulation::onTimer() {
  if (!tracker_.hasRig()) {
    const bool is_calibrating = is_calibrating_ && status_subscription_.getNumPublishers() > 0;
    if (++seconds_without_rig_ > kUntilAdvice && !is_calibrating)
      ROS_WARN_THROTTLE(600.0,
                        "Waiting for a calibrated rig on %s: run  %srosrun "
                        "wiimote_tracker_calibration calibrate  or open Calibrate in rviz.",
                        rig_subscription_.topic().c_str(), shellPrefix(nh_.getNamespace()).c_str());
    markers_publisher_.publish(markers_.buildWithoutRig(ros::Time::now().toSec()));
  }
  for (const auto& [camera, images] : image_subscribers_) {
    if (images.getNumPublishers() > 1)
      ROS_WARN_THROTTLE(10.0,
                        "%s has %u publishers, as where a bag is replayed beside a running "
                        "tracker, and their images are mixed: end all but one.",
                        images.getTopic().c_str(), images.getNumPublishers());
  }
  if (const auto bodies = learning_.change())  // while no image comes
    useBodies(*bodies);
  keepPlaces();
  diagnostics_.update();
  body_diagnostics_.update();
}

/// In another thread: a busy disk, as while a bag is recorded, would keep images waiting.
void Triangulation::keepPlaces() {
  const std::string& file = parameters_.label_places;
  if (writing_places_.valid()) {
    if (writing_places_.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
      return;
    if (const std::error_code error = writing_places_.get())
      ROS_WARN_ONCE(
          "Cannot write %s (%s), so LEDs may change their labels if this node is killed: mend "
          "that, or name another file in label_places.",
          file.c_str(), error.message().c_str());
  }
  const identity::LedLabels::Places* places = tracker_.labels().placesToKeep();
  if (!file.empty() && places)
    writing_places_ =
        std::async(std::launch::async, [file, rig = tracker_.rigId(), copy = *places] {
          return identity::writePlaces(file, rig, copy);
        });
}

}  // namespace wiimote_tracker
