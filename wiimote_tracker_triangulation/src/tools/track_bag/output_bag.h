#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_TOOLS_TRACK_BAG_OUTPUT_BAG_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_TOOLS_TRACK_BAG_OUTPUT_BAG_H

#include "error.h"

#include <rosbag/bag.h>

#include <boost/shared_ptr.hpp>

#include <memory>
#include <string>
#include <utility>

namespace wiimote_tracker {

/// A bag that has its name only when it is whole; one of that name that was there before is kept as
/// path + ".bak". Equal messages in equal order give equal files.
class OutputBag {
 public:
  /// @throws measurements::WriteError, BagError.
  explicit OutputBag(const std::string& path);
  ~OutputBag();
  OutputBag(const OutputBag&) = delete;
  OutputBag& operator=(const OutputBag&) = delete;

  /// `header`: of the connection, null for one made from topic and type. @throws BagError.
  template <typename Message>
  void write(const std::string& topic,
             const ros::Time& time,
             const Message& message,
             const boost::shared_ptr<ros::M_string>& header = nullptr) {
    try {
      bag_->write(topic, time, message, header);
    } catch (const rosbag::BagException& e) {
      fail(e.what());
    }
  }

  /// Nothing may be written afterwards. @throws measurements::WriteError, BagError.
  void finish();

 private:
  [[noreturn]] void fail(const std::string& why);

  std::string path_;
  std::unique_ptr<rosbag::Bag> bag_;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_TOOLS_TRACK_BAG_OUTPUT_BAG_H
