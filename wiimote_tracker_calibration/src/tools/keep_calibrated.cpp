// keep_calibrated: continuous calibration over a recording, without the node.

#include "capture/image_order.h"
#include "capture/masks.h"
#include "continuous/continuous_calibration.h"
#include "continuous/rig_changes.h"
#include "health/led_selection.h"
#include "ros/camera_inputs.h"

#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/Imu.h>
#include <tf2/buffer_core.h>
#include <tf2_msgs/TFMessage.h>
#include <wiimote_tracker_msgs/IrBlobArray.h>
#include <wiimote_tracker_msgs/RigCalibration.h>
#include <wiimote_tracker_msgs/argument_parser.h>
#include <wiimote_tracker_msgs/text.h>
#include <wiimote_tracker_triangulation/geometry/error.h>
#include <wiimote_tracker_triangulation/geometry/rig_file.h>
#include <wiimote_tracker_triangulation/ros/conversions.h>

#include <Eigen/Core>

#include <cstddef>
#include <cstdio>
#include <map>
#include <optional>
#include <string>
#include <utility>

namespace {

using namespace wiimote_tracker;

// A camera is judged by two others.
constexpr std::size_t kFewestCameras = 3;

/// The rig in use, and what corrects it. Every proposal is applied, as by the policy `all`.
class KeptRig {
 public:
  void use(const geometry::Rig& rig) {
    rig_ = rig;
    masks_ = capture::masksOf(rig);
    selection_.emplace(rig);
    continuous_.emplace(rig, continuous::Options{});
  }

  void add(capture::Image image) {
    if (!continuous_ || !rig_->find(image.camera))
      return;
    ++images_;
    capture::applyMasks(masks_, &image);
    if (const auto proposal = continuous_->add(selection_->select(image))) {
      std::printf("%.3f: %s\n", image.stamp, proposal->message.c_str());
      use(continuous::appliedRig(proposal->rig, *rig_));
      ++changes_;
    }
    if (continuous_->contradiction() == contradiction_)
      return;
    contradiction_ = continuous_->contradiction();
    if (!contradiction_.empty())
      std::printf("%.3f: %s\n", image.stamp, contradiction_.c_str());
  }

  void addAcceleration(const std::string& camera, const Eigen::Vector3d& specific_force) {
    if (continuous_)
      continuous_->addAcceleration(camera, specific_force);
  }

  const std::optional<geometry::Rig>& rig() const { return rig_; }
  std::size_t images() const { return images_; }    ///< Of its cameras.
  std::size_t changes() const { return changes_; }  ///< That were applied.

 private:
  std::optional<geometry::Rig> rig_;
  capture::Masks masks_;  // of the rig
  std::optional<health::LedSelection> selection_;
  std::optional<continuous::ContinuousCalibration> continuous_;
  std::string contradiction_;  // That was printed.
  std::size_t images_ = 0;
  std::size_t changes_ = 0;
};

/// Passes on what the cameras recorded as the node does: images in the order of their stamps, and
/// accelerations in the optical frames.
class Playback {
 public:
  explicit Playback(KeptRig* kept)
      : take_([kept](const capture::Image& image) { kept->add(image); }), kept_(*kept) {}

  void play(const rosbag::MessageInstance& message) {
    const std::string& topic = message.getTopic();
    const std::string folder = topic.substr(0, topic.find_last_of('/'));
    if (const auto image = message.instantiate<wiimote_tracker_msgs::IrBlobArray>()) {
      cameras_[folder] = {image->camera, image->header.frame_id};
      order_.add(imageOf(*image), take_);
    } else if (const auto imu = message.instantiate<sensor_msgs::Imu>()) {
      const auto camera = cameras_.find(folder.substr(0, folder.find_last_of('/')));
      if (camera == cameras_.end())
        return;
      const auto& [name, optical_frame] = camera->second;
      if (const auto specific_force = specificForceOf(*imu, optical_frame, transforms_))
        kept_.addAcceleration(name, *specific_force);
    } else if (topic == "/tf_static") {
      if (const auto tree = message.instantiate<tf2_msgs::TFMessage>()) {
        for (const geometry_msgs::TransformStamped& transform : tree->transforms)
          transforms_.setTransform(transform, "the bag", true);
      }
    }
  }

  void end() { order_.flush(take_); }

 private:
  /// A camera's name and its optical frame.
  using CameraFrame = std::pair<std::string, std::string>;

  capture::ImageOrder::Take take_;
  KeptRig& kept_;
  capture::ImageOrder order_;
  std::map<std::string, CameraFrame> cameras_;  // By namespace, with the leading slash.
  tf2::BufferCore transforms_;
};

/// @param rig empty: that of the bag.
void keep(const std::string& path, const std::string& rig, const std::string& target) {
  KeptRig kept;
  if (!rig.empty())
    kept.use(geometry::readRigFile(rig));
  Playback playback(&kept);
  try {
    rosbag::Bag bag(path);
    rosbag::View view(bag);
    for (const rosbag::MessageInstance& message : view) {
      const auto recorded = message.instantiate<wiimote_tracker_msgs::RigCalibration>();
      if (recorded && message.getTopic() == "/calibration/rig" && !kept.rig())
        kept.use(fromMessage(*recorded));
      playback.play(message);
    }
    playback.end();
  } catch (const rosbag::BagException& error) {
    throw geometry::Error(path + " cannot be read as a bag (" + error.what() +
                          "): see what rosbag info says");
  }
  if (!kept.rig())
    throw geometry::Error(path + " holds no /calibration/rig: name a rig file with --rig");
  if (kept.images() == 0)
    throw geometry::Error(path + " holds no images of the rig's cameras: record <camera>/ir_blobs");
  if (kept.rig()->cameras.size() < kFewestCameras)
    throw geometry::Error(
        format("the rig has %zu cameras, but only a rig of %zu or more can be "
               "corrected: calibrate it again instead",
               kept.rig()->cameras.size(), kFewestCameras));
  geometry::writeRigFile(*kept.rig(), target);
  std::printf("%zu images of %zu cameras; changes: %zu; the rig is in %s\n", kept.images(),
              kept.rig()->cameras.size(), kept.changes(), target.c_str());
}

}  // namespace

int main(int argc, char** argv) {
  std::string bag, rig, target;
  ArgumentParser parser("keep_calibrated",
                        "Corrects a rig by the images of BAG as continuous calibration does, "
                        "applies and prints every change, and writes the rig to OUT.yaml. Without "
                        "imu/data_raw and /tf_static in BAG the tilt of a camera that was turned "
                        "is not watched any more.");
  parser.positional("BAG", &bag);
  parser.positional("OUT.yaml", &target);
  parser.option("--rig FILE", &rig, "start with this rig (default: the bag's first)");
  return parser.run(argc, argv, [&] {
    keep(bag, rig, target);
    return 0;
  });
}
