#ifndef WIIMOTE_TRACKER_CALIBRATION_IMPORT_NUMBER_TABLE_H
#define WIIMOTE_TRACKER_CALIBRATION_IMPORT_NUMBER_TABLE_H

#include <wiimote_tracker_msgs/error.h>

#include <string>
#include <vector>

namespace wiimote_tracker::import {

/// A recording cannot be read or used. what() names the file, and line or row and column where
/// there are any, in one sentence.
struct ImportError : Error {
  using Error::Error;
};

using NumberTable = std::vector<std::vector<double>>;  ///< Rows of equal length.

/// Numbers separated by blanks, one row per line; NaN is allowed, empty lines and what follows a #
/// (the headers of Octave) are skipped. The size must be rows x columns; 0 allows any.
/// @throws ImportError: missing, empty, not a number, infinite, rows of different length, another
/// size.
NumberTable readNumberTable(const std::string& path, std::size_t rows = 0, std::size_t columns = 0);

/// Lines that are not empty, without blanks at their ends. @throws ImportError: missing.
std::vector<std::string> readLines(const std::string& path);

bool fileExists(const std::string& path);

/// The whole text as a number; nothing else may follow. @throws ImportError naming `where`.
double parseNumber(const std::string& text, const std::string& where);

}  // namespace wiimote_tracker::import

#endif  // WIIMOTE_TRACKER_CALIBRATION_IMPORT_NUMBER_TABLE_H
