#include "image_message.h"

#include <wiimote_tracker_msgs/text.h>

#include <cmath>
#include <limits>

namespace wiimote_tracker {
namespace {

using wiimote_tracker_msgs::IrBlob;
using wiimote_tracker_msgs::IrBlobArray;

// Longest possible time from exposure to arrival, and error of a stamp [s].
constexpr double kLongestDelay = 10.0;
constexpr double kStampError = 0.02;

std::string sizeOf(std::int64_t width, std::int64_t height) {
  return std::to_string(width) + " x " + std::to_string(height) + " pixels";
}

std::optional<ImageFault> faultOf(const IrBlobArray& message, const geometry::Camera& calibrated) {
  using Kind = ImageFault::Kind;
  const std::string& name = calibrated.name;
  const geometry::Intrinsics& lens = calibrated.intrinsics;
  // From exposure to arrival [s]. (ros::Duration throws beyond 68 years.)
  const double delay =
      message.arrival.isZero() ? 0.0 : message.arrival.toSec() - message.header.stamp.toSec();
  if (message.header.stamp.isZero())
    return {
        {Kind::kNoTime,
         "images of " + name +
             " carry no time and are ignored: repair their driver, or, when no bag is played, run "
             " rosparam set /use_sim_time false  and start all nodes again"}};
  if (delay > kLongestDelay)
    return {
        {Kind::kImpossibleTime,
         format("images of %s are stamped more than %.0f s before their arrival and are ignored: "
                "let their driver take both from one clock",
                name.c_str(), kLongestDelay)}};
  if (delay < -kStampError)
    return {{Kind::kAfterArrival,
             format("images of %s are stamped %.3g s after their arrival and are ignored: "
                    "let their driver take both from one clock",
                    name.c_str(), -delay)}};
  if (!message.camera.empty() && message.camera != name)
    return {{Kind::kOtherCamera,
             "images on the topic of " + name + " are from " + message.camera +
                 " and are ignored: let each driver publish under its own camera's name"}};
  if (calibrated.isOtherDevice(message.identity))
    return {{Kind::kOtherDevice,
             name + " is device " + message.identity + ", but was calibrated as " +
                 calibrated.identity +
                 ", and is ignored: exchange them, or do what calibrate says of it"}};
  if (static_cast<std::int64_t>(message.width) != lens.width ||
      static_cast<std::int64_t>(message.height) != lens.height)
    return {
        {Kind::kOtherSize, "images of " + name + " have " + sizeOf(message.width, message.height) +
                               ", but it was calibrated with " + sizeOf(lens.width, lens.height) +
                               ", and are ignored: calibrate again"}};
  return std::nullopt;
}

}  // namespace

std::optional<ImageFault> readImage(const IrBlobArray& message,
                                    const geometry::Camera& calibrated,
                                    tracking::CameraImage* image) {
  if (const auto fault = faultOf(message, calibrated))
    return fault;
  image->stamp = message.header.stamp.toSec();
  image->arrival = (message.arrival.isZero() ? message.header.stamp : message.arrival).toSec();
  const bool has_stddev = std::isfinite(message.stamp_stddev) && message.stamp_stddev >= 0.0;
  image->stamp_stddev =
      has_stddev ? message.stamp_stddev : std::numeric_limits<double>::quiet_NaN();
  image->clock_epoch = message.clock_epoch;
  image->maximum_spots =
      message.max_blobs > 0 ? message.max_blobs : std::numeric_limits<std::size_t>::max();
  image->spots.clear();
  const geometry::Intrinsics& lens = calibrated.intrinsics;
  for (const IrBlob& blob : message.blobs) {
    if (lens.isInImage({blob.x, blob.y}, 0.5))  // false for NaN
      image->spots.push_back({{blob.x, blob.y}, blob.slot});
  }
  if (image->spots.size() < message.blobs.size())
    return {{ImageFault::Kind::kImpossibleSpots,
             calibrated.name + " reports spots outside its image of " +
                 sizeOf(lens.width, lens.height) + ", which are ignored: repair its driver"}};
  return std::nullopt;
}

std::string describe(const tracking::CameraFault& fault, const std::string& camera) {
  const double seconds = std::fabs(fault.clock_ahead);
  const char* name = camera.c_str();
  switch (fault.kind) {
    case tracking::CameraFault::Kind::kMisfit:
      return format(
          "the spots of %s are not where other cameras see LEDs, and its images are "
          "ignored: if it was moved or exchanged, move an LED in its view and do what calibrate "
          "then says (in a recording: run keep_calibrated); mask lamps and reflections",
          name);
    case tracking::CameraFault::Kind::kInaccurate:
      return format(
          "the calibration of %s is too inaccurate where the LEDs are now, and its images are "
          "ignored: calibrate again, and wave the LED there, too",
          name);
    case tracking::CameraFault::Kind::kCorrectedClock:
      return format(
          "the times of the images of %s are %.3g s too %s, by the motion of the LEDs, and "
          "are corrected: run chrony on all computers or, where one runs all drivers, calibrate "
          "with a waved LED",
          name, seconds, fault.clock_ahead > 0.0 ? "late" : "early");
    case tracking::CameraFault::Kind::kLate:
      return format(
          "the images of %s are stamped %.3g s before images of other cameras that come with "
          "them, and are ignored: mend its network, correct ~latency of its driver, or raise "
          "tracks/history",
          name, seconds);
    case tracking::CameraFault::Kind::kWrongClock:
      break;
  }
  if (std::isnan(seconds))
    return format(
        "the clocks of the cameras' computers disagree and no group of them is the "
        "largest, so images of %s are ignored: run chrony on all computers",
        name);
  return format(
      "the clock of the computer of %s is %.3g s %s most cameras' clocks, and its images "
      "are ignored: run chrony on all computers",
      name, seconds, fault.clock_ahead > 0.0 ? "ahead of" : "(or its network) behind");
}

}  // namespace wiimote_tracker
