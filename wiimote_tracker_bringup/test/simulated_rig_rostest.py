#!/usr/bin/env python3
"""Real drivers read from the virtual Wii Remotes what the description specifies."""

import collections
import os
import signal
import subprocess
import sys
from xmlrpc.client import ServerProxy

import numpy as np
import rosgraph
import roslib.packages
import rosnode
import rospkg
import rospy
import rostest
from geometry_msgs.msg import PointStamped, Vector3
from live_rig import DEADLINE, NodeTest
from sensor_msgs.msg import Imu
from wiimote_tracker_bringup import scene
from wiimote_tracker_msgs.msg import IrBlobArray
from wiimote_tracker_msgs.srv import SetLed, SetLedRequest

IMAGES = 100
# Rotation of the remote's own axes (left, rear, up) into the optical frame (right, down, forward).
OPTICAL_FROM_IMU = np.array([[-1, 0, 0], [0, 0, -1], [0, -1, 0]])


class SimulatedRig(NodeTest):
    @classmethod
    def setUpClass(cls):
        rospy.init_node('simulated_rig_rostest')
        cls.path = os.path.join(rospkg.RosPack().get_path('wiimote_tracker_bringup'),
                                'simulation/paper_rig.yaml')
        cls.scene = scene.read_scene(cls.path)
        cls.images = collections.defaultdict(list)
        cls.imu = collections.defaultdict(list)
        cls.truth = []
        for camera in cls.scene.cameras:
            rospy.Subscriber(camera.name + '/ir_blobs', IrBlobArray,
                             cls.images[camera.name].append)
            rospy.Subscriber(camera.name + '/imu/data_raw', Imu, cls.imu[camera.name].append)
        rospy.Subscriber('simulation/truth/led', PointStamped, cls.truth.append)
        rospy.wait_for_service('simulation/set_led', DEADLINE)
        cls.set_led = staticmethod(rospy.ServiceProxy('simulation/set_led', SetLed))

    def move(self, target, **more):
        request = SetLedRequest(led='led', on=True, motion=SetLedRequest.LINE, **more)
        request.target.x, request.target.y, request.target.z = target
        return self.set_led(request)

    def images_after(self, time, number=IMAGES):
        """The first images of every camera that were exposed more than 50 ms after a time. By their
        stamps: where a driver stood still, older ones arrive even later."""
        def after(name):
            return [image for image in list(self.images[name])
                    if image.header.stamp.to_sec() > time + 0.05]
        names = [camera.name for camera in self.scene.cameras]
        self.wait(lambda: all(len(after(name)) >= number for name in names),
                  'images of all cameras')
        return {name: after(name)[:number] for name in names}

    def test_blobs_are_the_projection_of_the_led(self):
        for target in ((1.25, 1.25, 0.0), (0.0, 2.5, 2.5), (2.1, 0.4, 1.1)):
            response = self.move(target)
            self.assertTrue(response.success, response.message)
            images = self.images_after(response.arrival.to_sec())
            for camera in self.scene.cameras:
                pixels = []
                for image in images[camera.name]:
                    self.assertEqual(len(image.blobs), 1)
                    self.assertEqual((image.width, image.height), (1024, 768))
                    self.assertEqual(image.camera.strip('/'), camera.name)
                    pixels.append((image.blobs[0].x, image.blobs[0].y))
                mean = np.mean(pixels, axis=0)
                # Six standard errors, and the rounding error left after averaging 0.3 px of noise.
                tolerance = 6.0 * self.scene.effective_noise() / np.sqrt(IMAGES) + 0.06
                np.testing.assert_allclose(mean, camera.project(np.array([target]))[0],
                                           atol=tolerance)

    def test_a_camera_that_is_turned_sees_the_led_elsewhere(self):
        put = self.move((1.25, 1.25, 1.0))
        # The last of several: the stamps of a driver that has just started may be late.
        image = self.images_after(put.arrival.to_sec(), IMAGES)['wiimote_2'][-1]
        turn = SetLedRequest(led='wiimote_2', motion=SetLedRequest.LINE)
        try:
            turn.target.x, turn.target.y, turn.target.z = 1.35, 1.35, 1.0
            turned = self.set_led(turn)
            self.assertTrue(turned.success, turned.message)
            later = self.images_after(turned.arrival.to_sec(), IMAGES)['wiimote_2'][-1]
        finally:  # as in the description
            turn.target.x, turn.target.y = 1.25, 1.25
            self.set_led(turn)
        # 0.14 m, 6.3 m away.
        self.assertGreater(abs(later.blobs[0].x - image.blobs[0].x), 20.0)

    def test_identities_match_the_description(self):
        images = self.images_after(rospy.get_time(), 1)
        for number, camera in enumerate(self.scene.cameras, 1):
            self.assertEqual(images[camera.name][0].identity, f'00:1f:32:00:00:{number:02}')

    def test_a_folder_that_cannot_be_made_is_told_at_once(self):
        """It is not waited for, as for the end of another simulation (20 s)."""
        node = roslib.packages.find_node('wiimote_tracker_bringup', 'simulated_rig')[0]
        for folder, problem in (('/nowhere/sockets', "cannot listen at '/nowhere/sockets/"),
                                ('', '/homeless/socket_directory is empty: name a folder')):
            ended = subprocess.run(
                [node, '__name:=homeless', '_description:=' + self.path,
                 '_socket_directory:=' + folder],
                stderr=subprocess.PIPE, timeout=15.0, universal_newlines=True)
            self.assertEqual(ended.returncode, 1)
            self.assertIn(problem, ended.stderr)

    def test_images_that_a_pause_would_delay_are_lost(self):
        exposures = []
        rospy.Subscriber('simulation/exposures', IrBlobArray, exposures.append)
        self.wait(lambda: exposures, 'exposures')
        uri = rosnode.get_api_uri(rosgraph.Master(rospy.get_name()), '/simulated_rig')
        process = ServerProxy(uri).getPid(rospy.get_name())[2]
        os.kill(process, signal.SIGSTOP)
        try:
            rospy.sleep(1.0)
            end = rospy.get_time()
        finally:
            os.kill(process, signal.SIGCONT)
        self.wait(lambda: exposures[-1].header.stamp.to_sec() > end, 'images after the pause')
        after = [(image.arrival - image.header.stamp).to_sec() for image in list(exposures)
                 if image.arrival.to_sec() > end]
        self.assertLess(max(after), 0.2)

    def test_accelerometer_measures_gravity_as_mounted(self):
        names = [camera.name for camera in self.scene.cameras]
        self.wait(lambda: all(len(self.imu[name]) >= 20 for name in names), 'imu of all cameras')
        for camera in self.scene.cameras:
            mean = np.mean([(m.linear_acceleration.x, m.linear_acceleration.y,
                             m.linear_acceleration.z) for m in self.imu[camera.name][:20]], axis=0)
            up = camera.rotation.T @ [0.0, 0.0, 1.0]
            np.testing.assert_allclose(OPTICAL_FROM_IMU @ mean, 9.80665 * up, atol=0.25)

    def test_a_dark_led_gives_empty_images(self):
        response = self.set_led(SetLedRequest(led='led', on=False, motion=SetLedRequest.HOLD))
        self.assertTrue(response.success)
        images = self.images_after(response.arrival.to_sec(), 10)
        self.assertFalse([image for series in images.values() for image in series if image.blobs])

    def test_two_leds_of_a_wand_are_two_spots(self):
        self.move((1.25, 1.25, 1.0))
        response = self.set_led(SetLedRequest(led='wand_end', on=True, motion=SetLedRequest.HOLD))
        try:
            self.assertTrue(response.success, response.message)
            images = self.images_after(response.arrival.to_sec())
            counts = [len(image.blobs) for series in images.values() for image in series]
            # Where one end is exactly behind the other they are one spot.
            self.assertGreater(counts.count(2), 0.8 * len(counts))
        finally:
            self.set_led(SetLedRequest(led='wand_end', on=False, motion=SetLedRequest.HOLD))

    def test_truth_follows_the_motion_and_keeps_its_rate(self):
        self.move((0.5, 0.5, 0.5))
        begin = rospy.get_time()
        response = self.move((1.5, 0.5, 0.5), speed=2.0)
        arrival = response.arrival.to_sec()
        self.assertGreater(arrival, begin + 0.5 - 1e-3)
        self.wait(lambda: self.truth and self.truth[-1].header.stamp.to_sec() > arrival + 0.1,
                  'truth after the arrival')
        track = [(m.header.stamp.to_sec(), m.point.x) for m in list(self.truth)]
        moving = [(t, x) for t, x in track if arrival - 0.49 < t < arrival]
        self.assertGreater(len(moving), 90)  # 200 Hz
        for t, x in moving:
            part = 1.0 - (arrival - t) / 0.5
            way = part ** 3 * (10.0 - 15.0 * part + 6.0 * part ** 2)
            self.assertAlmostEqual(x, 0.5 + way, delta=1e-5)
        self.assertTrue(all(x == 1.5 for t, x in track if t > arrival))

    def test_an_invalid_request_is_refused_with_a_reason(self):
        refused = [
            (dict(led='candle', motion=SetLedRequest.HOLD), "reflection 'candle'"),
            (dict(led='led', motion=9), 'HOLD, LINE, CIRCLE, WAVE or DRAW'),
            (dict(led='led', motion=SetLedRequest.LINE, speed=-1.0), 'speed'),
            (dict(led='led', motion=SetLedRequest.LINE, speed=float('nan')), 'speed'),
            (dict(led='led', motion=SetLedRequest.CIRCLE, speed=0.0, radius=1.0), 'speed'),
            (dict(led='led', motion=SetLedRequest.CIRCLE, speed=1.0, radius=0.0), 'radius'),
            (dict(led='led', motion=SetLedRequest.SHOW), 'only the board'),
            (dict(led='board', motion=SetLedRequest.LINE), 'only HOLD or be shown'),
            (dict(led='led', motion=SetLedRequest.WAVE, speed=1.0), 'sides of the box'),
            (dict(led='led', motion=SetLedRequest.WAVE, box=Vector3(1, 1, 1)), 'speed'),
            (dict(led='led', motion=SetLedRequest.DRAW, drawing='face'), "no drawing 'face'"),
            (dict(led='wand_end', motion=SetLedRequest.LINE), "where 'led' goes"),
            (dict(led='wiimote_1', motion=SetLedRequest.HOLD), 'can only be turned to a target')]
        for fields, word in refused:
            response = self.set_led(SetLedRequest(on=True, **fields))
            self.assertFalse(response.success, fields)
            self.assertIn(word, response.message)


if __name__ == '__main__':
    sys.exit(rostest.rosrun('wiimote_tracker_bringup', 'simulated_rig_and_drivers', SimulatedRig))
