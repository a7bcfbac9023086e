"""Published and true positions of a bag as arrays, and published ones live."""

import itertools

import numpy as np
import rosbag
import rospy
from wiimote_tracker_msgs.msg import TrackedPoint, TrackedPointArray

from wiimote_tracker_bringup import timeseries


class PublishedPoints:
    """Times in seconds since 1970, positions in metres, one row per published point.

    stamp N, position N x 3, stddev N x 3, rays N, residual N [px];
    truth_stamp M, truth_position M x 3;
    latency K [s]: per message on points, from the arrival of its newest image to the recorder;
    age K [s]: of its positions at the recorder, including link and interpolation.
    """

    def __init__(self, points, truths, latencies, ages):
        """points: rows of stamp, x, y, z, sx, sy, sz, rays, residual; truths: stamp, x, y, z."""
        points = np.array(sorted(points), dtype=float).reshape(-1, 9)
        truths = np.array(sorted(truths), dtype=float).reshape(-1, 4)
        self.stamp = points[:, 0]
        self.position = points[:, 1:4]
        self.stddev = points[:, 4:7]
        self.rays = points[:, 7]
        self.residual = points[:, 8]
        self.truth_stamp = truths[:, 0]
        self.truth_position = truths[:, 1:]
        self.latency = np.array(latencies, dtype=float)
        self.age = np.array(ages, dtype=float)

    def between(self, start: float, end: float) -> np.ndarray:
        return (self.stamp >= start) & (self.stamp <= end)

    def truth_at(self, stamps: np.ndarray) -> np.ndarray:
        return timeseries.at(self.truth_stamp, self.truth_position, stamps)


def point_rows(message):
    """Rows of the points seen by at least two cameras."""
    stamp = message.header.stamp.to_sec()
    for point in message.points:
        if point.state == TrackedPoint.TRACKED:
            variance = np.array(point.position_covariance)[[0, 4, 8]]
            yield (stamp, point.position.x, point.position.y, point.position.z,
                   *np.sqrt(variance), point.rays_used, point.residual)


def truth_row(message):
    return (message.header.stamp.to_sec(), message.point.x, message.point.y, message.point.z)


def read_bag(path: str, led: str) -> PublishedPoints:
    """Reads a bag with /points and /simulation/truth/<led>."""
    points, truths, latencies, ages = [], [], [], []
    truth_topic = '/simulation/truth/' + led
    with rosbag.Bag(path) as bag:
        for topic, message, received in bag.read_messages(topics=['/points', truth_topic]):
            if topic == truth_topic:
                truths.append(truth_row(message))
                continue
            points.extend(point_rows(message))
            if not message.latest_arrival.is_zero():
                latencies.append((received - message.latest_arrival).to_sec())
            ages.append((received - message.header.stamp).to_sec())
    return PublishedPoints(points, truths, latencies, ages)


class LiveRecorder:
    """Records points from its construction on."""

    def __init__(self):
        self._points = []
        self.newest_stamp = 0.0  # of the points [s]
        rospy.Subscriber('points', TrackedPointArray, self._on_points, tcp_nodelay=True)

    def _on_points(self, message):
        self._points.extend(point_rows(message))
        if message.points:
            self.newest_stamp = message.header.stamp.to_sec()

    def spread(self, start) -> float:
        """Largest side of the box around the points since then [m]; infinite without points."""
        newest = [row[1:4] for row in
                  itertools.takewhile(lambda row: row[0] >= start, reversed(list(self._points)))]
        return float(np.max(np.ptp(newest, axis=0))) if newest else np.inf
