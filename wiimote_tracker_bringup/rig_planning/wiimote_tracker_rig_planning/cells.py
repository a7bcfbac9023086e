"""The coverage of a plan as the point cloud that rviz shows."""

import numpy as np
from sensor_msgs import point_cloud2
from sensor_msgs.msg import PointCloud2, PointField
from std_msgs.msg import Header

FIELDS = ('x', 'y', 'z', 'rgb', 'cameras', 'stddev')
GOOD, BAD = 0.005, 0.05  # standard deviations that are green and yellow [m]


def cloud(frame, points, cameras, stddev) -> PointCloud2:
    """As of the node `coverage`. points: M x 3; cameras, stddev: M, NaN (red) where not located."""
    known = ~np.isnan(stddev)
    share = np.log(np.where(known, stddev, BAD) / GOOD) / np.log(BAD / GOOD)
    red = (255.0 * np.clip(share, 0.0, 1.0)).astype(np.uint32)
    colors = np.where(known, red << 16 | 0xcc33, 0xe63333).astype(np.uint32)
    bits = colors.view(np.float32)
    return point_cloud2.create_cloud(
        Header(frame_id=frame),
        [PointField(name, 4 * index, PointField.FLOAT32, 1) for index, name in enumerate(FIELDS)],
        np.column_stack([points, bits, cameras, stddev]))
