#pragma once

#include "driver_parameters.h"
#include "remote_control.h"

#include <dynamic_reconfigure/server.h>
#include <wiimote_tracker_driver/DriverConfig.h>

#include <mutex>
#include <string>

namespace wiimote_tracker::driver {

/// Parameters that can be changed while images come (dynamic_reconfigure): sensitivity and LEDs. An
/// invalid sensitivity is refused with a warning, and the old one stays.
class LiveSettings {
 public:
  /// `parameters`: those of the private namespace, already checked and in use.
  /// `control` must outlive this.
  LiveSettings(const ros::NodeHandle& private_nh,
               const DriverParameters& parameters,
               RemoteControl& control);

  /// The sensitivity in use, as text. Thread-safe.
  std::string sensitivity() const;

 private:
  using Config = wiimote_tracker_driver::DriverConfig;

  void reconfigure(Config& config);

  const std::string camera_name_;
  RemoteControl& control_;
  mutable std::mutex mutex_;  // guards used_
  Config used_;
  dynamic_reconfigure::Server<Config> server_;
};

}  // namespace wiimote_tracker::driver
