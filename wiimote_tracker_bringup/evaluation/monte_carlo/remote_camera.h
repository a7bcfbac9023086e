#pragma once

#include "wiimote_tracker_driver/protocol/ir_camera.h"
#include "wiimote_tracker_driver/virtual_wiimote/device.h"
#include "wiimote_tracker_triangulation/tracking/camera_image.h"

#include <memory>
#include <string>
#include <vector>

namespace wiimote_tracker::monte_carlo {

/// The camera of a virtual Wii Remote, configured and read by its protocol: spots for the light on
/// its sensor, with the limit of four and whole pixels.
class RemoteCamera {
 public:
  /// @param sensitivity a name (see protocol::irSensitivity). @throws std::invalid_argument:
  /// unknown.
  explicit RemoteCamera(const std::string& sensitivity);

  /// Takes one image. Spots with v down [px], in the order of their slots. Valid until the next
  /// call.
  const std::vector<tracking::Spot>& look(const virtual_wiimote::Senses& senses);

 private:
  std::unique_ptr<virtual_wiimote::Device> device_;
  std::vector<tracking::Spot> spots_;
};

}  // namespace wiimote_tracker::monte_carlo
