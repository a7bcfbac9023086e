#include "triangulation.h"

#include "wiimote_tracker_triangulation/geometry/error.h"
#include "wiimote_tracker_triangulation/ros/conversions.h"

#include <geometry_msgs/PointStamped.h>
#include <wiimote_tracker_msgs/TrackedPointArray.h>
#include <boost/make_shared.hpp>

#include <cmath>

namespace wiimote_tracker {

Triangulation::Triangulation(const ros::NodeHandle& nh, const ros::NodeHandle& private_nh)
    : nh_(nh),
      parameters_(TriangulationParameters::read(private_nh)),
      markers_(parameters_.markers),
      diagnostics_(nh, private_nh) {
  context_.label = parameters_.label;
  context_.method = methodName(parameters_.fuser.triangulation.method);

  points_publisher_ = nh_.advertise<wiimote_tracker_msgs::TrackedPointArray>("points", 100);
  point_publisher_ = nh_.advertise<geometry_msgs::PointStamped>(parameters_.label + "/point", 100);
  markers_publisher_ = nh_.advertise<visualization_msgs::MarkerArray>("markers", 5);
  diagnostics_.setHardwareID("none");
  diagnostics_.add("triangulation", this, &Triangulation::report);
  rig_subscriber_ = nh_.subscribe("calibration/rig", 5, &Triangulation::onRig, this,
                                  ros::TransportHints().tcpNoDelay());
  timer_ = nh_.createWallTimer(ros::WallDuration(1.0), &Triangulation::onTimer, this);
}

void Triangulation::onRig(const wiimote_tracker_msgs::RigCalibrationConstPtr& message) {
  try {
    const geometry::Rig rig = fromMessage(*message);
    const std::string id = rig.id();
    if (id != computed_id_) {
      takeRig(rig, message->id.empty() ? id : message->id);
      computed_id_ = id;
    }
    takeCorrection(rig);
  } catch (const geometry::Error& e) {
    ROS_ERROR("The rig calibration on %s is refused%s: %s", rig_subscriber_.getTopic().c_str(),
              fuser_ ? ", the one before stays in use" : "", e.what());
  }
}

/// All at once, between two images: no point is ever made from old and new cameras.
void Triangulation::takeRig(const geometry::Rig& rig, const std::string& published_id) {
  auto fuser = std::make_unique<fusion::InstantFuser>(rig, parameters_.fuser);
  if (fuser_)
    fuser->continueFrom(newest_instant_, fuser_->lateFrames());
  fuser_ = std::move(fuser);
  resets_ = 0;
  rig_ = rig;
  context_.rig_id = published_id;
  markers_.setRig(rig_);
  strangers_.assign(rig_.cameras.size(), "");
  statistics_.clear(rig_.cameras.size());
  statistics_since_ = ros::WallTime::now();
  diagnostics_.setHardwareID("rig " + published_id);

  camera_index_.clear();
  std::map<std::string, ros::Subscriber> subscribers;
  for (std::size_t i = 0; i < rig_.cameras.size(); ++i) {
    const std::string& name = rig_.cameras[i].camera.name;
    camera_index_[name] = i;
    const auto old = blob_subscribers_.find(name);
    // Cameras that stay keep their connection, so that no image is lost.
    subscribers[name] = old != blob_subscribers_.end()
                            ? old->second
                            : nh_.subscribe<wiimote_tracker_msgs::IrBlobArray>(
                                  name + "/ir_blobs", 100,
                                  [this, name](const auto& blobs) { onBlobs(blobs, name); },
                                  ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay());
  }
  blob_subscribers_ = std::move(subscribers);
  ROS_INFO("Rig %s with %zu cameras is in use.", published_id.c_str(), rig_.cameras.size());
}

/// It may come later than the rig it belongs to.
void Triangulation::takeCorrection(const geometry::Rig& rig) {
  if (!correction_.take(rig))
    return;
  if (correction_.problem().empty())
    ROS_INFO("Correction of the volume: %s.", correction_.state().c_str());
  else
    ROS_WARN("Points are not corrected: %s.", correction_.problem().c_str());
}

void Triangulation::onBlobs(const wiimote_tracker_msgs::IrBlobArrayConstPtr& message,
                            const std::string& camera) {
  const auto index = camera_index_.find(camera);
  if (index == camera_index_.end() || !isUsable(*message, rig_.cameras[index->second]))
    return;
  checkIdentity(*message, index->second);
  image_.stamp = message->header.stamp.toSec();
  image_.arrival = (message->arrival.isZero() ? message->header.stamp : message->arrival).toSec();
  image_.clock_epoch = message->clock_epoch;
  image_.pixels.clear();
  for (const wiimote_tracker_msgs::IrBlob& blob : message->blobs)
    image_.pixels.emplace_back(blob.x, blob.y);

  fuser_->add(index->second, image_);
  if (fuser_->resets() != resets_) {
    resets_ = fuser_->resets();
    newest_instant_ = -std::numeric_limits<double>::infinity();
    first_seen_ = std::numeric_limits<double>::quiet_NaN();
    ROS_WARN_THROTTLE(10.0,
                      "Time jumped back by more than %.0f s, tracking starts anew; when no bag "
                      "started over, set the computers to the same clock.",
                      fusion::InstantFuser::kJump);
  }
  while (const fusion::Instant* instant = fuser_->next())
    publish(*instant);
}

bool Triangulation::isUsable(const wiimote_tracker_msgs::IrBlobArray& message,
                             const geometry::RigCamera& calibrated) const {
  const geometry::Camera& camera = calibrated.camera;
  if (message.header.stamp.isZero()) {
    ROS_ERROR_THROTTLE(10.0, "Images of %s carry no time and are ignored; repair their driver.",
                       camera.name.c_str());
    return false;
  }
  if (static_cast<int>(message.width) != camera.intrinsics.width ||
      static_cast<int>(message.height) != camera.intrinsics.height) {
    ROS_ERROR_THROTTLE(10.0,
                       "Images of %s have %u x %u pixels, but it was calibrated with %d x %d, and "
                       "are ignored; calibrate again.",
                       camera.name.c_str(), message.width, message.height, camera.intrinsics.width,
                       camera.intrinsics.height);
    return false;
  }
  return true;
}

void Triangulation::checkIdentity(const wiimote_tracker_msgs::IrBlobArray& message,
                                  std::size_t camera) {
  const geometry::Camera& calibrated = rig_.cameras[camera].camera;
  strangers_[camera].clear();
  if (message.identity.empty() || calibrated.identity.empty() ||
      message.identity == calibrated.identity)
    return;
  strangers_[camera] = message.identity;
  ROS_WARN_THROTTLE(
      30.0, "%s is now device %s, but was calibrated as %s; exchange them or calibrate again.",
      calibrated.name.c_str(), message.identity.c_str(), calibrated.identity.c_str());
}

void Triangulation::publish(const fusion::Instant& measured) {
  corrected_ = measured;
  const fusion::Instant& instant = corrected_;
  context_.remapped = corrected_.point && correction_.apply(&*corrected_.point);
  newest_instant_ = instant.time;
  if (instant.point && std::isnan(first_seen_))
    first_seen_ = instant.time;
  context_.first_seen = first_seen_;

  const auto message = boost::make_shared<wiimote_tracker_msgs::TrackedPointArray>(
      pointMessage(instant, rig_, fuser_->lateFrames(), context_));
  points_publisher_.publish(message);
  statistics_.add(instant, (ros::Time::now() - message->latest_arrival).toSec());

  if (instant.point) {
    geometry_msgs::PointStamped point;
    point.header = message->header;
    point.point = message->points[0].position;
    point_publisher_.publish(point);

    geometry_msgs::TransformStamped transform;
    transform.header = message->header;
    transform.child_frame_id = parameters_.label;
    transform.transform.translation.x = point.point.x;
    transform.transform.translation.y = point.point.y;
    transform.transform.translation.z = point.point.z;
    transform.transform.rotation.w = 1.0;
    transforms_.sendTransform(transform);
  }
  if (markers_publisher_.getNumSubscribers() > 0 && markers_.isDue(instant.time))
    markers_publisher_.publish(markers_.build(instant));
}

void Triangulation::onTimer(const ros::WallTimerEvent&) {
  if (!fuser_) {
    ROS_WARN_THROTTLE(10.0,
                      "Waiting for a rig on %s: start the calibration node and calibrate, or "
                      "load a saved rig.",
                      rig_subscriber_.getTopic().c_str());
  }
  diagnostics_.update();
}

void Triangulation::report(diagnostic_updater::DiagnosticStatusWrapper& status) {
  using diagnostic_msgs::DiagnosticStatus;
  if (!fuser_) {
    status.summary(DiagnosticStatus::WARN, "no rig: calibrate, or load a saved one");
    return;
  }
  const ros::WallTime now = ros::WallTime::now();
  const double rate =
      static_cast<double>(statistics_.instants()) / (now - statistics_since_).toSec();
  if (statistics_.instants() == 0)
    status.summary(DiagnosticStatus::WARN, "no images: start the cameras' drivers");
  else if (statistics_.points() == 0)
    status.summary(DiagnosticStatus::OK, "no LED in view of two cameras");
  else
    status.summary(DiagnosticStatus::OK, "tracking");
  for (std::size_t i = 0; i < strangers_.size(); ++i) {
    if (!strangers_[i].empty())
      status.mergeSummaryf(DiagnosticStatus::WARN,
                           "%s is device %s, but was calibrated as %s: calibrate again",
                           rig_.cameras[i].camera.name.c_str(), strangers_[i].c_str(),
                           rig_.cameras[i].camera.identity.c_str());
  }
  if (!correction_.problem().empty())
    status.mergeSummary(DiagnosticStatus::WARN, correction_.problem());
  status.add("rig", context_.rig_id);
  status.add("correction of the volume", correction_.state());
  status.addf("rate [Hz]", "%.1f", rate);
  status.addf("latency p50 [ms]", "%.3f", 1e3 * statistics_.latency(0.50));
  status.addf("latency p99 [ms]", "%.3f", 1e3 * statistics_.latency(0.99));
  status.addf("late images", "%llu", static_cast<unsigned long long>(fuser_->lateFrames()));
  for (std::size_t i = 0; i < rig_.cameras.size(); ++i) {
    status.addf(rig_.cameras[i].camera.name + " used [%]", "%.1f",
                100.0 * statistics_.shareUsed(i));
  }
  statistics_.clear(rig_.cameras.size());
  statistics_since_ = now;
}

}  // namespace wiimote_tracker
