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
        begin, _ = self.in_real_time(self.judge, self.named, DURATION, before=BEFORE)
        # Also before all had names, a name that is given must be right.
        first = self.points[0].header.stamp.to_sec()
        if self.kept_real_time(first, begin):
            self.judge_names(first, begin)

    def judge(self, begin, end):
        """Each LED has its name nearly always."""
        outputs = sum(begin <= m.header.stamp.to_sec() <= end for m in list(self.points))
        for led, (stamps, error, named) in self.judge_names(begin, end).items():
            share = len(stamps) / outputs
            self.assertGreater(share, 0.9, led)
            predicted = np.mean([p.state == TrackedPoint.PREDICTED for p in named])
            print('%s: named %.2f s after the first output, in %.1f %% of the time; median error '
                  '%.1f mm, largest %.0f mm; %.1f %% of it predicted; %s' % (
                      led, begin - self.points[0].header.stamp.to_sec(), 100 * share,
                      1e3 * np.median(error), 1e3 * error.max(), 100 * predicted,
                      collections.Counter(p.id for p in named)))
            self.assertTrue(any(begin <= m.header.stamp.to_sec() <= end
                                for m in list(self.single[led])), led)

    def judge_names(self, begin, end):
        """What has the name of an LED is there, in the points and on the LED's own topic.
        @return: stamps [s], errors [m] and points by the LED"""
        found = {}
        for led in self.leds:
            named = [(m.header.stamp.to_sec(), p) for m in list(self.points) for p in m.points
                     if begin <= m.header.stamp.to_sec() <= end and p.label == led
                     and p.state in (TrackedPoint.TRACKED, TrackedPoint.PREDICTED)]
            stamps = [stamp for stamp, _ in named]
            error = self.errors(led, stamps, [p.position for _, p in named])
            self.assertLess(error.max(initial=0.0), ASTRAY, led)
            for _, point in named:
                self.assertGreater(point.label_confidence, 0.5)
                self.assertGreater(point.label_since.to_sec(), 0.0)
            single = [m for m in list(self.single[led])
                      if begin <= m.header.stamp.to_sec() <= end]
            error_of_single = self.errors(led, [m.header.stamp.to_sec() for m in single],
                                          [m.point for m in single])
            self.assertLess(error_of_single.max(initial=0.0), ASTRAY, led)
            found[led] = stamps, error, [p for _, p in named]
        return found

    def errors(self, led, stamps, places):
        """Distances of N places from an LED [m]."""
        places = np.array([(p.x, p.y, p.z) for p in places]).reshape(-1, 3)
        return np.linalg.norm(places - self.truth_at(led, stamps), axis=1)

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
