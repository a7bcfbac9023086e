#!/usr/bin/env python3
"""A body with an IMU: its topics go on while it is hidden, and are silent once the IMU pauses."""

import unittest

import numpy as np
import rospy
from geometry_msgs.msg import Vector3
from nav_msgs.msg import Odometry
from sensor_msgs.msg import Imu
from wiimote_tracker_msgs.msg import IrBlobArray, RigCalibration, TrackedBody, TrackedBodyArray

from bodies_rostest import LEDS, NOWHERE, pose, vector  # also makes recording known
import recording
from live import wait_for

PLACE = np.array([0.02, 0.01, 0.04])  # wand_with_imu.yaml
TURN = np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1]])  # body_from_imu
OFFSET = 0.25
BRIDGED = (2.0, 2.4)  # hidden [s]
PAUSE = 2.9           # of the IMU
HIDDEN = (3.3, 3.7)
SILENT_AFTER = 0.05   # the last sight
END = 4.0
AHEAD = 0.5           # samples are sent before the images, so that none can be too late


def led(number):
    def way(t):
        if BRIDGED[0] <= t < BRIDGED[1] or HIDDEN[0] <= t < HIDDEN[1]:
            return NOWHERE
        rotation, position = pose(t)
        return rotation @ LEDS[number] + position
    return way


def sample(t):
    """What the IMU measures, by differences."""
    h = 1e-3
    (before, p), (rotation, q), (after, r) = (pose(t + step) for step in (-h, 0.0, h))
    acceleration = (before @ PLACE + p - 2 * (rotation @ PLACE + q) + after @ PLACE + r) / h ** 2
    turning = rotation.T @ (after - before) / (2 * h)
    rate = np.array([turning[2, 1], turning[0, 2], turning[1, 0]])
    force = rotation.T @ (acceleration + [0, 0, 9.80665])
    message = Imu(angular_velocity=Vector3(*(TURN.T @ rate)),
                  linear_acceleration=Vector3(*(TURN.T @ force)))
    message.header.stamp = recording.time_of(t - OFFSET)
    return message


def have_come(bodies, image):
    """The bodies after this image; times went through floating point."""
    return bodies and (image.arrival - bodies[-1].latest_arrival).to_sec() < 1e-6


class Inertial(unittest.TestCase):
    def hear(self, topic, kind):
        heard = []
        subscriber = rospy.Subscriber(topic, kind, heard.append, tcp_nodelay=True)
        wait_for(lambda: subscriber.get_num_connections() > 0, topic)
        return heard

    def test_goes_on_while_hidden(self):
        rospy.init_node('inertial_rostest')
        bodies = self.hear('/bodies', TrackedBodyArray)
        odometry = self.hear('/wand/odometry', Odometry)
        images = {name: rospy.Publisher(f'/{name}/ir_blobs', IrBlobArray, queue_size=1000)
                  for name in recording.NAMES}
        imu = rospy.Publisher('/wand_imu', Imu, queue_size=1000)
        rig = rospy.Publisher('/calibration/rig', RigCalibration, latch=True, queue_size=1)
        rig.publish(recording.rig())
        for publisher in (*images.values(), imu):
            wait_for(lambda: publisher.get_num_connections() > 0, publisher.resolved_name)
        samples = [sample(t) for t in np.arange(0.0, PAUSE, 0.01)]
        for image in recording.images(END, [led(i) for i in range(3)]):
            ahead = image.header.stamp + rospy.Duration(AHEAD - OFFSET)
            while samples and samples[0].header.stamp <= ahead:
                imu.publish(samples.pop(0))
            images[image.camera].publish(image)
            wait_for(lambda: have_come(bodies, image), 'bodies')
        wait_for(lambda: odometry[-1].header.stamp == bodies[-1].header.stamp, 'odometry')
        self.check_bridged(bodies, odometry)
        self.check_silent(bodies, odometry)

    def between(self, messages, begin, end):
        return [m for m in messages if begin <= recording.seconds_of(m.header.stamp) < end]

    def check_bridged(self, bodies, odometry):
        heard = self.between(odometry, BRIDGED[0] + SILENT_AFTER, BRIDGED[1])
        self.assertGreater(len(heard), 100)
        for message in heard:
            _, position = pose(recording.seconds_of(message.header.stamp))
            found = message.pose.pose.position
            self.assertLess(np.linalg.norm(vector(found) - position), 0.02)
        states = {body.state for array in self.between(
            bodies, BRIDGED[0] + SILENT_AFTER, BRIDGED[1]) for body in array.bodies}
        self.assertEqual(states, {TrackedBody.PREDICTED})

    def check_silent(self, bodies, odometry):
        self.assertEqual(self.between(odometry, HIDDEN[0] + SILENT_AFTER, HIDDEN[1]), [])
        self.assertTrue(self.between(bodies, HIDDEN[0] + SILENT_AFTER, HIDDEN[1]))
        self.assertTrue(self.between(odometry, HIDDEN[1] + 0.1, END))


if __name__ == '__main__':
    import rostest
    rostest.rosrun('wiimote_tracker_triangulation', 'inertial', Inertial)
