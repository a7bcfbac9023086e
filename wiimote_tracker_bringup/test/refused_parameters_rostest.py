#!/usr/bin/env python3
"""A node whose parameters are refused ends, or waits where roslaunch would start it for ever."""

import os
import subprocess
import sys
import unittest

import roslib.packages
import rosnode
import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from nodelet.srv import NodeletLoad

NODES = {
    'coverage': [roslib.packages.find_node('wiimote_tracker_triangulation', 'coverage_node')[0],
                 '_cell_size:=-1'],
    'triangulation': [roslib.packages.find_node('wiimote_tracker_triangulation',
                                                'tracker_manager')[0], '_mode:=track'],
    'simulated_hand': [roslib.packages.find_node('wiimote_tracker_bringup', 'simulated_hand')[0],
                       '_side:=-1'],
}
MANAGER = [roslib.packages.find_node('nodelet', 'nodelet')[0], 'manager']
SAID = {'coverage': '/coverage/cell_size is -1, but', 'triangulation': '/triangulation/mode is',
        'simulated_hand': '/simulated_hand/side is -1, but'}


class RefusedParameters(unittest.TestCase):
    def assert_diagnosed(self, name, said):
        """That /diagnostics repeats what was said."""
        statuses = []
        while name + ': parameters' not in [status.name for status in statuses]:
            statuses = rospy.wait_for_message('/diagnostics', DiagnosticArray, 10.0).status
        self.assertEqual(statuses[0].level, DiagnosticStatus.ERROR)
        self.assertIn(statuses[0].message, said)

    def start(self, name, **environment):
        process = subprocess.Popen(NODES.get(name, MANAGER) + ['__name:=' + name],
                                   stderr=subprocess.PIPE, text=True,
                                   env=dict(os.environ, **environment))
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def test_it_ends(self):
        for name in NODES:
            process = self.start(name)
            said = process.stderr.read()
            self.assertNotEqual(process.wait(), 0)
            self.assertIn(SAID[name], said)
            self.assertNotIn('rosnode kill', said)

    def test_a_respawned_one_waits(self):
        for name in NODES:
            process = self.start(name, WIIMOTE_TRACKER_RESPAWNS='1')
            said = next(line for line in process.stderr if 'rosnode kill /' + name in line)
            self.assertIn(SAID[name], said)
            self.assertLessEqual(said.lower().count('correct'), 1, said)
            if name != 'simulated_hand':
                self.assert_diagnosed(name, said)
            self.assertTrue(rosnode.rosnode_ping('/' + name, max_count=1))
            self.assertIsNone(process.poll())
            rosnode.kill_nodes(['/' + name])
            process.wait()

    def test_a_nodelet_waits_in_a_respawned_manager(self):
        rospy.set_param('/gestures/boundary', 'never')
        process = self.start('manager', WIIMOTE_TRACKER_RESPAWNS='1')
        rospy.wait_for_service('/manager/load_nodelet', 30.0)
        load = rospy.ServiceProxy('/manager/load_nodelet', NodeletLoad)
        gestures = 'wiimote_tracker_triangulation/Gestures'
        self.assertTrue(load('/gestures', gestures, [], [], [], '').success)
        said = next(line for line in process.stderr if 'rosnode kill /manager' in line)
        self.assertIn('/gestures/boundary is', said)
        self.assert_diagnosed('gestures', said)


if __name__ == '__main__':
    rospy.init_node('refused_parameters_rostest')
    rostest.rosrun('wiimote_tracker_bringup', 'refused_parameters', RefusedParameters, sys.argv)
