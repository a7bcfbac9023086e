#pragma once

#include <wiimote_tracker_msgs/text.h>

#include <stdexcept>
#include <string>

namespace wiimote_tracker {

/// Base of all exceptions of the project. what() is one sentence: what is wrong, and what to do. It
/// is valid UTF-8 also where it quotes a damaged file, since services answer with it.
struct Error : std::runtime_error {
  explicit Error(const std::string& what) : std::runtime_error(validUtf8(what)) {}
};

/// A file is missing, unreadable, damaged, of another kind or version, or cannot be written. what()
/// names the file, and the key where there is one.
struct FileError : Error {
  using Error::Error;
};

}  // namespace wiimote_tracker
