#pragma once

#include "wiimote_tracker_triangulation/geometry/camera.h"
#include "wiimote_tracker_triangulation/tracking/camera_image.h"
#include "wiimote_tracker_triangulation/tracking/estimator.h"

#include <wiimote_tracker_msgs/IrBlobArray.h>

#include <optional>
#include <string>

namespace wiimote_tracker {

/// What is wrong with an image.
struct ImageFault {
  enum class Kind {
    kImpossibleSpots,  ///< Spots that are not finite or lie outside the image; the others are good.
    kNoTime,           ///< From here on the image must not be used.
    kImpossibleTime,   ///< Exposed long before it arrived.
    kAfterArrival,     ///< Exposed after it arrived.
    kOtherCamera,
    kOtherDevice,
    kOtherSize,
  };
  Kind kind;
  std::string sentence;  ///< Says what to do.

  bool leavesImageUsable() const { return kind == Kind::kImpossibleSpots; }
};

/// Converts a camera's image for the core, without impossible spots.
/// @param calibrated the camera as the rig knows it.
/// @returns nothing for a good image.
std::optional<ImageFault> readImage(const wiimote_tracker_msgs::IrBlobArray& message,
                                    const geometry::Camera& calibrated,
                                    tracking::CameraImage* image);

/// Describes a fault of a camera in one sentence that says what to do.
std::string describe(const tracking::CameraFault& fault, const std::string& camera);

}  // namespace wiimote_tracker
