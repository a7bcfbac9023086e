#include "bag.h"

#include "capture/image.h"
#include "wiimote_tracker_calibration/import/recording.h"

#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <wiimote_tracker_msgs/IrBlobArray.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

namespace wiimote_tracker::self_calibrate {

namespace {

using import::ImportError;
using import::Recording;

struct Image {
  double stamp;
  std::optional<Eigen::Vector2d> pixel;  // nothing unless there was exactly one spot
};

struct CameraImages {
  std::string topic;
  import::RecordedCamera camera;
  std::vector<Image> images;
};

void add(const wiimote_tracker_msgs::IrBlobArray& blobs, CameraImages* to) {
  geometry::Intrinsics& lens = to->camera.intrinsics;
  const auto width = static_cast<int>(blobs.width);
  const auto height = static_cast<int>(blobs.height);
  if (!to->images.empty() && (lens.width != width || lens.height != height))
    throw ImportError("the image size of " + to->camera.name + " changes within the bag");
  lens.width = width;
  lens.height = height;
  Image image{blobs.header.stamp.toSec(), std::nullopt};
  if (blobs.blobs.size() == 1)
    image.pixel = Eigen::Vector2d(blobs.blobs[0].x, blobs.blobs[0].y);
  to->images.push_back(image);
}

std::optional<Eigen::Vector2d> pixelAt(const std::vector<Image>& images, double stamp) {
  const auto after =
      std::lower_bound(images.begin(), images.end(), stamp,
                       [](const Image& image, double time) { return image.stamp < time; });
  if (after != images.end() && after->stamp == stamp)
    return after->pixel;
  if (after == images.end() || after == images.begin())
    return std::nullopt;
  const auto before = std::prev(after);
  const double gap = after->stamp - before->stamp;
  if (!before->pixel || !after->pixel || gap > capture::kLongestGap)
    return std::nullopt;
  const double share = (stamp - before->stamp) / gap;
  return Eigen::Vector2d((1.0 - share) * *before->pixel + share * *after->pixel);
}

std::map<std::string, CameraImages> readImages(const std::string& path) {
  std::map<std::string, CameraImages> cameras;
  std::error_code unknown;
  if (!std::filesystem::exists(path, unknown) && !unknown)
    throw ImportError("there is neither a bag " + path + " nor a file " + path +
                      "/Res.dat: name a bag or a folder");
  try {
    rosbag::Bag bag(path);
    rosbag::View view(bag, rosbag::TypeQuery("wiimote_tracker_msgs/IrBlobArray"));
    for (const rosbag::MessageInstance& message : view) {
      const auto blobs = message.instantiate<wiimote_tracker_msgs::IrBlobArray>();
      if (!blobs)
        continue;
      CameraImages& images = cameras[blobs->camera];
      if (images.topic.empty())
        images.topic = message.getTopic();
      if (images.topic != message.getTopic())
        throw ImportError(path + " holds images of " + blobs->camera + " on " + images.topic +
                          " and " + message.getTopic() +
                          ": keep those of one tracker with rosbag filter");
      images.camera.name = blobs->camera;
      images.camera.has_intrinsics = false;
      add(*blobs, &images);
    }
  } catch (const rosbag::BagException& error) {
    throw ImportError(path + " is neither a folder with Res.dat nor a bag that can be read (" +
                      error.what() +
                      "): if its recording was cut off, repair it with rosbag reindex");
  }
  return cameras;
}

}  // namespace

Recording readBag(const std::string& path) {
  std::map<std::string, CameraImages> cameras = readImages(path);
  if (cameras.size() < 2)
    throw ImportError(path + " holds ir_blobs of " + std::to_string(cameras.size()) +
                      " cameras: record two or more");
  Recording recording;
  const std::vector<Image>* most = nullptr;
  for (auto& [name, camera] : cameras) {
    std::stable_sort(camera.images.begin(), camera.images.end(),
                     [](const Image& a, const Image& b) { return a.stamp < b.stamp; });
    recording.cameras.push_back(camera.camera);
    if (most == nullptr || camera.images.size() > most->size())
      most = &camera.images;
  }
  for (const Image& instant : *most) {
    import::Pixels pixels;
    for (const auto& [name, camera] : cameras)
      pixels.push_back(pixelAt(camera.images, instant.stamp));
    recording.frames.push_back(pixels);
  }
  return recording;
}

}  // namespace wiimote_tracker::self_calibrate
