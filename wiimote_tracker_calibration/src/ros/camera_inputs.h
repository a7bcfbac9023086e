#pragma once

#include "capture/camera_monitor.h"
#include "capture/image.h"
#include "capture/image_order.h"
#include "capture/masks.h"
#include "capture/rest_gravity.h"

#include "requests.h"

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>
#include <sensor_msgs/Imu.h>
#include <tf2/buffer_core.h>
#include <tf2_msgs/TFMessage.h>
#include <wiimote_tracker_msgs/IrBlobArray.h>
#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <Eigen/Core>

#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace wiimote_tracker {

/// What a camera saw, without spots that its image cannot have.
capture::Image imageOf(const wiimote_tracker_msgs::IrBlobArray& message);

/// What a camera's accelerometer reads, in its optical frame [m/s^2]. Nothing if it has none, or
/// while the transform between the frames is unknown.
std::optional<Eigen::Vector3d> specificForceOf(const sensor_msgs::Imu& message,
                                               const std::string& optical_frame,
                                               const tf2::BufferCore& transforms);

/// The last known properties of one camera, and its latest images.
struct CameraInput {
  std::string identity;
  int width = -1;     ///< Image size [px]; -1 until an image came.
  int height = -1;    ///< [px]
  int max_blobs = 0;  ///< Most spots in one image; 0: not known.
  std::string optical_frame;
  capture::CameraMonitor monitor;  ///< Its times are stamps.
  capture::RestGravity gravity;    ///< Since restartGravity().
};

/// Subscribes to the images and the accelerometers of all cameras, named or discovered.
class CameraInputs {
 public:
  using OnImage = std::function<void(const capture::Image& image, const Lock& lock)>;
  /// @param specific_force in the camera's optical frame [m/s^2].
  using OnGravity = std::function<void(const std::string& camera,
                                       double stamp,
                                       const Eigen::Vector3d& specific_force,
                                       const Lock& lock)>;

  /// @param names cameras to watch; empty: those that camerasBelow() finds.
  /// @param ignored a device whose images are not used; empty: none.
  /// @param mutex guards everything this class hands out; @param changed notified at each image.
  CameraInputs(const ros::NodeHandle& nh,
               const std::vector<std::string>& names,
               const std::string& ignored,
               std::mutex* mutex,
               std::condition_variable* changed);

  /// Calls back for every image of every camera, in the order of their stamps
  /// (capture::ImageOrder), with the mutex locked, from one thread. Before start() only.
  void subscribeImages(OnImage on_image) { on_image_.push_back(std::move(on_image)); }

  /// Same for every reading of an accelerometer, in the order in which they come.
  void subscribeGravity(OnGravity on_gravity) { on_gravity_.push_back(std::move(on_gravity)); }

  /// Both for as long as what it returns lives. One at a time; lock the mutex.
  [[nodiscard]] auto watch(
      OnImage on_image,
      OnGravity on_gravity = [](auto&&...) {}) {
    subscribeImages(std::move(on_image));
    subscribeGravity(std::move(on_gravity));
    return AtEnd{[this] {
      on_image_.pop_back();
      on_gravity_.pop_back();
    }};
  }

  /// Starts the callbacks. stop() returns when none runs any more.
  void start();
  void stop();

  /// Looks for cameras that have appeared, and leaves those whose own tracker was started later
  /// than their driver to it. Locks the mutex.
  void discover();

  /// Lock the mutex while you use it.
  const std::map<std::string, CameraInput>& cameras() const { return cameras_; }

  std::vector<std::string> names() const;

  /// Why images of some of these cameras would not be used, and what to do; empty: all would.
  std::string whyIgnored(const std::vector<std::string>& cameras) const;

  /// Which cameras of a rig have sent no image since the start, and what to do; empty: none.
  std::string describeSilent(const geometry::Rig& rig) const;

  /// Light in these regions is ignored from the next image on. Lock the mutex.
  void setMasks(const capture::Masks& masks) { masks_ = masks; }
  /// Same for one camera.
  void setMasks(const std::string& camera, const std::vector<geometry::ImageMask>& masks) {
    masks_[camera] = masks;
  }
  const capture::Masks& masks() const { return masks_; }

  /// Forgets all accelerometer readings. Lock the mutex.
  void restartGravity();

 private:
  void watch(const std::string& name);
  void forget(const std::string& name);
  void onBlobs(const std::string& name, const wiimote_tracker_msgs::IrBlobArray& message);
  void onImu(const std::string& name, const sensor_msgs::Imu& message);

  ros::NodeHandle nh_;
  bool discovers_;
  std::string ignored_;
  std::mutex* mutex_;
  std::condition_variable* changed_;
  std::vector<OnImage> on_image_;
  std::vector<OnGravity> on_gravity_;
  tf2::BufferCore transforms_;  // static ones only
  std::map<std::string, CameraInput> cameras_;
  capture::Masks masks_;
  capture::ImageOrder order_;
  // Their own queue and thread: services that wait for images must not block them.
  ros::CallbackQueue queue_;
  ros::AsyncSpinner spinner_;
  std::mutex subscribers_mutex_;
  std::map<std::string, std::vector<ros::Subscriber>> subscribers_;  // by the camera
  ros::Subscriber transforms_subscriber_;
  ros::WallTimer timer_;
};

}  // namespace wiimote_tracker
