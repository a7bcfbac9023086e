"""The coverage of a plan as the point cloud that rviz shows."""

import numpy as np
from sensor_msgs.msg import PointCloud2, PointField

FIELDS = ('x', 'y', 'z', 'rgb', 'cameras', 'stddev')
GOOD, BAD = 0.005, 0.05  # standard deviations that are green and yellow [m]


def cloud(frame, points, cameras, stddev) -> PointCloud2:
    """As of the node `coverage`. points: M x 3; cameras, stddev: M, NaN (red) where not located."""
    known = ~np.isnan(stddev)
    share = np.log(np.where(known, stddev, BAD) / GOOD) / np.log(BAD / GOOD)
    red = (255.0 * np.clip(share, 0.0, 1.0)).astype(np.uint32)
    colors = np.where(known, red << 16 | 0xcc33, 0xe63333).astype(np.uint32)
    values = np.column_stack([points, np.zeros(len(points)), cameras, stddev]).astype('<f4')
    values[:, 3] = colors.view(np.float32)  # the bits, not the value
    message = PointCloud2(height=1, width=len(points), point_step=4 * len(FIELDS), is_dense=False,
                          data=values.tobytes())
    message.header.frame_id = frame
    message.row_step = len(message.data)
    message.fields = [PointField(name, 4 * index, PointField.FLOAT32, 1)
                      for index, name in enumerate(FIELDS)]
    return message
