#!/usr/bin/env python3
"""Four LEDs on two people blink: each is published under its own name, and never under another's."""

import collections
import math
import sys
import unittest

import numpy as np
import rospy
import rostest
import yaml
from geometry_msgs.msg import PointStamped
from wiimote_tracker_evaluation import scene, true_rig
from wiimote_tracker_msgs.msg import (IrBlobArray, RigCalibration, TrackedPoint, TrackedPointArray)

DEADLINE = 60.0  # [s]
DURATION = 5.0   # that is judged [s]
ASTRAY = 0.1     # farther from its LED no point is: the LEDs are farther apart [m]


class Blinking(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node('blinking_rostest')
        path = rospy.get_param('~description')
        cls.scene = scene.read_scene(path)
        with open(path) as file:
            cls.description = yaml.safe_load(file)
        cls.leds = sorted(cls.description['leds'])
        cls.truth = collections.defaultdict(list)
        cls.single = collections.Counter()
        cls.images = set()
        cls.points = []
        for led in cls.leds:
            rospy.Subscriber('simulation/truth/' + led, PointStamped, cls.truth[led].append)
            rospy.Subscriber(led + '/point', PointStamped,
                             lambda _, name=led: cls.single.update([name]))
        for camera in cls.scene.cameras:
            rospy.Subscriber(camera.name + '/ir_blobs', IrBlobArray,
                             lambda _, name=camera.name: cls.images.add(name))
        rospy.Subscriber('points', TrackedPointArray, cls.points.append, queue_size=1000,
                         tcp_nodelay=True)
        cls.rig_publisher = rospy.Publisher('calibration/rig', RigCalibration, queue_size=1,
                                            latch=True)

    def wait(self, condition, what):
        deadline = rospy.get_time() + DEADLINE
        while not condition():
            self.assertLess(rospy.get_time(), deadline, 'waited too long for ' + what)
            rospy.sleep(0.05)

    def test_each_led_has_its_own_name(self):
        self.wait(lambda: len(self.images) == len(self.scene.cameras), 'images of all cameras')
        self.rig_publisher.publish(true_rig.true_rig(self.scene, {
            name: camera['identity'] for name, camera in self.description['cameras'].items()}))
        self.wait(self.all_are_named, 'the names of four LEDs')
        begin = self.points[-1].header.stamp.to_sec()
        end = begin + DURATION
        self.wait(lambda: self.points[-1].header.stamp.to_sec() > end, 'tracked points')
        self.wait(lambda: all(self.truth[led][-1].header.stamp.to_sec() > end
                              for led in self.leds), 'the truth')

        points = list(self.points)
        judged = [m for m in points if m.header.stamp.to_sec() <= end]
        outputs = sum(m.header.stamp.to_sec() >= begin for m in judged)
        for led in self.leds:
            named = [(m.header.stamp.to_sec(), p) for m in judged for p in m.points
                     if p.label == led and p.state in (TrackedPoint.TRACKED,
                                                       TrackedPoint.PREDICTED)]
            stamps = np.array([stamp for stamp, _ in named])
            seen = np.array([p.state == TrackedPoint.TRACKED for _, p in named])
            places = np.array([(p.position.x, p.position.y, p.position.z) for _, p in named])
            error = np.linalg.norm(places - self.truth_at(led, stamps), axis=1)
            share = np.sum(stamps >= begin) / outputs
            print('%s: named %.2f s after the first output, then %.1f %% of the time; median '
                  'error %.1f mm, largest %.0f mm; %.1f %% of it predicted; %s' % (
                      led, stamps[0] - points[0].header.stamp.to_sec(), 100 * share,
                      1e3 * np.median(error), 1e3 * error.max(), 100 * np.mean(~seen),
                      collections.Counter(p.id for _, p in named)))
            # Also of the time before all had names: one that is given is right.
            self.assertLess(error.max(), ASTRAY, led)
            self.assertGreater(share, 0.9, led)
            for _, point in named:
                self.assertGreater(point.label_confidence, 0.5)
                self.assertGreater(point.label_since.to_sec(), 0.0)
            self.assertGreater(self.single[led], 0)

    def all_are_named(self):
        return self.points and {
            p.label for p in self.points[-1].points
            if not math.isnan(p.label_confidence)} >= set(self.leds)

    def truth_at(self, led, stamps):
        messages = list(self.truth[led])
        times = [m.header.stamp.to_sec() for m in messages]
        places = np.array([(m.point.x, m.point.y, m.point.z) for m in messages])
        return np.stack([np.interp(stamps, times, places[:, axis]) for axis in range(3)], axis=1)


if __name__ == '__main__':
    sys.exit(rostest.rosrun('wiimote_tracker_bringup', 'blinking', Blinking))
