#ifndef WIIMOTE_TRACKER_MSGS_ERROR_H
#define WIIMOTE_TRACKER_MSGS_ERROR_H

#include <stdexcept>

namespace wiimote_tracker {

/// Base of all exceptions of the project. what() is one sentence: what is wrong, and what to do.
struct Error : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A file is missing, unreadable, damaged, of another kind or version, or cannot be written. what()
/// names the file, and the key where there is one.
struct FileError : Error {
  using Error::Error;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_MSGS_ERROR_H
