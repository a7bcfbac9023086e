#ifndef WIIMOTE_TRACKER_BRINGUP_RVIZ_PANEL_COVERAGE_LAYER_H
#define WIIMOTE_TRACKER_BRINGUP_RVIZ_PANEL_COVERAGE_LAYER_H

#include <sensor_msgs/PointCloud2.h>

namespace wiimote_tracker::panel {

/// Least distance of neighbours along an axis [m]; infinity: none.
float cellSizeOf(const sensor_msgs::PointCloud2& cells);

/// The points of the horizontal layer that is nearest to a height [m].
sensor_msgs::PointCloud2 layerAt(const sensor_msgs::PointCloud2& cells, float height);

}  // namespace wiimote_tracker::panel

#endif  // WIIMOTE_TRACKER_BRINGUP_RVIZ_PANEL_COVERAGE_LAYER_H
