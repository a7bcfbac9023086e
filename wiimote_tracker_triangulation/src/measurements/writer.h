#ifndef WIIMOTE_TRACKER_TRIANGULATION_MEASUREMENTS_WRITER_H
#define WIIMOTE_TRACKER_TRIANGULATION_MEASUREMENTS_WRITER_H

#include "measurements/measurement.h"

#include <memory>
#include <string>

namespace wiimote_tracker::measurements {

/// A file that measurements are written to. It has its name only when finish() has returned, and is
/// whole then; a file of that name that was there before is kept as path + ".bak". Equal
/// measurements give equal files.
class Writer {
 public:
  virtual ~Writer() = default;

  /// @throws Error.
  virtual void add(const Measurement& measurement) = 0;

  /// Brings what was added so far to the disk, as far as the kind of file can.
  /// @throws Error.
  virtual void flush() {}

  /// Nothing may be added afterwards. @throws Error.
  virtual void finish() = 0;
};

/// Comma-separated values, one row per measurement, the first line names the columns and their
/// units. Numbers come back bit for bit, unknown ones are "nan"; times are in seconds since 1970
/// with all nine digits. Rows go to path + ".part" at once, so that a crash loses nothing but the
/// last of them.
/// @throws Error: the file cannot be created.
std::unique_ptr<Writer> makeCsvWriter(const std::string& path);

/// Whether this program was built with matio.
bool hasMatlab();

/// A MAT-file of version 5, compressed: a variable per field of Measurement, its rows are the
/// measurements; `readme` describes them. Texts are numbers of lines of tables (`label` of
/// `labels`, ...), from 1. All is kept in memory until finish(), 0.3 kB per measurement.
/// @throws Error: the file cannot be created, or the program was built without matio.
std::unique_ptr<Writer> makeMatlabWriter(const std::string& path);

}  // namespace wiimote_tracker::measurements

#endif  // WIIMOTE_TRACKER_TRIANGULATION_MEASUREMENTS_WRITER_H
