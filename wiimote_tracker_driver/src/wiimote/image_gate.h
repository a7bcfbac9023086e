#pragma once

#include "wiimote_tracker_driver/protocol/input_reports.h"

#include <limits>
#include <utility>

namespace wiimote_tracker::wiimote {

/// Withholds images while they may be of a camera that another program has changed.
class ImageGate {
 public:
  void close() { open_ = false; }
  bool open() const { return open_; }

  /// @returns whether no camera in this format sends such an image, so that the camera must be
  /// checked.
  bool noteSuspicion(const protocol::DataReport& image, double now) {
    if (image.plausible || !open_ || now < accepted_until_)
      return false;
    implausible_ = true;
    return true;
  }

  /// The camera is as configured, or cannot be read. `open`: no other check is due.
  void checked(bool readable, bool open, double now) {
    open_ = open;
    if (std::exchange(implausible_, false))
      accepted_until_ = now + (readable ? kAccepted : kForever);
  }

 private:
  // Implausible images pass for this long after a check that they caused [s]: some remote may
  // always send such images.
  static constexpr double kAccepted = 10.0;
  static constexpr double kForever = std::numeric_limits<double>::infinity();

  bool open_ = true;
  bool implausible_ = false;           ///< The check is due to an implausible image.
  double accepted_until_ = -kForever;  ///< [s]
};

}  // namespace wiimote_tracker::wiimote
