#pragma once

#include "geometry/coverage.h"

#include <sensor_msgs/PointCloud2.h>
#include <visualization_msgs/MarkerArray.h>

#include <string>
#include <vector>

namespace wiimote_tracker {

/// Such as "86 % of the volume is seen by two cameras or more; points are known to 12 mm there
/// (median)."
/// @param volume in words
std::string sentenceOf(const std::vector<geometry::CoverageCell>& cells, const std::string& volume);

/// Such as " wiimote_3, turned by 15 degrees to the left and 10 degrees up, would make it 94 %;
/// then calibrate again."
std::string sentenceOf(const geometry::CameraTurn& turn);

/// The cells: red where fewer than two cameras see, else from green (points are known to 5 mm or
/// better) to yellow (50 mm or worse), with the number of `cameras` and the `stddev` [m].
sensor_msgs::PointCloud2 coverageCloud(const std::string& world_frame,
                                       const std::vector<geometry::CoverageCell>& cells);

/// A sentence above the cells.
visualization_msgs::MarkerArray coverageMarkers(const std::string& world_frame,
                                                const std::vector<geometry::CoverageCell>& cells,
                                                double cell_size,
                                                const std::string& sentence);

/// The edges of the volume.
visualization_msgs::MarkerArray volumeMarkers(const std::string& world_frame,
                                              const Eigen::AlignedBox3d& volume);

/// Sentence and cubes of a walk: a cube where the LED was, red where one camera saw it, yellow for
/// two, green for more.
visualization_msgs::MarkerArray walkMarkers(const std::string& world_frame,
                                            const std::vector<geometry::CoverageCell>& walked,
                                            double cell_size,
                                            const std::string& sentence);

}  // namespace wiimote_tracker
