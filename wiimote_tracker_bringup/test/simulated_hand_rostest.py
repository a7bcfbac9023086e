#!/usr/bin/env python3
"""The simulated hand calibrates the rig, walks about, and goes where a person's calibration wants.
Bodies are dark meanwhile, and move on."""

import sys

import numpy as np
import rospy
import rostest
from geometry_msgs.msg import Point, PointStamped, PoseStamped
from live_rig import DEADLINE, NodeTest
from std_srvs.srv import Trigger
from wiimote_tracker_msgs.msg import CalibrationStatus, IrBlobArray
from wiimote_tracker_msgs.srv import (CheckPlace, RecalibrateCamera, SetLed, SetLedRequest,
                                      SolveCalibration, StartCalibration)

POINTS = 100  # a quarter of a second
MANY = 1000   # also of times when more than two cameras report the LED: it is one of five lights
WAVES = 3  # until one is solved


def position(message):
    return np.array([message.point.x, message.point.y, message.point.z])


class SimulatedHand(NodeTest):
    def solved_by_wand(self):
        """The answer of calibration/solve. It may ask for another wave, since a camera's clock
        jumps where a busy computer halts the simulation."""
        for _ in range(WAVES):
            statuses = []
            subscriber = rospy.Subscriber('calibration/status', CalibrationStatus, statuses.append)
            started = rospy.ServiceProxy('calibration/start', StartCalibration)(
                without_square=True, wand_length=0.5)
            self.assertTrue(started.success, started.message)
            self.wait(lambda: statuses and statuses[-1].next_request == 'solve',
                      'a wand that was laid down and waved')
            subscriber.unregister()
            solved = rospy.ServiceProxy('calibration/solve', SolveCalibration)()
            if solved.success or 'wave again' not in solved.message:
                break
            self.assertTrue(rospy.ServiceProxy('calibration/cancel', Trigger)().success)
        return solved

    def test_points_come_by_themselves_and_the_hand_follows_a_calibration(self):
        truths = []
        rospy.Subscriber('simulation/truth/led', PointStamped, truths.append)
        points = []
        rospy.Subscriber('led/point', PointStamped, points.append)
        self.wait(lambda: len(points) > MANY, 'tracked points')
        self.wait(lambda: truths[-1].header.stamp > points[-1].header.stamp, 'the truth')
        known = list(truths)  # more arrive meanwhile
        stamps = [truth.header.stamp.to_sec() for truth in known]
        at = [point.header.stamp.to_sec() for point in points[:MANY]]
        truth = np.transpose([np.interp(at, stamps, axis)
                              for axis in np.transpose([position(t) for t in known])])
        errors = np.linalg.norm([position(point) for point in points[:MANY]] - truth, axis=1)
        # Simulated corners are exact; what is left is the lens' starting value and noise. The
        # median: where only two cameras see the LED turn, points are off by some cm.
        self.assertLess(np.median(errors), 0.03)

        rospy.wait_for_service('calibration/start', DEADLINE)
        started = rospy.ServiceProxy('calibration/start', StartCalibration)(
            side_x=2.5, side_y=0.0, cameras=[])
        self.assertTrue(started.success, started.message)
        self.wait(lambda: np.allclose(position(truths[-1]), 0.0), 'the LED at the first corner')
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

        def walks_about():  # on a level circle, to which the hand moves the LED only once
            if len(truths) < POINTS:
                return False
            way = np.ptp([position(truth) for truth in truths[-POINTS:]], axis=0)
            return way[0] > 0.01 and way[2] < 1e-6
        self.wait(walks_about, 'the hand to walk about')
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
