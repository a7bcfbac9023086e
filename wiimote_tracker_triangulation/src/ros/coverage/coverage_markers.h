#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_COVERAGE_COVERAGE_MARKERS_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_COVERAGE_COVERAGE_MARKERS_H

#include "geometry/coverage.h"

#include <visualization_msgs/MarkerArray.h>

#include <string>
#include <vector>

namespace wiimote_tracker {

/// Such as "86 % of the volume is seen by two cameras or more; points are known to 12 mm there
/// (median)."
std::string sentenceOf(const std::vector<geometry::CoverageCell>& cells);

/// Such as " wiimote_3, turned by 15 degrees to the left and 10 degrees up, would make it 94 %."
std::string sentenceOf(const geometry::CameraTurn& turn);

/// A small cube in each cell: red where fewer than two cameras see it, else from green (points are
/// known to 5 mm or better) to yellow (50 mm or worse); and a sentence above them.
visualization_msgs::MarkerArray coverageMarkers(const std::string& world_frame,
                                                const std::vector<geometry::CoverageCell>& cells,
                                                double cell_size,
                                                const std::string& sentence);

/// The same of a walk: a cube where the LED was, red where one camera saw it, yellow for two, green
/// for more.
visualization_msgs::MarkerArray walkMarkers(const std::string& world_frame,
                                            const std::vector<geometry::CoverageCell>& walked,
                                            double cell_size,
                                            const std::string& sentence);

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_COVERAGE_COVERAGE_MARKERS_H
