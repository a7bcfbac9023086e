#ifndef WIIMOTE_TRACKER_TRIANGULATION_MEASUREMENTS_TUM_WRITER_H
#define WIIMOTE_TRACKER_TRIANGULATION_MEASUREMENTS_TUM_WRITER_H

#include "measurements/part_file.h"

#include <Eigen/Geometry>

#include <cstdint>
#include <string>

namespace wiimote_tracker::measurements {

/// The poses of one body as text, as the TUM RGB-D benchmark defines it and evo reads it: one line
/// `time x y z qx qy qz qw` a pose, [s since 1970] and [m]. All throw Error.
class TumWriter {
 public:
  explicit TumWriter(const std::string& path) : file_(path) {}

  /// @param stamp [ns since 1970].
  void add(std::int64_t stamp, const Eigen::Vector3d& position, const Eigen::Quaterniond& rotation);

  void flush() { file_.flush(); }
  void finish() { file_.finish(); }

 private:
  OutputFile file_;
};

}  // namespace wiimote_tracker::measurements

#endif  // WIIMOTE_TRACKER_TRIANGULATION_MEASUREMENTS_TUM_WRITER_H
