#pragma once

#include "battery_publisher.h"
#include "blob_publisher.h"
#include "camera_info_publisher.h"
#include "driver_parameters.h"
#include "image_stamper.h"
#include "imu_publisher.h"
#include "joy.h"
#include "link_diagnostics.h"
#include "link_log.h"
#include "live_settings.h"
#include "recording/recorder.h"
#include "remote_control.h"
#include "remote_source.h"
#include "wiimote/stream_statistics.h"
#include "wiimote/wiimote.h"

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

namespace wiimote_tracker::driver {

/// Publishes one Wii Remote as an infrared blob camera with an accelerometer. Waits for a remote
/// that is not connected. Reads and publishes in its own thread.
class Driver {
 public:
  /// Starts at once. `nh`: the camera's namespace.
  /// @throws ParameterError for a configuration that can never work.
  Driver(ros::NodeHandle nh, const ros::NodeHandle& private_nh);

  /// Switches the remote's reporting, camera and LEDs off.
  ~Driver();
  Driver(const Driver&) = delete;
  Driver& operator=(const Driver&) = delete;

 private:
  void run();
  void readAndPublish();
  void raisePriority();
  bool waitForTurn();
  std::unique_ptr<transport::Transport> open(bool delivered);
  void publishImage(const protocol::DataReport& image);
  void linkChanged();
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);

  const DriverParameters parameters_;
  const std::string optical_frame_;

  RemoteSource source_;
  const wiimote::Options options_;                       // a replay has its own image format
  const std::shared_ptr<recording::Recorder> recorder_;  // null: not recorded
  RemoteControl control_;

  // Used by the reader thread alone, but for camera_info_.problem(), which diagnostics call.
  wiimote::Wiimote wiimote_;
  CameraInfoPublisher camera_info_;
  BlobPublisher blobs_;
  ImuPublisher imu_;
  BatteryPublisher battery_;
  JoyPublisher joy_;
  LinkLog log_;
  ImageStamper stamper_;
  std::uint64_t seen_changes_ = 0;  // of wiimote_.linkChanges()

  std::mutex mutex_;   // guards the two below; held only to copy, as the reader may be real-time
  DriverState state_;  // the reader's part of it
  wiimote::StreamStatistics statistics_;

  // For callbacks.
  LiveSettings settings_;
  JoyFeedback feedback_;
  LinkDiagnostics diagnostics_;
  diagnostic_updater::Updater updater_;
  ros::SteadyTimer diagnostics_timer_;
  std::string shared_with_;
  std::string recording_error_;  // logged already
  double users_due_;             // [s]

  std::atomic<bool> stop_{false};
  std::thread reader_;
};

}  // namespace wiimote_tracker::driver
