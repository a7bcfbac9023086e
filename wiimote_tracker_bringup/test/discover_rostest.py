#!/usr/bin/env python3
"""Remotes that connect while the drivers run get a name and a driver, and keep both when they
disconnect and connect again."""

import os
import shutil
import subprocess
import sys
import tempfile

import roslib.packages
import rospy
import rostest
import yaml
from live_rig import DEADLINE, NodeTest
from wiimote_tracker_msgs.msg import IrBlobArray


def program(package, name):
    return roslib.packages.find_node(package, name)[0]


class Discover(NodeTest):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix='discover')
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        self.cameras = os.path.join(self.folder, 'cameras.yaml')
        self.images = {}
        self.subscribers = [
            rospy.Subscriber(name + '/ir_blobs', IrBlobArray, self.count, callback_args=name)
            for name in ('wiimote_1', 'wiimote_2', 'wiimote_3')]

    def count(self, _, name):
        self.images[name] = self.images.get(name, 0) + 1

    def start(self, *command):
        process = subprocess.Popen(command)
        self.addCleanup(self.stop, process)
        return process

    def stop(self, process):
        if process.poll() is None:
            process.terminate()
        process.wait(DEADLINE)

    def connect(self, number):
        """Switches a remote on."""
        return self.start(program('wiimote_tracker_driver', 'virtual_wiimote'),
                          '--socket', os.path.join(self.folder, f'{number}.sock'),
                          '--address', f'00:1f:32:00:00:0{number}')

    def wait_for_more_of(self, *names):
        before = dict(self.images)
        for name in names:
            self.wait(lambda: self.images.get(name, 0) >= before.get(name, 0) + 20,
                      f'images of {name}')

    def devices(self):
        with open(self.cameras) as file:
            return yaml.safe_load(file)['cameras'] or {}

    def test_remotes_come_and_go(self):
        with open(self.cameras, 'w') as file:
            file.write('discover: true\ncameras:\n')
        self.start(program('wiimote_tracker_bringup', 'drivers'), '_file:=' + self.cameras,
                   '_socket_directory:=' + self.folder, '_discovery_period:=0.5',
                   '_camera_info_directory:=' + self.folder)
        # The second socket appears first.
        second = self.connect(2)
        self.wait_for_more_of('wiimote_1')
        self.connect(1)
        self.wait_for_more_of('wiimote_1', 'wiimote_2')
        self.stop(second)
        self.wait_for_more_of('wiimote_2')
        self.connect(2)
        self.wait_for_more_of('wiimote_1', 'wiimote_2')
        self.assertEqual(self.devices(), {
            'wiimote_1': f'virtual:{self.folder}/2.sock',
            'wiimote_2': f'virtual:{self.folder}/1.sock'})
        self.assertNotIn('wiimote_3', self.images)


if __name__ == '__main__':
    rospy.init_node('discover_rostest')
    sys.exit(rostest.rosrun('wiimote_tracker_bringup', 'discover', Discover))
