#include "report.h"

#include "wiimote_tracker_triangulation/geometry/atomic_file.h"

#include <wiimote_tracker_msgs/text.h>

#include <algorithm>
#include <cstdio>
#include <sstream>

namespace wiimote_tracker::gesture_tool {
namespace {

double share(std::size_t part, std::size_t whole) {
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0.0;
}

std::string line(const char* what, std::size_t part, std::size_t whole) {
  return format("  %-38s %5.1f %%  (%zu of %zu)\n", what, 100.0 * share(part, whole), part, whole);
}

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\')
      result += '\\';
    result += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return result + "\"";
}

}  // namespace

std::string table(const Evaluation& e, const std::optional<FalseAlarms>& alarms) {
  std::ostringstream out;
  out << "Right (" << e.gestures.size() << " gestures, at most " << e.examples << " examples):\n";
  out << line("this package", e.right, e.tested);
  for (const MethodResult& other : e.others)
    out << line(other.name.c_str(), other.right, e.tested);
  out << "Rejected:\n";
  out << line("gestures that were shown", e.rejected, e.tested);
  out << line("gestures that were not", e.unknown_rejected, e.tested);
  out << format("Time of a recognition, median: %.0f us\n", 1e6 * e.median_seconds);
  if (alarms) {
    out << format(
        "False alarms in %.1f min of motion: continuous %.2f per min, between rests %.2f "
        "per min\n",
        alarms->minutes, static_cast<double>(alarms->continuous) / alarms->minutes,
        static_cast<double>(alarms->between_rests) / alarms->minutes);
  }

  std::size_t width = 0;
  for (const std::string& gesture : e.gestures)
    width = std::max(width, gesture.size());
  out << "Confusion (rows: drawn; columns: recognised, in the same order):\n";
  for (std::size_t i = 0; i < e.gestures.size(); ++i) {
    out << "  " << e.gestures[i] << std::string(width - e.gestures[i].size(), ' ');
    for (const std::size_t count : e.confusion[i]) {
      out << (count > 0 ? format(" %3zu", count) : "   .");
    }
    out << "\n";
  }
  return out.str();
}

void writeJson(const std::string& file,
               const Evaluation& e,
               const std::optional<FalseAlarms>& alarms) {
  std::ostringstream out;
  out.precision(17);
  out << "{\n  \"accuracy\": " << share(e.right, e.tested) << ",\n  \"tested\": " << e.tested
      << ",\n  \"right\": " << e.right << ",\n  \"rejected\": " << e.rejected
      << ",\n  \"unknown_tested\": " << e.tested
      << ",\n  \"unknown_rejected\": " << e.unknown_rejected << ",\n  \"examples\": " << e.examples
      << ",\n  \"median_recognition_s\": " << e.median_seconds << ",\n  \"others\": {";
  for (std::size_t i = 0; i < e.others.size(); ++i)
    out << (i > 0 ? ", " : "") << quoted(e.others[i].name) << ": "
        << share(e.others[i].right, e.tested);
  out << "},\n";
  if (alarms) {
    out << "  \"motion_minutes\": " << alarms->minutes
        << ",\n  \"false_alarms_continuous\": " << alarms->continuous
        << ",\n  \"false_alarms_between_rests\": " << alarms->between_rests << ",\n";
  }
  out << "  \"gestures\": [";
  for (std::size_t i = 0; i < e.gestures.size(); ++i)
    out << (i > 0 ? ", " : "") << quoted(e.gestures[i]);
  out << "],\n  \"confusion\": [\n";
  for (std::size_t i = 0; i < e.confusion.size(); ++i) {
    out << "    [";
    for (std::size_t k = 0; k < e.confusion[i].size(); ++k)
      out << (k > 0 ? ", " : "") << e.confusion[i][k];
    out << (i + 1 < e.confusion.size() ? "],\n" : "]\n");
  }
  out << "  ]\n}\n";
  geometry::writeFileAtomically(file, out.str());
}

}  // namespace wiimote_tracker::gesture_tool
