"""Latency by parts, from exposure to published point: recorded while the full stack runs.

Simulation, driver, tracker and recorder run on one computer with one clock.
"""

import os
import xmlrpc.client

import numpy as np

from wiimote_tracker_bringup import stack
from wiimote_tracker_bringup.errors import Refusal
from wiimote_tracker_bringup.waiting import wait_until

EXPOSURES = '/simulation/exposures'
DEADLINE = 20.0       # for the start of the recorder [s]
ROUNDING = 2e-6       # of times converted to floating point [s]
LONGEST_DRIVER = 0.5  # from a report's delivery to its arrival at the driver [s]


class Trace:
    """Times [s since 1970], one row per published output.

    exposure: true, of the newest image used; delivered: its report reached the virtual device;
    arrived: by the driver's clock; heard: the driver's message reached the recorder, and the
    tracker; published: the point reached the recorder; hop: of the exposure's message from the
    simulation to the recorder [s]. stamp, position: of the LED's point. exposures, deliveries: of
    all images of all cameras, sorted by exposure, including images that were overtaken and gave no
    point.
    """

    def __init__(self, rows, images, triggered):
        rows = np.array(sorted(rows, key=lambda row: row[3]), dtype=float).reshape(-1, 10)
        (self.exposure, self.delivered, self.arrived, self.published, self.heard, self.hop,
         self.stamp) = rows[:, :7].T
        self.position = rows[:, 7:10]
        self.exposures, self.deliveries = np.array(sorted(images), dtype=float).reshape(-1, 2).T
        self.triggered = triggered  # position of the LED by time of the trigger

    def between(self, start, end):
        """Mask of the outputs published in a time span."""
        return (self.published >= start) & (self.published < end)

    def parts(self, chosen):
        """Duration from exposure to published point and its parts, one row per chosen output [s];
        each part is the difference of two recorded times."""
        return {'total': (self.published - self.exposure)[chosen],
                'bluetooth': (self.delivered - self.exposure)[chosen],
                'driver': (self.arrived - self.delivered)[chosen],
                'image': (self.heard - self.arrived)[chosen],
                'point': (self.published - self.heard)[chosen]}

    def waiting(self):
        """Mean time from a random instant to the next exposure of any camera [s]."""
        gaps = np.diff(self.exposures)
        return float((gaps ** 2).sum() / (2.0 * gaps.sum()))


class Recorder:
    """Records the contents of a Trace from its construction until read()."""

    def __init__(self, run, cameras, name):
        self._path = run.file(name + '.bag')
        self._cameras = cameras
        topics = ['/points', '/triggered_points', EXPOSURES] + [
            f'/{camera}/ir_blobs' for camera in cameras]
        self._process = stack.record(run.folder, self._path, *topics)
        wait_until_connected('/record', topics)

    def read(self):
        stack.end(self._process)
        try:
            return read_trace(self._path, self._cameras)
        finally:
            os.remove(self._path)


def wait_until_connected(node, topics):
    """Waits until the node whose name begins so is connected to a publisher of each topic."""
    import rosgraph
    master = rosgraph.Master('/evaluation')
    wait_until(lambda: connected_topics(master, node).issuperset(topics), DEADLINE,
               f'the recorder did not begin within {DEADLINE:.0f} s', stack.check)


def connected_topics(master, node):
    """Topics that reach a node; only the node itself knows from whom messages already come."""
    names = {name for _, subscribers in master.getSystemState()[1] for name in subscribers
             if name.startswith(node)}
    connections = [connection for name in names for connection in xmlrpc.client.ServerProxy(
        master.lookupNode(name)).getBusInfo('/evaluation')[2]]
    return {topic for _, _, direction, _, topic, is_connected in
            (connection[:6] for connection in connections) if direction == 'i' and is_connected}


def read_trace(path, cameras):
    """Trace of a bag."""
    import rosbag
    delivered = {camera: [] for camera in cameras}  # rows: delivered, exposure, hop
    arrivals, points, triggered, images = [], [], {}, []
    with rosbag.Bag(path) as bag:
        for topic, message, received in bag.read_messages():
            received = received.to_sec()
            if topic == EXPOSURES:
                handed = message.arrival.to_sec()
                delivered[message.camera].append((handed, message.header.stamp.to_sec(),
                                                  received - handed))
                images.append((message.header.stamp.to_sec(), handed))
            elif topic == '/points':
                points.append((message, received))
            elif topic == '/triggered_points':
                position = first_position(message)
                if position is not None:
                    triggered[message.header.stamp.to_nsec()] = position
            else:
                arrivals.append((message.arrival.to_sec(), message.camera, received))
    rows = matched(points, sorted(arrivals), {
        camera: np.array(sorted(reports)).reshape(-1, 3) for camera, reports in delivered.items()})
    if not rows:
        raise Refusal('no point was published while the LED was measured; see nodes.log')
    return Trace(rows, images, triggered)


def matched(points, arrivals, delivered):
    """Rows of a Trace. Images, exposures and points are matched by their times."""
    arrival_times = np.array([when for when, _, _ in arrivals])
    rows = []
    for message, published in points:
        position = first_position(message)
        arrived = message.latest_arrival.to_sec()
        image = np.searchsorted(arrival_times, arrived - ROUNDING)
        if position is None or image == len(arrivals) or arrivals[image][0] > arrived + ROUNDING:
            continue
        reports = delivered[arrivals[image][1]]
        index = np.searchsorted(reports[:, 0], arrived, side='right') - 1
        if index < 0 or arrived - reports[index, 0] > LONGEST_DRIVER:
            continue
        handed, exposure, hop = reports[index]
        rows.append((exposure, handed, arrived, published, arrivals[image][2], hop,
                     message.header.stamp.to_sec()) + position)
    return rows


def first_position(message):
    """Position of the first LED that is seen, or None."""
    from wiimote_tracker_msgs.msg import TrackedPoint
    for point in message.points:
        if point.state == TrackedPoint.TRACKED:
            return (point.position.x, point.position.y, point.position.z)
    return None
