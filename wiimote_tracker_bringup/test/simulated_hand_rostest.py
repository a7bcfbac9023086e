#!/usr/bin/env python3
"""The simulated hand calibrates the rig, turns its LED off beside a body, and goes where a person's
calibration wants. Bodies are dark meanwhile, and move on."""

import sys

import numpy as np
import rospy
import rostest
from geometry_msgs.msg import Point, PointStamped, PoseStamped, PoseWithCovarianceStamped
from live_rig import DEADLINE, NodeTest
from std_srvs.srv import Trigger
from wiimote_tracker_msgs.msg import (CalibrationStatus, IrBlobArray, TrackedPoint,
                                      TrackedPointArray)
from wiimote_tracker_msgs.srv import (CheckPlace, RecalibrateCamera, SetLed, SetLedRequest,
                                      SolveCalibration, StartCalibration)

MANY = 1000  # four seconds
DARK = 4.0  # [s]; beside four other LEDs a fifth is not seen for up to 2 s
WAVES = 3  # until one is solved


def vector(v):
    return np.array([v.x, v.y, v.z])


def position(message):
    return vector(message.point)


class SimulatedHand(NodeTest):
    def wait_until_dark(self):
        """Until no LED is tracked beside the body for a while."""
        def is_dark():
            counts = []
            subscriber = rospy.Subscriber('points', TrackedPointArray, lambda m: counts.append(
                sum(p.state == TrackedPoint.TRACKED for p in m.points)))
            rospy.sleep(DARK)
            subscriber.unregister()
            return counts and not any(counts)
        self.wait(is_dark, 'the hand to turn its LED off')

    def solved_by_wand(self):
        """The answer of calibration/solve. It may ask for another wave, since a camera's clock
        jumps where a busy computer halts the simulation."""
        for _ in range(WAVES):
            statuses = []
            subscriber = rospy.Subscriber('calibration/status', CalibrationStatus, statuses.append)
            started = rospy.ServiceProxy('calibration/start', StartCalibration)(
                without_square=True, wand_length=0.5)
            self.assertTrue(started.success, started.message)
            # The first one may be from before the start, and want to solve the wave before.
            self.wait(lambda: any(status.next_request != 'solve' for status in statuses),
                      'the calibration to start')
            self.wait(lambda: statuses and statuses[-1].next_request == 'solve',
                      'a wand that was laid down and waved')
            subscriber.unregister()
            solved = rospy.ServiceProxy('calibration/solve', SolveCalibration)()
            if solved.success or 'wave again' not in solved.message:
                break
            self.assertTrue(rospy.ServiceProxy('calibration/cancel', Trigger)().success)
        return solved

    def test_poses_come_by_themselves_and_the_hand_follows_a_calibration(self):
        bodies = []
        rospy.Subscriber('simulation/truth/wand', PoseStamped, bodies.append)
        poses = []
        rospy.Subscriber('wand/pose', PoseWithCovarianceStamped, poses.append)
        self.wait(lambda: len(poses) > MANY, 'the tracked body')
        self.wait(lambda: bodies[-1].header.stamp > poses[-1].header.stamp, 'the truth')
        known = list(bodies)  # more arrive meanwhile
        stamps = [truth.header.stamp.to_sec() for truth in known]
        at = [pose.header.stamp.to_sec() for pose in poses[:MANY]]
        truth = np.transpose([np.interp(at, stamps, axis) for axis in np.transpose(
            [vector(truth.pose.position) for truth in known])])
        errors = np.linalg.norm([vector(pose.pose.pose.position) for pose in poses[:MANY]] - truth,
                                axis=1)
        # Simulated corners are exact; what is left is the lens' starting value and noise.
        self.assertLess(np.median(errors), 0.03)
        self.wait_until_dark()
        truths = []
        rospy.Subscriber('simulation/truth/led', PointStamped, truths.append)

        rospy.wait_for_service('calibration/start', DEADLINE)
        started = rospy.ServiceProxy('calibration/start', StartCalibration)(
            side_x=2.5, side_y=0.0, cameras=[])
        self.assertTrue(started.success, started.message)
        self.wait(lambda: truths and np.allclose(position(truths[-1]), 0.0),
                  'the LED at the first corner')
        # By stamps: images from before may still be on their way.
        there = truths[-1].header.stamp
        images = []

        def take(message):
            if message.header.stamp > there:
                images.append(len(message.blobs))
        rospy.Subscriber('wiimote_1/ir_blobs', IrBlobArray, take)
        self.wait(lambda: len(images) > 10, 'images')
        self.assertLess(max(images), 2, 'the LEDs of the body are lit')

        self.assertTrue(rospy.ServiceProxy('calibration/cancel', Trigger)().success)
        self.wait(lambda: images[-1] > 1, 'the LEDs of the body')
        places = []
        rospy.Subscriber('simulation/truth/wand', PoseStamped,
                         lambda m: places.append([m.pose.position.x, m.pose.position.y]))
        self.wait(lambda: places and np.linalg.norm(np.subtract(places[-1], places[0])) > 0.05,
                  'the body to move on')

        solved = self.solved_by_wand()
        self.assertTrue(solved.success, solved.message)
        self.assertEqual(solved.rig.method, 'floor+wand')
        self.assertEqual(len(solved.rig.cameras), 4)
        for camera in solved.rig.cameras:
            self.assertAlmostEqual(camera.world_from_camera.position.z, 2.0, delta=0.15)

    def test_the_hand_leaves_the_led_on_a_checked_place_and_waves_it_for_one_camera(self):
        statuses = []
        rospy.Subscriber('calibration/status', CalibrationStatus, statuses.append)
        self.wait(lambda: statuses and statuses[-1].rig_id and statuses[-1].step in (
            CalibrationStatus.IDLE, CalibrationStatus.SOLVED, CalibrationStatus.SAVED), 'a rig')
        truths = []
        rospy.Subscriber('simulation/truth/led', PointStamped, truths.append)

        self.wait_until_dark()
        place = Point(1.0, 1.0, 1.0)
        put = rospy.ServiceProxy('simulation/set_led', SetLed)(
            SetLedRequest(led='led', on=True, motion=SetLedRequest.LINE, target=place))
        self.wait(lambda: rospy.get_rostime() > put.arrival, 'the LED to arrive')
        check = rospy.ServiceProxy('calibration/check', CheckPlace)
        check(known=place)
        measured = rospy.get_rostime() + rospy.Duration(1.0)
        self.wait(lambda: truths[-1].header.stamp > measured, 'the truth')
        self.assertTrue(np.allclose(position(truths[-1]), 1.0), 'the hand took the LED away')

        heights = []
        rospy.Subscriber('simulation/truth/led', PointStamped,
                         lambda m: heights.append(m.point.z))
        rospy.ServiceProxy('calibration/recalibrate_camera', RecalibrateCamera)(
            camera='wiimote_1', duration=5.0)
        self.assertGreater(max(heights) - min(heights), 0.2, 'the hand did not wave')


if __name__ == '__main__':
    rospy.init_node('simulated_hand_rostest')
    sys.exit(rostest.rosrun('wiimote_tracker_bringup', 'simulated_hand_test', SimulatedHand))
