#include "evaluate.h"
#include "gesture/segmenter.h"
#include "gesture/spotter.h"
#include "wiimote_tracker_triangulation/geometry/error.h"
#include "wiimote_tracker_triangulation/gesture/path_file.h"

namespace wiimote_tracker::gesture_tool {

FalseAlarms countFalseAlarms(const std::vector<Person>& teachers,
                             const std::string& motion,
                             const gesture::RecognizerOptions& options) {
  gesture::RecognizerOptions in_metres = options;
  in_metres.shape.minimum_length = gesture::ShapeOptions().minimum_length;
  // Shapes have no scale, so the examples may have any unit.
  gesture::Recognizer recognizer(in_metres);
  for (const Person& person : teachers) {
    for (const Sample& sample : person.samples)
      recognizer.add({sample.gesture, "", sample.path});
  }

  const auto recognize = [&](const gesture::Path& path) { return recognizer.recognize(path); };
  const std::vector<std::vector<double>> rows = gesture::readRows(motion, 4);
  FalseAlarms alarms;
  for (std::size_t marker = 1; marker + 3 <= rows[0].size(); marker += 3) {
    gesture::Spotter spotter{gesture::SpotterOptions()};
    gesture::Segmenter segmenter{gesture::SegmenterOptions()};
    for (const std::vector<double>& row : rows) {
      if (row.size() != rows[0].size())
        throw Error(motion + " has rows of different lengths; mend it");
      const gesture::PathPoint point{
          row[0], 1e-3 * Eigen::Vector3d(row[marker], row[marker + 1], row[marker + 2])};
      if (!point.position.allFinite())
        continue;
      alarms.continuous += spotter.add(point, recognize) ? 1 : 0;
      if (const auto path = segmenter.add(point, point.time)) {
        const auto recognition = recognize(*path);
        alarms.between_rests += recognition && recognition->accepted() ? 1 : 0;
      }
    }
    alarms.minutes += (rows.back()[0] - rows[0][0]) / 60.0;
  }
  return alarms;
}

}  // namespace wiimote_tracker::gesture_tool
