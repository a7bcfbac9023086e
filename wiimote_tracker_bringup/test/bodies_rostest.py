#!/usr/bin/env python3
"""A rigid body through drivers and tracker: its pose agrees with the simulation, also with an LED
hidden, and it is found again soon after all were hidden."""

import collections
import sys

import numpy as np
import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseStamped
from live_rig import DEADLINE, LiveRigTest
from nav_msgs.msg import Odometry
from scipy.spatial.transform import Rotation
from wiimote_tracker_msgs.msg import TrackedBody, TrackedBodyArray
from wiimote_tracker_msgs.srv import SetLed, SetLedRequest

JUDGED = 3.0     # [s]
SETTLE = 2.0     # [s]
HIDDEN = 0.8     # longer than a body is predicted [s]
RECOVERY = 0.2   # [s]
SILENT_AFTER = 0.05  # the last sight [s]
LEDS = [f'wand_{i}' for i in range(4)]
CHI_SQUARED_999, CHI_SQUARED_001 = 22.46, 0.38  # 99.9 % and 0.1 % quantiles, six degrees of freedom


def vector(v):
    return np.array([v.x, v.y, v.z])


def rotation(q):
    return Rotation.from_quat([q.x, q.y, q.z, q.w])


class Bodies(LiveRigTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.poses, cls.bodies = [], []
        rospy.Subscriber('simulation/truth/wand', PoseStamped, cls.poses.append)
        rospy.Subscriber('bodies', TrackedBodyArray, cls.bodies.append, queue_size=1000,
                         tcp_nodelay=True)
        cls.odometries, cls.statuses = [], []
        rospy.Subscriber('wand/odometry', Odometry, cls.odometries.append, queue_size=1000)
        rospy.Subscriber('/diagnostics', DiagnosticArray, lambda m: cls.statuses.extend(
            s for s in m.status if s.name.endswith(('body wand', ': triangulation'))))
        rospy.wait_for_service('simulation/set_led', DEADLINE)
        cls.set_led = rospy.ServiceProxy('simulation/set_led', SetLed)

    def switch(self, leds, on):
        """@returns the time when the last of them was switched."""
        for led in leds:
            answer = self.set_led(SetLedRequest(led=led, on=on, motion=SetLedRequest.HOLD))
            self.assertTrue(answer.success, answer.message)
        return answer.arrival.to_sec()

    def wait_until(self, time):
        """Also until there are bodies and poses of that time [s]."""
        super().wait_until(time)
        for messages in (self.bodies, self.poses):
            self.wait(lambda: messages and messages[-1].header.stamp.to_sec() > time,
                      f'the instant {time:.3f}')

    def seen_between(self, begin, end):
        """Each array's time, and the wand or None."""
        return [(array.header.stamp.to_sec(), array.bodies[0] if array.bodies else None)
                for array in list(self.bodies) if begin <= array.header.stamp.to_sec() < end]

    def judge(self, begin, end):
        """Checks that the body is tracked nearly always, with consistent errors."""
        seen = self.seen_between(begin, end)
        tracked = [(t, b) for t, b in seen if b and b.state == TrackedBody.TRACKED]
        self.assertGreater(len(tracked), 0.98 * len(seen))
        truth = list(self.poses)
        stamps = np.array([t.header.stamp.to_sec() for t in truth])
        squared, positions, rotations = [], [], []
        for t, body in tracked:
            i = np.searchsorted(stamps, t)
            nearest = truth[i if stamps[i] - t < t - stamps[i - 1] else i - 1]
            # The motion since the nearest sample of the truth.
            step = t - nearest.header.stamp.to_sec()
            position = vector(body.pose.pose.position) - vector(nearest.pose.position) - \
                step * vector(body.twist.twist.linear)
            # About the world's axes.
            turn = (rotation(body.pose.pose.orientation)
                    * rotation(nearest.pose.orientation).inv()).as_rotvec() - \
                step * vector(body.twist.twist.angular)
            error = np.concatenate([position, turn])
            covariance = np.array(body.pose.covariance).reshape(6, 6)
            squared.append(error @ np.linalg.solve(covariance, error))
            positions.append(position @ position)
            rotations.append(turn @ turn)
        print('%d poses: %.2f mm, %.2f deg, median of the normalised squared error %.2f '
              '(5.35 when consistent)' % (
                  len(tracked), 1e3 * np.sqrt(np.mean(positions)),
                  np.degrees(np.sqrt(np.mean(rotations))), np.median(squared)))
        # The covariance ignores quantised pixels, merged spots and errors of stamps.
        self.assertLess(np.median(squared), CHI_SQUARED_999)
        self.assertGreater(np.median(squared), CHI_SQUARED_001)
        self.assertLess(np.degrees(np.sqrt(max(rotations))), 20.0, 'LEDs were confused')

    def wait_for_sentence(self, sentence):
        """The diagnostics say each second what is so by then."""
        self.wait(lambda: [s.message for s in self.statuses
                           if s.name.endswith('triangulation')][-1:] == [sentence], sentence)

    def settled(self):
        """The time [s] when the drivers' clocks have settled."""
        self.wait(lambda: self.bodies and self.bodies[-1].bodies, 'the body')
        return self.bodies[-1].header.stamp.to_sec() + SETTLE

    def one_hidden(self):
        """The time [s] when the images show that an LED is hidden."""
        return self.switch(LEDS[2:3], False) + 0.1

    def found_again(self):
        """The time [s] when a body whose LEDs have all been hidden must have been found again."""
        self.switch(LEDS, False)
        self.wait(lambda: not self.bodies[-1].bodies, 'the body to be lost')
        return self.switch(LEDS, True) + RECOVERY

    def test_pose(self):
        self.calibrate()
        self.in_real_time(self.judge, self.settled, JUDGED, before=SETTLE)
        self.wait_for_sentence('no LED is tracked singly')

        period = self.in_real_time(self.judge, self.one_hidden, 1.0, before=0.1)
        self.assertTrue(any(not b.leds[2].cameras for _, b in self.seen_between(*period) if b))

        dark = self.switch(LEDS, False)
        before = len(self.statuses)
        self.wait(lambda: any('not seen for' in s.message for s in self.statuses[before:]),
                  'a warning')
        self.wait_until(dark + HIDDEN)
        self.assertLess(self.odometries[-1].header.stamp.to_sec(), dark + SILENT_AFTER)
        self.assertIsNone(self.seen_between(dark, dark + HIDDEN)[-1][1], 'it was lost')
        self.wait_for_sentence('no LED is seen')
        states = collections.Counter(
            b.state for _, b in self.seen_between(dark, dark + HIDDEN) if b)
        self.assertEqual(states[TrackedBody.LOST], 1)
        self.in_real_time(self.judge, self.found_again, 1.0, before=RECOVERY)


if __name__ == '__main__':
    sys.exit(rostest.rosrun('wiimote_tracker_bringup', 'bodies', Bodies))
