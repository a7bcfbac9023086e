// Converts a folder in the layout of MultiCamSelfCal or flydra to a bag of this tracker.

#include "solution.h"
#include "wiimote_tracker_calibration/import/recording.h"

#include "wiimote_tracker_triangulation/ros/conversions.h"
#include "wiimote_tracker_triangulation/ros/message_fields.h"

#include <rosbag/bag.h>
#include <tf2_msgs/TFMessage.h>
#include <wiimote_tracker_msgs/IrBlobArray.h>
#include <wiimote_tracker_msgs/RigCalibration.h>
#include <wiimote_tracker_msgs/TrackedPointArray.h>
#include <wiimote_tracker_msgs/argument_parser.h>

#include <boost/make_shared.hpp>

#include <cstdio>
#include <filesystem>
#include <limits>
#include <string>

namespace wiimote_tracker::import {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// The layout has no times: frames at 100 Hz from an arbitrary time in the past.
const ros::Time kStart(1000000000, 0);
constexpr std::uint32_t kNanosecondsPerFrame = 10000000;

ros::Time stampOf(std::size_t frame) {
  ros::Duration since_start;
  since_start.fromNSec(static_cast<std::int64_t>(frame) * kNanosecondsPerFrame);
  return kStart + since_start;
}

template <typename Message>
void writeLatched(const std::string& topic, const Message& message, rosbag::Bag* bag) {
  const auto header = boost::make_shared<ros::M_string>();
  (*header)["topic"] = topic;
  (*header)["latching"] = "1";
  (*header)["type"] = ros::message_traits::datatype(message);
  (*header)["md5sum"] = ros::message_traits::md5sum(message);
  (*header)["message_definition"] = ros::message_traits::definition(message);
  (*header)["callerid"] = "/import_multicamselfcal";
  bag->write(topic, stampOf(0) - ros::Duration(0.1), message, header);
}

wiimote_tracker_msgs::RigCalibration rigMessage(geometry::Rig rig) {
  rig.solved_at = kStart.toSec();
  return toMessage(rig);
}

wiimote_tracker_msgs::IrBlobArray blobsOf(const geometry::Camera& camera,
                                          const std::optional<Eigen::Vector2d>& pixel,
                                          std::size_t frame) {
  wiimote_tracker_msgs::IrBlobArray blobs;
  blobs.header.stamp = stampOf(frame);
  blobs.header.frame_id = opticalFrame(camera.name);
  blobs.camera = camera.name;
  blobs.arrival = blobs.header.stamp;
  blobs.stamp_stddev = 0.0;  // the cameras are synchronised: equal frame number, equal time
  blobs.frame = frame;
  blobs.width = static_cast<std::uint32_t>(camera.intrinsics.width);
  blobs.height = static_cast<std::uint32_t>(camera.intrinsics.height);
  blobs.max_blobs = 0;  // not limited, although the layout holds one spot of each image
  blobs.ir_mode = wiimote_tracker_msgs::IrBlobArray::IR_MODE_UNKNOWN;
  if (pixel) {
    wiimote_tracker_msgs::IrBlob blob;
    blob.x = pixel->x();
    blob.y = pixel->y();
    blob.size = std::numeric_limits<float>::quiet_NaN();
    blob.intensity = std::numeric_limits<float>::quiet_NaN();
    blobs.blobs.push_back(blob);
  }
  return blobs;
}

wiimote_tracker_msgs::TrackedPointArray pointsOf(const std::optional<Eigen::Vector3d>& position,
                                                 const std::string& rig_id,
                                                 const std::string& world_frame,
                                                 std::size_t frame) {
  wiimote_tracker_msgs::TrackedPointArray points;
  points.header.stamp = stampOf(frame);
  points.header.frame_id = world_frame;
  points.rig_id = rig_id;
  points.method = "import";
  points.latest_arrival = points.header.stamp;
  if (position) {
    wiimote_tracker_msgs::TrackedPoint point;
    point.label = "led";
    point.label_confidence = std::numeric_limits<float>::quiet_NaN();
    point.state = wiimote_tracker_msgs::TrackedPoint::TRACKED;
    point.position = pointOf(*position);
    point.velocity.x = point.velocity.y = point.velocity.z = kNaN;
    point.position_covariance.fill(kNaN);
    point.velocity_covariance.fill(kNaN);
    point.residual = kNaN;
    point.last_observed = points.header.stamp;
    points.points.push_back(point);
  }
  return points;
}

/// Writes a solution as a bag like that of a live tracker (topics: README.md); a previous file
/// becomes .bak. Equal solutions give equal files. @throws ImportError: the bag cannot be written.
void writeBag(const Solution& solution, const std::string& path) {
  const bool has_previous = std::filesystem::exists(path);
  if (has_previous && !std::filesystem::is_regular_file(path))
    throw ImportError(path + " is not a file: name another one");
  const std::string part = path + ".part";
  try {
    rosbag::Bag bag(part, rosbag::bagmode::Write);
    writeLatched("/calibration/rig", rigMessage(solution.rig), &bag);
    tf2_msgs::TFMessage transforms;
    transforms.transforms = staticTransforms(solution.rig);
    for (auto& transform : transforms.transforms)
      transform.header.stamp = kStart;
    writeLatched("/tf_static", transforms, &bag);
    std::string reference_id;
    if (solution.reference) {
      writeLatched("/reference/rig", rigMessage(solution.reference->rig), &bag);
      reference_id = solution.reference->rig.id();
    }
    for (std::size_t frame = 0; frame < solution.frames.size(); ++frame) {
      const ros::Time stamp = stampOf(frame);
      for (std::size_t i = 0; i < solution.rig.cameras.size(); ++i) {
        const geometry::Camera& camera = solution.rig.cameras[i].camera;
        sensor_msgs::CameraInfo info = cameraInfo(camera);
        info.header.stamp = stamp;
        bag.write("/" + camera.name + "/camera_info", stamp, info);
        bag.write("/" + camera.name + "/ir_blobs", stamp,
                  blobsOf(camera, solution.frames[frame][i], frame));
      }
      if (solution.reference)
        bag.write("/reference/points", stamp,
                  pointsOf(solution.reference->points[frame], reference_id,
                           solution.reference->rig.world_frame, frame));
    }
    bag.close();
  } catch (const rosbag::BagException& error) {
    throw ImportError(path + " cannot be written: " + error.what());
  }
  std::error_code failed;
  if (has_previous)
    std::filesystem::rename(path, path + ".bak", failed);
  if (!failed)
    std::filesystem::rename(part, path, failed);
  if (failed)
    throw ImportError(part + " cannot get the name " + path + ": " + failed.message());
}

int convert(const std::string& folder, const std::string& bag) {
  const Recording recording = readRecording(folder);
  const Solution solution = solve(recording);
  writeBag(solution, bag);
  std::printf("%zu cameras, %zu frames: %s\n%s\n%s\n", recording.cameras.size(),
              recording.frames.size(), bag.c_str(), solution.rig.method.c_str(),
              solution.rig.verdict.c_str());
  if (!recording.cameras.front().center)
    std::printf("no camera centres shipped: the scale of this world is arbitrary\n");
  return 0;
}

}  // namespace
}  // namespace wiimote_tracker::import

int main(int argc, char** argv) {
  std::string folder, bag;
  wiimote_tracker::ArgumentParser parser(
      "import_multicamselfcal",
      "Converts a folder in the layout of MultiCamSelfCal or flydra to a bag of this tracker.");
  parser.positional("FOLDER", &folder);
  parser.positional("OUT.bag", &bag);
  return parser.run(argc, argv, [&] { return wiimote_tracker::import::convert(folder, bag); });
}
