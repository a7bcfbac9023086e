#include "blob_publisher.h"

#include <limits>

namespace wiimote_tracker::driver {
namespace {

using protocol::imageY;
using protocol::IrFormat;
using wiimote_tracker_msgs::IrBlobArray;

constexpr int kCell = 8;  // [px] Side of a cell of a bounding box.
constexpr float kNoValue = std::numeric_limits<float>::quiet_NaN();

// Both are the values of the camera's mode register.
static_assert(static_cast<int>(IrFormat::kNone) == IrBlobArray::IR_MODE_UNKNOWN &&
              static_cast<int>(IrFormat::kBasic) == IrBlobArray::IR_MODE_BASIC &&
              static_cast<int>(IrFormat::kExtended) == IrBlobArray::IR_MODE_EXTENDED &&
              static_cast<int>(IrFormat::kFull) == IrBlobArray::IR_MODE_FULL);

}  // namespace

wiimote_tracker_msgs::IrBlob irBlob(const protocol::IrSpot& spot,
                                    IrFormat format,
                                    std::size_t slot) {
  wiimote_tracker_msgs::IrBlob blob;
  blob.x = spot.x;
  blob.y = imageY(spot.y);
  blob.size = format == IrFormat::kBasic ? kNoValue : static_cast<float>(spot.size);
  blob.intensity = kNoValue;
  blob.slot = static_cast<std::uint8_t>(slot);
  if (format == IrFormat::kFull) {
    blob.intensity = static_cast<float>(spot.intensity);
    const auto [x_min, y_min, x_max, y_max] = spot.box;
    blob.bounding_box = {
        static_cast<float>(kCell * x_min), static_cast<float>(imageY(kCell * y_max + kCell - 1)),
        static_cast<float>(kCell * x_max + kCell - 1), static_cast<float>(imageY(kCell * y_min))};
  }
  return blob;
}

BlobPublisher::BlobPublisher(ros::NodeHandle& nh,
                             const std::string& camera,
                             const std::string& frame_id)
    : camera_(camera), frame_id_(frame_id), topic_(nh, "ir_blobs") {}

void BlobPublisher::publish(const protocol::DataReport& image,
                            const ImageTime& time,
                            const std::string& identity) {
  if (!topic_.subscribed())
    return;
  const auto message = boost::make_shared<IrBlobArray>();
  message->header.stamp = time.stamp;
  message->header.frame_id = frame_id_;
  message->camera = camera_;
  message->identity = identity;
  message->arrival = time.arrival;
  message->stamp_stddev = time.stddev;
  message->clock_epoch = time.clock_epoch;
  message->frame = time.frame;
  message->width = protocol::kSensorWidth;
  message->height = protocol::kSensorHeight;
  message->max_blobs = static_cast<std::uint32_t>(image.spots.size());
  message->ir_mode = static_cast<std::uint8_t>(image.ir_format);
  message->blobs.reserve(image.spots.size());
  for (std::size_t slot = 0; slot < image.spots.size(); ++slot) {
    if (image.spots[slot].seen)
      message->blobs.push_back(irBlob(image.spots[slot], image.ir_format, slot));
  }
  topic_.publish(message);
}

}  // namespace wiimote_tracker::driver
