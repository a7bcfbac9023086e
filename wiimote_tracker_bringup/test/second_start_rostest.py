#!/usr/bin/env python3
"""A node that is started while it runs says so, and takes the place of the other one."""

import subprocess
import sys
import xmlrpc.client

import rosgraph
import roslib.packages
import rospy
import rostest
from live_rig import NodeTest


class SecondStart(NodeTest):
    def start(self):
        node = roslib.packages.find_node('wiimote_tracker_triangulation', 'coverage_node')[0]
        process = subprocess.Popen([node], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                                   text=True)
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        self.wait(lambda: self.pid() == process.pid, 'the node to start')
        return process

    def pid(self):
        """Of the process that answers for the node; nothing when none does."""
        try:
            api = rosgraph.Master('/test').lookupNode('/coverage')
            return xmlrpc.client.ServerProxy(api).getPid('/test')[2]
        except (rosgraph.MasterException, OSError):
            return None

    def said(self, process):
        process.terminate()
        return process.stderr.read()

    def test_it_names_who_is_there(self):
        first = self.start()
        second = self.start()
        first.wait(10.0)
        said = self.said(second)
        self.assertIn(f'/coverage runs already (process {first.pid} on ', said)
        self.assertIn('end one of the launches, or start the second in a namespace', said)
        self.assertNotIn('runs already', first.stderr.read())

    def test_one_that_was_killed_is_not_there(self):
        killed = self.start()
        killed.kill()
        killed.wait()
        self.assertNotIn('runs already', self.said(self.start()))


if __name__ == '__main__':
    rospy.init_node('second_start_rostest')
    rostest.rosrun('wiimote_tracker_bringup', 'second_start', SecondStart, sys.argv)
