#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_TOOLS_TRACK_BAG_BAG_FILE_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_TOOLS_TRACK_BAG_BAG_FILE_H

#include <ros/datatypes.h>
#include <ros/time.h>

#include <cstdint>
#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace wiimote_tracker {

/// Writes a file in the format of bags (http://wiki.ros.org/Bags/Format/2.0), without compression.
/// rosbag::Bag does that too, but looks into the file for each message, which takes half of the
/// time of track_bag. Equal messages in equal order give equal files.
class BagFile {
 public:
  /// @throws BagError; so do all others. what() says what the system says.
  explicit BagFile(const std::string& path);

  /// @param header topic, type, md5sum, message_definition; perhaps callerid, latching.
  /// @returns the connection's number.
  std::uint32_t addConnection(const std::string& topic, const ros::M_string& header);

  /// Appends a message. @returns where its `size` bytes go, before the next call.
  std::uint8_t* add(std::uint32_t connection, const ros::Time& time, std::uint32_t size);

  /// Without it the file is no bag. Nothing may be added afterwards.
  void finish();

 private:
  using Bytes = std::vector<std::uint8_t>;

  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  /// Where a message stands in its chunk.
  struct IndexEntry {
    ros::Time time;
    std::uint32_t offset;
  };

  /// What is said of a chunk at the end of the file.
  struct ChunkInfo {
    std::uint64_t position = 0;  // in the file
    ros::Time start;
    ros::Time end;
    std::map<std::uint32_t, std::uint32_t> counts;  // of messages, by connection
  };

  void finishChunk();
  void writeHeader(std::uint64_t index_position);
  void write(const Bytes& bytes);

  std::unique_ptr<std::FILE, Close> file_;
  std::uint64_t position_ = 0;  // in the file
  Bytes chunk_;
  std::map<std::uint32_t, std::vector<IndexEntry>> index_;  // of the chunk, by connection
  std::vector<Bytes> connections_;                          // as records
  std::vector<ChunkInfo> chunks_;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_TOOLS_TRACK_BAG_BAG_FILE_H
