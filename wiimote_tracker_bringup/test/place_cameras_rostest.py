#!/usr/bin/env python3
"""Cameras and volume of a plan are dragged as rviz does it; the coverage follows, and Save writes a
rig."""

import os
import subprocess
import sys

import numpy as np
import rospy
import rostest
import yaml
from geometry_msgs.msg import Point, Pose, Quaternion
from live_rig import DEADLINE, NodeTest
from sensor_msgs import point_cloud2
from sensor_msgs.msg import PointCloud2
from std_srvs.srv import Trigger
from visualization_msgs.msg import (
    InteractiveMarkerFeedback, InteractiveMarkerInit, MarkerArray)
from wiimote_tracker_bringup import scene
from wiimote_tracker_bringup.programs import package_file


class PlaceCameras(NodeTest):
    def setUp(self):
        self.clouds, self.summaries, handles = [], [], []
        rospy.Subscriber('coverage/cells', PointCloud2, self.clouds.append)
        rospy.Subscriber('coverage', MarkerArray, self.on_texts)
        rospy.Subscriber('plan/update_full', InteractiveMarkerInit, handles.append)
        self.feedback = rospy.Publisher('plan/feedback', InteractiveMarkerFeedback, queue_size=10)
        self.wait(lambda: self.clouds and self.summaries and handles
                  and self.feedback.get_num_connections(), 'the first coverage')
        # interactive_markers' server takes no feedback of a client for 1 s after a handle was made.
        rospy.sleep(1.1)
        self.poses = {handle.name: handle.pose for handle in handles[-1].markers}

    def on_texts(self, message):
        texts = {marker.text: marker.pose.position for marker in message.markers}
        if message.markers[0].ns == 'summary':  # otherwise it comes later
            self.summaries.append(texts)

    def drag(self, name, pose):
        clouds, summaries = len(self.clouds), len(self.summaries)
        for event in (InteractiveMarkerFeedback.POSE_UPDATE, InteractiveMarkerFeedback.MOUSE_UP):
            self.feedback.publish(client_id='rviz', marker_name=name, event_type=event, pose=pose)
        self.wait(lambda: len(self.clouds) > clouds and len(self.summaries) > summaries,
                  'the coverage after ' + name)

    def cells(self):
        """N x 5: place, cameras, standard deviation [m]."""
        return np.array(list(point_cloud2.read_points(
            self.clouds[-1], ('x', 'y', 'z', 'cameras', 'stddev'))))

    def can_be_simulated(self, description):
        rig = subprocess.Popen([
            'rosrun', 'wiimote_tracker_bringup', 'simulated_rig', '_description:=' + description,
            f'_socket_directory:={description}.sockets'])
        try:
            rospy.wait_for_service('simulation/set_led', DEADLINE)
        finally:
            rig.terminate()
            rig.wait()

    def test_what_is_dragged_is_shown_and_saved(self):
        output = rospy.get_param('~output')
        before = self.cells()
        np.testing.assert_array_equal([before[:, :3].min(), before[:, :3].max()], [0.0, 2.5])
        self.assertEqual(before[:, 3].max(), 4.0)
        self.assertGreaterEqual(before[:, 3].min(), 3.0)  # the paper's rig sees the whole cube
        self.assertTrue(any('three: 100.0 %' in text for text in self.summaries[-1]))

        # The second camera turns its back on the cube.
        away = self.poses['wiimote_2']
        turn = away.orientation
        away.orientation = Quaternion(-turn.y, turn.x, turn.w, -turn.z)  # by 180 degrees about z
        self.drag('wiimote_2', away)
        after = self.cells()
        self.assertEqual(after[:, 3].max(), 3.0)
        self.assertGreater(after[:, 4].mean(), 1.05 * before[:, 4].mean())

        # The volume grows to where nobody looks.
        self.drag('upper corner', Pose(Point(2.5, 2.5, 9.0), Quaternion(w=1.0)))
        high = self.cells()
        self.assertEqual(high[:, 2].max(), 9.0)
        self.assertEqual(high[:, 3].min(), 0.0)
        self.assertTrue(np.isnan(high[high[:, 3] < 2, 4]).all())
        # A volume without a height is refused.
        self.drag('upper corner', Pose(Point(2.5, 2.5, -1.0), Quaternion(w=1.0)))
        self.assertEqual(self.cells()[:, 2].max(), 9.0)

        moved = self.poses['wiimote_1']
        moved.position.x -= 0.5
        self.drag('wiimote_1', moved)
        self.assertAlmostEqual(self.summaries[-1]['wiimote_1'].x, moved.position.x)
        with open(output, 'w') as file:
            file.write('# of a user')
        answer = rospy.ServiceProxy('plan/save', Trigger)()
        self.assertTrue(answer.success, answer.message)
        self.assertIn(output, answer.message)
        with open(output) as file:
            saved = yaml.safe_load(file)['cameras']
        with open(package_file('simulation/paper_rig.yaml')) as file:
            paper = yaml.safe_load(file)['cameras']
        self.assertEqual(len(scene.read_scene(output).cameras), 4)
        for key in ('position', 'look_at'):
            np.testing.assert_allclose(saved['wiimote_1'][key],
                                       np.add(paper['wiimote_1'][key], [-0.5, 0.0, 0.0]), atol=2e-3)
            np.testing.assert_allclose(saved['wiimote_3'][key], paper['wiimote_3'][key], atol=1e-3)
        for name in paper:
            self.assertEqual(saved[name]['intrinsics'], paper[name]['intrinsics'])
        forth = np.subtract(paper['wiimote_2']['look_at'], paper['wiimote_2']['position'])
        np.testing.assert_allclose(
            np.subtract(saved['wiimote_2']['look_at'], saved['wiimote_2']['position']),
            forth * [-1.0, -1.0, 1.0], atol=2e-3)

        self.can_be_simulated(output)

        os.remove(output)
        self.feedback.publish(client_id='rviz', marker_name='wiimote_3', menu_entry_id=1,
                              event_type=InteractiveMarkerFeedback.MENU_SELECT)
        self.wait(lambda: os.path.exists(output), 'what the menu saves')
        self.wait(lambda: any('three: ' in text and 'saved to' in text
                              for text in self.summaries[-1]), 'the words that it is saved')
        with open(output + '.bak') as file:
            self.assertEqual(file.read(), '# of a user')


if __name__ == '__main__':
    rospy.init_node('place_cameras_rostest')
    sys.exit(rostest.rosrun('wiimote_tracker_bringup', 'place_cameras_test', PlaceCameras))
