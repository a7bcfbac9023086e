#ifndef WIIMOTE_TRACKER_TRIANGULATION_MEASUREMENTS_TABLE_FILES_H
#define WIIMOTE_TRACKER_TRIANGULATION_MEASUREMENTS_TABLE_FILES_H

#include "measurements/writer.h"

#include <memory>
#include <string>
#include <vector>

namespace wiimote_tracker::measurements {

/// Files to write; empty: none.
struct TableFiles {
  std::string csv;
  std::string matlab;
  std::string c3d;
  std::string trc;
  double rate = 100.0;  ///< Of C3D and TRC [Hz, > 0].
};

/// One for each file. @throws Error: one cannot be created.
inline std::vector<std::unique_ptr<Writer>> makeWriters(const TableFiles& files) {
  std::vector<std::unique_ptr<Writer>> writers;
  if (!files.csv.empty())
    writers.push_back(makeCsvWriter(files.csv));
  if (!files.matlab.empty())
    writers.push_back(makeMatlabWriter(files.matlab));
  if (!files.c3d.empty())
    writers.push_back(makeC3dWriter(files.c3d, files.rate));
  if (!files.trc.empty())
    writers.push_back(makeTrcWriter(files.trc, files.rate));
  return writers;
}

}  // namespace wiimote_tracker::measurements

#endif  // WIIMOTE_TRACKER_TRIANGULATION_MEASUREMENTS_TABLE_FILES_H
