#ifndef WIIMOTE_TRACKER_DRIVER_RECORDING_READER_H
#define WIIMOTE_TRACKER_DRIVER_RECORDING_READER_H

#include "recording/format.h"

#include <cstdint>
#include <fstream>
#include <istream>
#include <string>

namespace wiimote_tracker::recording {

/// Opens the file of a recording. @throws BadRecording when it cannot be read, or is a folder.
std::ifstream openRecording(const std::string& path);

/// Reads a recording from a stream, one record after the other.
class Reader {
 public:
  /// Reads the header. Keeps a reference to the stream.
  /// @throws BadRecording when it is no recording, or of a version that is not known.
  explicit Reader(std::istream& in);

  const Header& header() const { return header_; }

  /// @returns false at the end, and where the file is cut off or damaged; damage() tells.
  bool next(Record& record);

  /// Why reading ended before the end, one sentence; empty when it did not.
  const std::string& damage() const { return damage_; }

 private:
  bool end(const char* why);

  std::istream& in_;
  Header header_;
  std::uint64_t position_ = 0;  ///< [byte] Of the record that is read.
  std::int64_t time_ = 0;       ///< [ns] Of the last record.
  std::string payload_;
  std::string damage_;
  bool ended_ = false;
};

}  // namespace wiimote_tracker::recording

#endif  // WIIMOTE_TRACKER_DRIVER_RECORDING_READER_H
