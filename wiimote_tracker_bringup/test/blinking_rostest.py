#!/usr/bin/env python3
"""Four LEDs on two people blink: each is published under its own name, and no other LED's."""

import collections
import math
import sys

import numpy as np
import rospy
import rostest
from geometry_msgs.msg import PointStamped
from live_rig import LiveRigTest
from wiimote_tracker_msgs.msg import TrackedPoint

DURATION = 5.0   # evaluated [s]
BEFORE = 2.0     # a name is given by what was seen for so long [s]
ASTRAY = 0.1     # largest error of a point; the LEDs are farther apart [m]


class Blinking(LiveRigTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.single = {led: [] for led in cls.leds}
        for led in cls.leds:
            rospy.Subscriber(led + '/point', PointStamped, cls.single[led].append)

    def test_each_led_has_its_own_name(self):
        self.calibrate()
        begin, end = self.in_real_time(self.named, DURATION, before=BEFORE)
        points = list(self.points)
        # Includes the time before all had names, unless the simulation stood still then: a name
        # that is given must be right.
        first = points[0].header.stamp.to_sec()
        since = first if self.kept_real_time(first, begin) else begin
        judged = [m for m in points if since <= m.header.stamp.to_sec() <= end]
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
                      led, stamps[0] - first, 100 * share,
                      1e3 * np.median(error), 1e3 * error.max(), 100 * np.mean(~seen),
                      collections.Counter(p.id for _, p in named)))
            self.assertLess(error.max(), ASTRAY, led)
            self.assertGreater(share, 0.9, led)
            for _, point in named:
                self.assertGreater(point.label_confidence, 0.5)
                self.assertGreater(point.label_since.to_sec(), 0.0)
            self.check_single(led, since, end)

    def check_single(self, led, begin, end):
        """The topic of one LED has that LED's points."""
        points = [m for m in list(self.single[led]) if begin <= m.header.stamp.to_sec() <= end]
        self.assertTrue(points, led)
        places = np.array([(m.point.x, m.point.y, m.point.z) for m in points])
        truth = self.truth_at(led, [m.header.stamp.to_sec() for m in points])
        self.assertLess(np.linalg.norm(places - truth, axis=1).max(), ASTRAY, led)

    def named(self):
        """The time [s] when all LEDs have their names."""
        self.wait(self.all_are_named, 'the names of four LEDs')
        return self.points[-1].header.stamp.to_sec()

    def all_are_named(self):
        return self.points and {
            p.label for p in self.points[-1].points
            if not math.isnan(p.label_confidence)} >= set(self.leds)


if __name__ == '__main__':
    sys.exit(rostest.rosrun('wiimote_tracker_bringup', 'blinking', Blinking))
