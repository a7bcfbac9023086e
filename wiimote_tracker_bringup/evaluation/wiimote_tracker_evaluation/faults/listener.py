"""Records what the tracker publishes, the truth, and what the nodes say, as a node of its own."""

import collections
import dataclasses
import time
from typing import Dict, List

import numpy as np

from wiimote_tracker_evaluation.faults.helper import Helper

HISTORY = 400000  # messages of one topic that are kept

# Columns of a window's points.
RECEIPT, STAMP, POSITION, STDDEV = 0, 1, slice(2, 5), 5


@dataclasses.dataclass(eq=False)
class Window:
    """What was received in a time span. Times in seconds since 1970.

    points: a row per TRACKED point: time of receipt, stamp, x, y, z [m], standard deviation [m];
    labels: their names; cameras: the names of those that saw it. truth: per LED rows of stamp,
    x, y, z [m]. said: (time, name, sentence) of warnings and errors on the console and in the
    diagnostics.
    """

    points: np.ndarray
    labels: np.ndarray
    cameras: np.ndarray
    truth: Dict[str, np.ndarray]
    said: List


def joined(windows) -> Window:
    """What several listeners received; none of them hears the others' nodes."""
    truth = {led: np.concatenate([window.truth[led] for window in windows])
             for led in windows[0].truth}
    return Window(
        np.concatenate([window.points for window in windows]),
        np.concatenate([window.labels for window in windows]),
        np.concatenate([window.cameras for window in windows]),
        {led: rows[np.argsort(rows[:, 0])] for led, rows in truth.items()},
        sorted(sentence for window in windows for sentence in window.said))


class Listener(Helper):
    def __init__(self, leds, points='points'):
        """points: topic of the tracker."""
        super().__init__(_record, leds, points)

    def window(self, start, end) -> Window:
        return self.ask((start, end), 120.0)


def _record(pipe, leds, points):
    import rospy
    from diagnostic_msgs.msg import DiagnosticArray
    from geometry_msgs.msg import PointStamped
    from rosgraph_msgs.msg import Log
    received = collections.defaultdict(lambda: collections.deque(maxlen=HISTORY))

    def keep(topic, kind):
        # Messages are read when they are asked for: receiving shall cost little.
        rospy.Subscriber(topic, kind, lambda message: received[topic].append(
            (time.time(), message._buff if kind is rospy.AnyMsg else message)), tcp_nodelay=True)
    keep(points, rospy.AnyMsg)
    keep('/diagnostics', DiagnosticArray)
    keep('/rosout', Log)
    for led in leds:
        keep('simulation/truth/' + led, PointStamped)
    while True:
        start, end = pipe.recv()
        chosen = {topic: [each for each in list(messages) if start <= each[0] < end]
                  for topic, messages in list(received.items())}
        # The newest truth is needed for the newest points, which come before it.
        truth = {led: np.array([(m.header.stamp.to_sec(), m.point.x, m.point.y, m.point.z)
                                for at, m in list(received['simulation/truth/' + led])
                                if start - 12.0 <= at < end + 1.0]).reshape(-1, 4)
                 for led in leds}
        pipe.send(Window(*_points(chosen.get(points, [])), truth, _said(chosen)))


def _points(messages):
    from wiimote_tracker_msgs.msg import TrackedPoint, TrackedPointArray
    rows, labels, cameras = [], [], []
    for at, buffer in messages:
        message = TrackedPointArray().deserialize(buffer)
        stamp = message.header.stamp.to_sec()
        for point in message.points:
            if point.state == TrackedPoint.TRACKED:
                variance = sum(point.position_covariance[::4])
                rows.append((at, stamp, point.position.x, point.position.y, point.position.z,
                             np.sqrt(variance)))
                labels.append(point.label)
                cameras.append(' '.join(point.cameras))
    return np.array(rows, dtype=float).reshape(-1, 6), np.array(labels), np.array(cameras)


def _said(chosen):
    from rosgraph_msgs.msg import Log
    said = [(at, m.name, m.msg) for at, m in chosen.get('/rosout', []) if m.level >= Log.WARN]
    for at, message in chosen.get('/diagnostics', []):
        said += [(at, status.name, status.message) for status in message.status
                 if status.level not in (0, b'\0')]
    return sorted(said)
