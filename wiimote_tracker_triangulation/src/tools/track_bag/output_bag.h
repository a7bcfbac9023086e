#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_TOOLS_TRACK_BAG_OUTPUT_BAG_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_TOOLS_TRACK_BAG_OUTPUT_BAG_H

#include "bag_file.h"
#include "message_bytes.h"

#include <ros/message_traits.h>
#include <ros/serialization.h>

#include <boost/shared_ptr.hpp>

#include <map>
#include <memory>
#include <string>

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

  /// A topic has messages of one type. @throws BagError.
  template <typename Message>
  void write(const std::string& topic,
             const ros::Time& time,
             const Message& message,
             bool is_latched = false) {
    auto connection = topics_.find(topic);
    if (connection == topics_.end()) {
      ros::M_string header;
      header["topic"] = topic;
      header["type"] = ros::message_traits::datatype(message);
      header["md5sum"] = ros::message_traits::md5sum(message);
      header["message_definition"] = ros::message_traits::definition(message);
      if (is_latched) {
        header["latching"] = "1";
        header["callerid"] = "/track_bag";
      }
      connection = topics_.emplace(topic, file_->addConnection(topic, header)).first;
    }
    const std::uint32_t size = ros::serialization::serializationLength(message);
    ros::serialization::OStream stream(add(connection->second, time, size), size);
    ros::serialization::serialize(stream, message);
  }

  /// A message of another bag as it is, of a connection with this header. @throws BagError.
  void copy(const std::string& topic,
            const ros::Time& time,
            const MessageBytes& message,
            const boost::shared_ptr<ros::M_string>& header);

  /// Nothing may be written afterwards. @throws measurements::WriteError, BagError.
  void finish();

 private:
  std::uint8_t* add(std::uint32_t connection, const ros::Time& time, std::uint32_t size);
  [[noreturn]] void fail(const std::string& why);

  std::string path_;
  std::unique_ptr<BagFile> file_;
  std::map<std::string, std::uint32_t> topics_;  // connections of what is not copied
  std::map<boost::shared_ptr<ros::M_string>, std::uint32_t> copied_;  // connections, by header
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_TOOLS_TRACK_BAG_OUTPUT_BAG_H
