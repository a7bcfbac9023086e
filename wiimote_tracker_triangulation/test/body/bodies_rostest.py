#!/usr/bin/env python3
"""A rigid body from the spots of its LEDs: the running node learns it, follows it beside a free
LED, with an LED hidden, and after all were hidden; track_bag finds the same poses in a recording.

The truth is that of the recording, which shares no code with the tracker."""

import math
import os
import shutil
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import numpy as np
import rosbag
import roslib.packages
import rospy
import yaml
from geometry_msgs.msg import PoseWithCovarianceStamped, TwistWithCovarianceStamped
from nav_msgs.msg import Odometry
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import MarkerArray
from wiimote_tracker_msgs.msg import (IrBlobArray, RigCalibration, TrackedBody, TrackedBodyArray,
                                      TrackedPoint, TrackedPointArray)
from wiimote_tracker_msgs.srv import LearnBody

sys.path.insert(0, os.path.join(os.path.dirname(os.path.realpath(__file__)), '..', 'track_bag'))
import recording  # noqa: E402
from live import bytes_of, wait_for  # noqa: E402

PACKAGE = 'wiimote_tracker_triangulation'
LEDS = np.array([[0.10, 0.0, 0.03], [-0.06, 0.09, 0.0], [0.02, -0.03, 0.02]])
MOTION = ('/wand/pose', '/wand/twist', '/wand/odometry')
NOWHERE = np.array([0.0, 0.0, -50.0])  # below the floor, where no camera looks

# What happens when [s].
LEARNED_AT = 2.5     # before, it is learned
FREE_LED = 3.0       # from here on it shines
ONE_HIDDEN = (4.0, 4.5)
ALL_HIDDEN = (5.0, 5.8)
RECOVERY = 0.2
SILENT_AFTER = 0.05  # the last sight
END = 6.8


def pose(t):
    """Rotation and position of the body, carried about and turned, slowly."""
    a, b = 0.5 * math.sin(1.1 * t), 0.3 * math.sin(1.7 * t)
    yaw = np.array([[math.cos(a), -math.sin(a), 0], [math.sin(a), math.cos(a), 0], [0, 0, 1]])
    roll = np.array([[1, 0, 0], [0, math.cos(b), -math.sin(b)], [0, math.sin(b), math.cos(b)]])
    return yaw @ roll, 0.5 * recording.walk(0.5 * t) + [0, 0, 0.5]


def led(number):
    def way(t):
        if ALL_HIDDEN[0] <= t < ALL_HIDDEN[1] or (
                number == 1 and ONE_HIDDEN[0] <= t < ONE_HIDDEN[1]):
            return NOWHERE
        rotation, position = pose(t)
        return rotation @ LEDS[number] + position
    return way


def free(t):
    return np.array([-0.6, 0.4, 0.5]) if t >= FREE_LED else NOWHERE


def vector(v):
    return np.array([v.x, v.y, v.z])


def matrix(q):
    x, y, z, w = q.x, q.y, q.z, q.w
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


class Bodies(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node('bodies_rostest')
        cls.folder = tempfile.mkdtemp()
        cls.file = rospy.get_param('/triangulation/bodies/file')
        cls.heard = {}
        cls.subscribers = []
        for topic, kind in (('/points', TrackedPointArray), ('/bodies', TrackedBodyArray),
                            ('/tf', TFMessage), ('/markers', MarkerArray)):
            cls.hear(topic, kind)
        cls.publishers = {
            name: rospy.Publisher('/%s/ir_blobs' % name, IrBlobArray, queue_size=1000,
                                  tcp_nodelay=True) for name in recording.NAMES}
        cls.rig_publisher = rospy.Publisher('/calibration/rig', RigCalibration, latch=True,
                                            queue_size=1)
        cls.rig_publisher.publish(recording.rig())
        for publisher in cls.publishers.values():
            wait_for(lambda: publisher.get_num_connections() > 0, publisher.resolved_name)
        cls.images = recording.images(END, (led(0), led(1), led(2), free))

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)
        if os.path.exists(cls.file):
            os.remove(cls.file)

    @classmethod
    def hear(cls, topic, kind):
        cls.heard[topic] = []
        cls.subscribers.append(rospy.Subscriber(topic, kind, cls.heard[topic].append,
                                                tcp_nodelay=True))
        wait_for(lambda: cls.subscribers[-1].get_num_connections() > 0, topic)

    def show(self, images):
        """One by one, so that the images of several cameras cannot overtake each other."""
        points = self.heard['/points']
        for image in images:
            self.publishers[image.camera].publish(image)
            wait_for(lambda: points and abs(
                (points[-1].latest_arrival - image.arrival).to_sec()) < 1e-6, 'points')
            # No queue overflows while this computer is busy.
            wait_for(lambda: len({self.heard[topic][-1].header.stamp for topic in MOTION
                                  if self.heard.get(topic)}) <= 1, 'pose, twist and odometry')

    def poses_between(self, begin, end):
        return [(a, b) for a in self.heard['/bodies'] for b in a.bodies
                if begin <= recording.seconds_of(a.header.stamp) < end]

    def check_leds(self, array, body):
        """Each LED is where it truly is, within five standard deviations of pose and shape."""
        t = recording.seconds_of(array.header.stamp)
        rotation, position = pose(t)
        found_rotation = matrix(body.pose.pose.orientation)
        covariance = np.array(body.pose.covariance).reshape(6, 6)
        for i, learned in enumerate(self.learned):
            arm = found_rotation @ learned
            self.assertLess(np.linalg.norm(
                arm + vector(body.pose.pose.position) - vector(body.leds[i].position)), 1e-9)
            x, y, z = arm
            jacobian = np.hstack([np.eye(3), np.array([[0, z, -y], [-z, 0, x], [y, -x, 0]])])
            sigma = math.sqrt(np.trace(jacobian @ covariance @ jacobian.T) +
                              3 * self.learned_stddev[i] ** 2)
            error = np.linalg.norm(vector(body.leds[i].position) -
                                   rotation @ LEDS[self.order[i]] - position)
            self.assertLess(error, 5 * sigma, 'LED %d at %.3f s' % (i, t))

    def test_learn_follow_lose_find_and_compute_again(self):
        self.learn()
        # Learning ends at an unknown image; the recording starts after it.
        rest = [i for i in self.images
                if recording.seconds_of(i.arrival) >= LEARNED_AT]
        for topic, kind in zip(MOTION, (PoseWithCovarianceStamped, TwistWithCovarianceStamped,
                                        Odometry)):
            self.hear(topic, kind)
        self.show(rest)
        last = rest[-1].header.stamp
        wait_for(lambda: self.heard['/bodies'] and
                 self.heard['/bodies'][-1].header.stamp >= last - rospy.Duration(0.02),
                 'the last bodies')
        self.beside_a_free_led()
        self.with_an_led_hidden()
        self.lost_and_found()
        self.transforms()
        self.odometry()
        namespaces = {m.ns for a in self.heard['/markers'] for m in a.markers}
        self.assertTrue({'body_axes', 'body_led', 'body_label', 'body_led_label', 'body_ray'} <=
                        namespaces)
        self.offline()

    def learn(self):
        before = [i for i in self.images if recording.seconds_of(i.arrival) < LEARNED_AT]
        self.show(before[:200])  # its LEDs are tracked
        rospy.wait_for_service('learn_body', 60)
        # The calls before connect it: while learning begins, a master that is slow to say where the
        # service is would let the images run out.
        service = rospy.ServiceProxy('learn_body', LearnBody, persistent=True)
        self.addCleanup(service.close)
        self.assertIn('name', service('no word', 1.0, []).message)
        self.assertIn('duration', service('wand', 0.1, []).message)
        self.assertIn('name of an LED', service('led', 1.0, []).message)
        for frame in ('world', recording.NAMES[0] + '_optical_frame'):
            self.assertIn('name of a frame of the rig', service(frame, 1.0, []).message)
        answers = []
        thread = threading.Thread(target=lambda: answers.append(service('wand', 1.0, [])))
        thread.start()
        # All of them, also after the answer: the first image after a gap counts as one from a wrong
        # clock.
        for image in before[200:]:
            self.show([image])
            if not answers:
                time.sleep(0.001)  # leaves time for the service to start; more is not needed
        thread.join(60)
        self.assertTrue(answers and answers[0].success, answers)
        answer = answers[0]
        self.learned = [vector(p) for p in answer.leds]
        self.learned_stddev = answer.stddev
        self.assertEqual(len(self.learned), 3)
        self.assertTrue(0.004 < answer.symmetry < 1.0)
        # Which is which: by the distances, which all differ.
        distances = lambda leds: np.array([[np.linalg.norm(a - b) for b in leds] for a in leds])
        sums = distances(LEDS).sum(axis=0)
        self.order = [int(np.argmin(abs(sums - s)))
                      for s in distances(self.learned).sum(axis=0)]
        self.assertEqual(sorted(self.order), [0, 1, 2])
        error = distances(self.learned) - distances(LEDS[self.order])
        worst = np.add.outer(np.square(self.learned_stddev), np.square(self.learned_stddev))
        # Deviations estimated from eight parts: Student's t, 7 degrees of freedom, 0.01 %.
        self.assertTrue(np.all(abs(error) < 7.9 * np.sqrt(worst) + 1e-12), (error, worst))
        self.assertLess(abs(error).max(), 0.0005)
        with open(self.file) as file:
            bodies = yaml.safe_load(file)['bodies']
        self.assertEqual([b['name'] for b in bodies], ['wand'])
        self.assertTrue(np.allclose(bodies[0]['leds'], self.learned, atol=0))

    def beside_a_free_led(self):
        bodies = self.poses_between(FREE_LED + 0.5, ONE_HIDDEN[0])
        self.assertGreater(len(bodies), 0.95 * 400 * (ONE_HIDDEN[0] - FREE_LED - 0.5))
        for array, body in bodies:
            self.assertEqual(body.state, TrackedBody.TRACKED)
            self.check_leds(array, body)
        for array in self.heard['/points']:
            if FREE_LED + 0.7 <= recording.seconds_of(array.header.stamp) < ONE_HIDDEN[0]:
                tracked = [p for p in array.points if p.state == TrackedPoint.TRACKED]
                self.assertEqual(len(tracked), 1, 'the LEDs of a body are no free LEDs')
                self.assertLess(np.linalg.norm(vector(tracked[0].position) - free(9)), 0.01)

    def with_an_led_hidden(self):
        hidden = self.order.index(1)
        bodies = self.poses_between(ONE_HIDDEN[0] + 0.1, ONE_HIDDEN[1])
        self.assertGreater(len(bodies), 100)
        for array, body in bodies:
            self.assertEqual(body.state, TrackedBody.TRACKED)
            self.check_leds(array, body)
            self.assertEqual(body.leds[hidden].cameras, [])
            self.assertTrue(math.isnan(body.leds[hidden].deviation))
            self.assertGreaterEqual(len(body.leds[hidden - 1].cameras), 2)

    def lost_and_found(self):
        states = [b.state for _, b in self.poses_between(ALL_HIDDEN[0] + 0.1, ALL_HIDDEN[1])]
        self.assertEqual(set(states), {TrackedBody.PREDICTED, TrackedBody.LOST})
        self.assertEqual(states.count(TrackedBody.LOST), 1)
        found = self.poses_between(ALL_HIDDEN[1] + RECOVERY, END)
        self.assertGreater(len(found), 0.95 * 400 * (END - ALL_HIDDEN[1] - RECOVERY) - 10)
        for array, body in found:
            self.assertEqual(body.state, TrackedBody.TRACKED)
            self.check_leds(array, body)

    def transforms(self):
        stamps = [t.header.stamp for m in list(self.heard['/tf']) for t in m.transforms
                  if t.child_frame_id == 'wand']
        self.assertGreater(len(stamps), 500)
        self.assertTrue(all(a < b for a, b in zip(stamps, stamps[1:])), 'a stamp never twice')
        first = self.heard['/wand/pose'][0].header.stamp
        tracked = [a.header.stamp for a, b in self.poses_between(0, END + 1)
                   if b.state == TrackedBody.TRACKED and a.header.stamp >= first]
        wait_for(lambda: [p.header.stamp for p in self.heard['/wand/pose']] == tracked,
                 'the poses of all images in which it was tracked')

    def odometry(self):
        """Pose, twist and both together tell the same, and nothing while the body is hidden."""
        first = max(self.heard[topic][0].header.stamp for topic in MOTION)
        heard = [[m for m in self.heard[topic] if m.header.stamp >= first] for topic in MOTION]
        self.assertEqual(len({len(h) for h in heard}), 1)
        for pose_, twist, both in zip(*heard):
            self.assertEqual((both.header.stamp, both.header.frame_id, both.child_frame_id),
                             (pose_.header.stamp, 'world', 'wand'))
            self.assertEqual(twist.header.frame_id, 'wand')
            self.assertEqual(bytes_of(both.pose), bytes_of(pose_.pose))
            self.assertEqual(bytes_of(both.twist), bytes_of(twist.twist))
        stamps = np.array([recording.seconds_of(m.header.stamp) for m in heard[2]])
        while_hidden = stamps[(stamps > ALL_HIDDEN[0] + SILENT_AFTER) & (stamps < ALL_HIDDEN[1])]
        self.assertEqual(len(while_hidden), 0, while_hidden)
        for message, t in zip(heard[2], stamps):
            if FREE_LED + 0.5 < t < ONE_HIDDEN[0]:
                self.check_twist(message, t)

    def check_twist(self, message, t):
        """It is that of the true motion, within five standard deviations."""
        (before, start), (_, position), (after, end) = pose(t - 1e-4), pose(t), pose(t + 1e-4)
        turn = after @ before.T
        angular = np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0],
                            turn[1, 0] - turn[0, 1]]) / 4e-4
        # The learned body's origin and axes are not the true ones.
        rotation = matrix(message.pose.pose.orientation)
        linear = (end - start) / 2e-4 + np.cross(
            angular, vector(message.pose.pose.position) - position)
        variances = np.diag(np.array(message.twist.covariance).reshape(6, 6))
        for found, true, variance in ((message.twist.twist.linear, linear, variances[:3]),
                                      (message.twist.twist.angular, angular, variances[3:])):
            error = np.linalg.norm(rotation @ vector(found) - true)
            self.assertLess(error, 5 * math.sqrt(variance.sum()), t)

    def offline(self):
        """A recording gives the same poses, once both know the body."""
        bag_path, out_path = (os.path.join(self.folder, name) for name in ('in.bag', 'out.bag'))
        parameters = os.path.join(self.folder, 'parameters.yaml')
        with open(parameters, 'w') as file:
            yaml.safe_dump({'bodies': {'file': self.file}}, file)
        with rosbag.Bag(bag_path, 'w') as bag:
            bag.write('/calibration/rig', recording.rig(), recording.time_of(-0.1))
            for image in self.images:
                bag.write('/%s/ir_blobs' % image.camera, image, image.arrival)
        program = roslib.packages.find_node(PACKAGE, 'track_bag')[0]
        subprocess.check_call([program, bag_path, out_path, '--params', parameters, '--tum',
                               self.folder], stdout=subprocess.DEVNULL)
        # After all LEDs were hidden, the earlier state does not matter.
        begin = recording.time_of(ALL_HIDDEN[1])
        with rosbag.Bag(out_path) as bag:
            offline = [[bytes_of(m) for _, m, _ in bag.read_messages(topic)
                        if m.header.stamp >= begin] for topic in MOTION]
            poses = [(m.header.stamp.to_sec(), m.pose.pose) for _, m, _ in
                     bag.read_messages('/wand/pose')]
            transforms = [t.child_frame_id for _, m, _ in bag.read_messages('/tf')
                          for t in m.transforms]
        trajectory = np.loadtxt(os.path.join(self.folder, 'wand.tum'))
        expected = [(t, *vector(p.position), *vector(p.orientation), p.orientation.w)
                    for t, p in poses]
        self.assertLess(abs(trajectory - expected).max(), 1e-6)
        for topic, computed in zip(MOTION, offline):
            live = [bytes_of(m) for m in self.heard[topic] if m.header.stamp >= begin]
            self.assertGreater(len(computed), 200)
            self.assertGreater(len(live), 200)
            self.assertEqual(live, computed[:len(live)])
        self.assertIn('wand', transforms)


if __name__ == '__main__':
    import rostest
    rostest.rosrun(PACKAGE, 'bodies', Bodies)
