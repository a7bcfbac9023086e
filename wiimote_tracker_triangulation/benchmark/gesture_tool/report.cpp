#include "report.h"

#include "wiimote_tracker_triangulation/geometry/atomic_file.h"

#include <wiimote_tracker_msgs/text.h>

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <map>
#include <sstream>

namespace wiimote_tracker::gesture_tool {
namespace {

double share(std::size_t part, std::size_t whole) {
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0.0;
}

std::string line(const char* what, std::size_t part, std::size_t whole) {
  return format("  %-38s %5.1f %%  (%zu of %zu)\n", what, 100.0 * share(part, whole), part, whole);
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
  YAML::Emitter out;  // JSON is YAML
  out.SetMapFormat(YAML::Flow);
  out.SetSeqFormat(YAML::Flow);
  out.SetStringFormat(YAML::DoubleQuoted);
  out.SetDoublePrecision(17);
  const auto add = [&](const char* name, const auto& value) { out << name << value; };
  std::map<std::string, double> others;
  for (const MethodResult& other : e.others)
    others[other.name] = share(other.right, e.tested);
  out << YAML::BeginMap;
  add("accuracy", share(e.right, e.tested));
  add("tested", e.tested);
  add("right", e.right);
  add("rejected", e.rejected);
  add("unknown_tested", e.tested);
  add("unknown_rejected", e.unknown_rejected);
  add("examples", e.examples);
  add("median_recognition_s", e.median_seconds);
  add("others", others);
  if (alarms) {
    add("motion_minutes", alarms->minutes);
    add("false_alarms_continuous", alarms->continuous);
    add("false_alarms_between_rests", alarms->between_rests);
  }
  add("gestures", e.gestures);
  add("confusion", e.confusion);
  out << YAML::EndMap << YAML::Newline;
  geometry::writeFileAtomically(file, out.c_str());
}

}  // namespace wiimote_tracker::gesture_tool
