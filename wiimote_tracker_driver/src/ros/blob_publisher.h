#pragma once

#include "image_stamper.h"
#include "image_topic.h"
#include "wiimote_tracker_driver/protocol/input_reports.h"

#include <ros/node_handle.h>
#include <wiimote_tracker_msgs/IrBlobArray.h>

#include <cstddef>
#include <string>

namespace wiimote_tracker::driver {

/// Message of a spot. The sensor's y points up, the message's down. The bounding box covers whole
/// cells of 8 px. NaN and empty arrays for what the format does not contain.
wiimote_tracker_msgs::IrBlob irBlob(const protocol::IrSpot& spot,
                                    protocol::IrFormat format,
                                    std::size_t slot);

/// Publishes each image as one `ir_blobs` message, empty when nothing is seen.
class BlobPublisher {
 public:
  BlobPublisher(ros::NodeHandle& nh, const std::string& camera, const std::string& frame_id);

  /// `identity`: of the remote that sent the image.
  void publish(const protocol::DataReport& image,
               const ImageTime& time,
               const std::string& identity);

 private:
  const std::string camera_;
  const std::string frame_id_;
  ImageTopic<wiimote_tracker_msgs::IrBlobArray> topic_;
};

}  // namespace wiimote_tracker::driver
