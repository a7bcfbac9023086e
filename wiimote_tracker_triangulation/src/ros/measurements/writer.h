#pragma once

#include "geometry/output_file.h"

#include <wiimote_tracker_msgs/TrackedBodyArray.h>
#include <wiimote_tracker_msgs/TrackedPointArray.h>
#include <wiimote_tracker_msgs/text.h>

#include <cstdint>
#include <cstdlib>
#include <deque>
#include <locale>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

namespace wiimote_tracker::measurements {

using geometry::OutputFile;

/// One row of a table: an LED of a message.
struct Measurement {
  const wiimote_tracker_msgs::TrackedPointArray& message;
  const wiimote_tracker_msgs::TrackedPoint& led;
  bool triggered;  ///< The message answers a trigger.
};

inline std::int64_t nanosecondsOf(const ros::Time& time) {
  return static_cast<std::int64_t>(time.toNSec());
}

/// [s since 1970], exactly.
inline std::string secondsOf(std::int64_t nanoseconds) {
  const std::lldiv_t t = std::lldiv(nanoseconds, 1000000000);
  return format("%lld.%09lld", t.quot, t.rem);
}

inline std::string secondsOf(const ros::Time& time) {
  return secondsOf(nanosecondsOf(time));
}

/// Text whose numbers have a decimal point in any locale.
inline std::ostringstream plainText(int digits) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text.precision(digits);
  return text;
}

/// A file of measurements, or several. They get their names in finish(), when they are complete; an
/// existing file is kept as path + ".bak". Equal measurements give equal files.
class Writer {
 public:
  virtual ~Writer() = default;

  /// @throws Error.
  virtual void add(const Measurement& /*measurement*/) {}
  virtual void addBodies(const wiimote_tracker_msgs::TrackedBodyArray& /*bodies*/) {}

  /// Adds each LED of a message. @throws Error.
  void addAll(const wiimote_tracker_msgs::TrackedPointArray& message, bool triggered) {
    for (const wiimote_tracker_msgs::TrackedPoint& led : message.points)
      add({message, led, triggered});
  }

  /// Writes what was added to disk, if the format allows. @throws Error.
  void flush() {
    for (OutputFile& file : files_)
      file.flush();
  }

  /// Completes the files; nothing may be added afterwards. @returns a sentence for the user, or
  /// nothing. @throws Error.
  virtual std::string finish() {
    for (OutputFile& file : files_)
      file.finish();
    return "";
  }

  /// Removes what was written if it is not finished.
  void discard() {
    for (OutputFile& file : files_)
      file.discard();
  }

 protected:
  /// A further file of this writer. @throws Error.
  OutputFile* open(const std::string& path) { return &files_.emplace_back(path); }

 private:
  std::deque<OutputFile> files_;
};

/// Comma-separated values: one row per measurement; the first line has the columns and their units.
/// Numbers are read back bit by bit, unknown ones are "nan"; times are in seconds since 1970 with
/// nine decimals. Rows go to path + ".part" at once, so that a crash loses the last ones only.
/// Poses of bodies, if there are any, are in csvOfBodies(); without any, one that is there becomes
/// its .bak.
/// @throws Error: the file cannot be created.
std::unique_ptr<Writer> makeCsvWriter(const std::string& path);
/// FOLDER/NAME_bodies.csv of FOLDER/NAME.csv.
std::string csvOfBodies(const std::string& path);

/// C3D of version 1 in the format of Intel with floating-point numbers, as biomechanics programs
/// read it (the C3D File Format User Guide, Motion Lab Systems): the tracked LEDs as points in
/// millimetres, interpolated to one rate [Hz] (SampleTable), in gaps invalid; no analog channels.
/// WIIMOTE_TRACKER:START_TIME has the time of frame 1 [s since 1970], which finish() returns, too.
/// Stays in memory until finish(). @throws Error: the file cannot be created.
std::unique_ptr<Writer> makeC3dWriter(const std::string& path, double rate);

/// The same as TRC text for OpenSim, as its guide describes it; coordinates in gaps are empty.
std::unique_ptr<Writer> makeTrcWriter(const std::string& path, double rate);

/// A compressed MAT-file of version 5: one variable per field of TrackedPoint, with one row per
/// measurement, and the struct `bodies` with those of bodies; the variable `readme` describes them.
/// Strings are 1-based line numbers of tables (`label` of `labels`, ...). Data stay in memory until
/// finish(), 0.3 kB per measurement.
/// @throws Error: the file cannot be created, or the program was built without matio.
std::unique_ptr<Writer> makeMatlabWriter(const std::string& path);

/// The poses of each tracked body in a file <folder>/<body>.tum, as the TUM RGB-D benchmark defines
/// it and evo reads it: one line `time x y z qx qy qz qw` a pose, [s since 1970] and [m].
std::unique_ptr<Writer> makeTumWriter(const std::string& folder);
std::string tumPath(const std::string& folder, const std::string& body);

/// Files to write; empty: none.
struct OutputNames {
  std::string csv;
  std::string matlab;
  std::string c3d;
  std::string trc;
  std::string tum;      ///< Folder.
  double rate = 100.0;  ///< Of C3D and TRC [Hz, > 0].

  std::vector<std::string> tables() const {
    return {csv, csv.empty() ? "" : csvOfBodies(csv), matlab, c3d, trc};
  }
};

/// One for each file. @throws Error: one cannot be created, or two are the same; then no part is
/// left of those that were created.
inline std::vector<std::unique_ptr<Writer>> makeWriters(const OutputNames& names) {
  geometry::checkDistinct(names.tables());
  std::vector<std::unique_ptr<Writer>> writers;
  const auto add = [&](const std::string& name, const auto& make, auto... rate) {
    if (!name.empty())
      writers.push_back(make(name, rate...));
  };
  try {
    add(names.csv, makeCsvWriter);
    add(names.matlab, makeMatlabWriter);
    add(names.c3d, makeC3dWriter, names.rate);
    add(names.trc, makeTrcWriter, names.rate);
    add(names.tum, makeTumWriter);
  } catch (...) {
    for (const std::unique_ptr<Writer>& writer : writers)
      writer->discard();
    throw;
  }
  return writers;
}

}  // namespace wiimote_tracker::measurements
