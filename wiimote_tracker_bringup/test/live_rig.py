"""Shared by the tests with virtual Wii Remotes: the rig's description, its truth, and a deadline
for every wait."""

import collections
import unittest

import numpy as np
import rospy
from geometry_msgs.msg import PointStamped
from wiimote_tracker_evaluation import rigs, scene
from wiimote_tracker_evaluation.true_rig import true_rig
from wiimote_tracker_msgs.msg import IrBlobArray, RigCalibration, TrackedPointArray

DEADLINE = 90.0  # [s]


class NodeTest(unittest.TestCase):
    """Waits for what nodes do."""

    def wait(self, condition, what):
        deadline = rospy.get_time() + DEADLINE
        while not condition():
            self.assertLess(rospy.get_time(), deadline, 'waited too long for ' + what)
            rospy.sleep(0.01)


class LiveRigTest(NodeTest):
    """Listens to the nodes on the simulated rig of the file ~description."""

    @classmethod
    def setUpClass(cls):
        rospy.init_node(cls.__name__.lower() + '_rostest')
        cls.path = rospy.get_param('~description')
        cls.description = rigs.read(cls.path)
        cls.scene = scene.read_scene(cls.path)
        cls.leds = sorted(cls.description['leds'])
        cls.images = collections.Counter()
        cls.truth = {led: [] for led in cls.leds}
        cls.points = []
        for camera in cls.scene.cameras:
            rospy.Subscriber(camera.name + '/ir_blobs', IrBlobArray,
                             lambda _, name=camera.name: cls.images.update([name]))
        for led in cls.leds:
            rospy.Subscriber('simulation/truth/' + led, PointStamped, cls.truth[led].append)
        rospy.Subscriber('points', TrackedPointArray, cls.points.append, queue_size=1000,
                         tcp_nodelay=True)
        cls.rig_publisher = rospy.Publisher('calibration/rig', RigCalibration, queue_size=1,
                                            latch=True)

    def calibrate(self, masks=()):
        """Waits until all cameras deliver images and gives the tracker the true rig.
        @param masks: pairs of a camera's name and an IrMask."""
        self.wait(lambda: len(self.images) == len(self.scene.cameras), 'images of all cameras')
        rig = true_rig(self.path)
        for camera in rig.cameras:
            camera.masks.extend(mask for name, mask in masks if name == camera.name)
        self.rig_publisher.publish(rig)

    def wait_until(self, time):
        """Waits until there are points and truth of that time [s]."""
        for messages in [self.points] + list(self.truth.values()):
            self.wait(lambda: messages and messages[-1].header.stamp.to_sec() > time,
                      f'the instant {time:.3f}')

    def truth_at(self, led, stamps):
        """N x 3 true positions at N times."""
        messages = list(self.truth[led])
        times = [m.header.stamp.to_sec() for m in messages]
        places = np.array([(m.point.x, m.point.y, m.point.z) for m in messages])
        return np.stack([np.interp(stamps, times, places[:, axis]) for axis in range(3)], axis=1)
