#pragma once

#include "recording/format.h"

#include <cstdint>
#include <fstream>
#include <istream>
#include <string>

namespace wiimote_tracker::recording {

/// Opens the file of a recording. @throws BadRecording if it cannot be read, or is a folder.
std::ifstream openRecording(const std::string& path);

/// Reads records from a stream.
class Reader {
 public:
  /// Reads the header. Keeps a reference to the stream.
  /// @throws BadRecording if it is not a recording, or of an unknown version.
  explicit Reader(std::istream& in);

  const FileHeader& header() const { return header_; }

  /// @returns false at the end, or where the file is cut off or damaged (see damage()).
  bool next(Record& record);

  /// Why reading ended early, one sentence; empty if it did not.
  const std::string& damage() const { return damage_; }

 private:
  bool end(const char* why);

  std::istream& in_;
  FileHeader header_;
  std::uint64_t position_ = 0;  ///< Of the present record [byte].
  std::int64_t time_ = 0;       ///< Of the last record [ns].
  std::string payload_;
  std::string damage_;
  bool ended_ = false;
};

}  // namespace wiimote_tracker::recording
