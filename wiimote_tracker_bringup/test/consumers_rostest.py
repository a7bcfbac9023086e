#!/usr/bin/env python3
"""What robot_localization, mavros, diagnostic_aggregator and PlotJuggler read: topics, types,
frames, rates and covariances, as their launch files and configurations ask for them. The programs
themselves are not run: Debian does not have all of them."""

import re
import sys
import xml.etree.ElementTree as ElementTree

import numpy as np
import rospkg
import rospy
import rostest
import rostopic
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseWithCovarianceStamped, TwistWithCovarianceStamped
from launch_files import load
from live_rig import LiveRigTest
from nav_msgs.msg import Odometry
from tf2_msgs.msg import TFMessage

PACKAGE = rospkg.RosPack().get_path('wiimote_tracker_bringup')
SETTLE = 1.0         # the drivers' clocks [s]
JUDGED = 3.0         # [s]
LEAST_RATE = 150.0  # of four cameras, less what is lost or late [Hz]
OLDEST = 0.1         # [s]


class Consumers(LiveRigTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.transforms = {}
        cls.statuses = set()
        rospy.Subscriber('/diagnostics', DiagnosticArray, lambda message: cls.statuses.update(
            s.name for s in message.status), queue_size=100)
        for topic in ('/tf', '/tf_static'):
            rospy.Subscriber(topic, TFMessage, lambda message: cls.transforms.update(
                {t.child_frame_id: t for t in message.transforms}))

    def hear(self, topic, kind, tcp_nodelay, *limits):
        """Messages of a topic with the time when each came, once the body has been tracked for a
        while; they pass check() with these limits."""
        heard = []
        rospy.Subscriber(topic, kind, lambda m: heard.append((rospy.get_time(), m)),
                         queue_size=1000, tcp_nodelay=tcp_nodelay)
        self.calibrate()
        self.wait(lambda: heard, topic)

        def between(begin, end):  # by stamps: what is heard late, then all at once, counts once
            self.wait(lambda: heard[-1][1].header.stamp.to_sec() > end, topic)
            return [(t, m) for t, m in list(heard) if begin <= m.header.stamp.to_sec() < end]
        return between(*self.in_real_time(
            lambda *period: self.check(between(*period), *limits),
            lambda: heard[-1][1].header.stamp.to_sec() + SETTLE, JUDGED, before=SETTLE,
            listening=True))

    def check(self, heard, minimum_rate, maximum_rate, *covariances):
        rate = len(heard) / JUDGED
        self.assertGreater(rate, minimum_rate)
        self.assertLess(rate, maximum_rate)
        stamps = [m.header.stamp for _, m in heard]
        self.assertTrue(all(a < b for a, b in zip(stamps, stamps[1:])))
        age = np.median([t - m.header.stamp.to_sec() for t, m in heard])
        print('%.0f Hz, %.1f ms old' % (rate, 1e3 * age))
        self.assertLess(age, OLDEST)
        for _, message in heard:
            for name in covariances:
                covariance = np.array(getattr(message, name).covariance).reshape(6, 6)
                self.assertLess(abs(covariance - covariance.T).max(), 1e-12)
                self.assertGreater(np.linalg.eigvalsh(covariance).min(), 0.0, name)

    def test_mavros_odometry(self):
        heard = self.hear('mavros/odometry/out', Odometry, False, 30.0, 42.0, 'pose', 'twist')
        for _, message in heard:
            self.assertEqual((message.header.frame_id, message.child_frame_id), ('world', 'wand'))
            q = message.pose.pose.orientation
            self.assertAlmostEqual(q.x ** 2 + q.y ** 2 + q.z ** 2 + q.w ** 2, 1.0, places=6)
        self.wait(lambda: {'world', 'odom'} <= set(self.transforms), 'the static transforms')
        # mavros itself ties map_ned to map and odom_ned to odom.
        self.assertEqual(self.transforms['world'].header.frame_id, 'odom')
        self.assertEqual(self.transforms['odom'].header.frame_id, 'map')
        for frame in ('world', 'odom'):
            self.assertEqual(self.transforms[frame].transform.rotation.w, 1.0)

    def test_mavros_vision_pose(self):
        nodes, _ = load('mavros_vision.launch', 'body:=wand', 'message:=vision_pose')
        self.assertEqual({name for name in nodes if not name.startswith('check_')},
                         {'odom_in_map', 'world_in_odom', 'mavros_vision_pose'})
        mode, topic, rate, output = nodes['mavros_vision_pose'].args.split()
        self.assertEqual((mode, output), ('messages', 'mavros/vision_pose/pose_cov'))
        self.assertTrue(30.0 <= float(rate) <= 50.0)
        self.hear(topic, PoseWithCovarianceStamped, True, LEAST_RATE, 410.0, 'pose')

    def test_mavros_misspelt_message(self):
        with self.assertRaisesRegex(Exception, 'message must be odometry or vision_pose'):
            load('mavros_vision.launch', 'message:=pose')

    def test_robot_localization(self):
        nodes, parameters = load('robot_localization.launch', 'body:=wand')
        self.assertEqual({(n.package, n.type) for n in nodes.values()},
                         {('robot_localization', 'ekf_localization_node'),
                          ('tf2_ros', 'static_transform_publisher'),
                          ('wiimote_tracker_bringup', 'check_body'),
                          ('wiimote_tracker_msgs', 'check_arguments')})
        self.assertEqual(nodes['world_in_map'].args.split()[-2:], ['map', 'world'])
        for name, world_frame in (('ekf_odom', 'odom'), ('ekf_map', 'map')):
            own = {key[len(name) + 2:]: value for key, value in parameters.items()
                   if key.startswith(f'/{name}/')}
            self.assertEqual(own['world_frame'], world_frame)
            self.assertEqual(own['twist0'], 'wand/twist')
            # Velocities and nothing else; in map also the pose.
            self.assertEqual(own['twist0_config'], 6 * [False] + 6 * [True] + 3 * [False])
            self.assertEqual(own['pose0_config'], 6 * [True] + 9 * [False])
            self.assertEqual(own.get('pose0'), 'wand/pose' if world_frame == 'map' else None)
            self.assertLess(own['frequency'], LEAST_RATE)
        poses = self.hear(own['pose0'], PoseWithCovarianceStamped, own['pose0_nodelay'],
                          LEAST_RATE, 410.0, 'pose')
        twists = self.hear(own['twist0'], TwistWithCovarianceStamped, own['twist0_nodelay'],
                           LEAST_RATE, 410.0, 'twist')
        self.assertEqual({m.header.frame_id for _, m in poses}, {'world'})
        # Twists need no transform, and nobody else publishes the robot's frame.
        self.assertEqual({m.header.frame_id for _, m in twists}, {own['base_link_frame']})
        self.assertNotIn(own['base_link_frame'], self.transforms)

    def test_diagnostics_are_in_one_group_each(self):
        nodes, parameters = load('diagnostics.launch')
        self.assertEqual([(n.package, n.type) for n in nodes.values()],
                         [('diagnostic_aggregator', 'aggregator_node'),
                          ('wiimote_tracker_msgs', 'check_arguments')])
        groups = {key.split('/')[-2]: value for key, value in parameters.items()
                  if key.endswith('/regex')}
        self.assertEqual(set(groups), {'cameras', 'calibration', 'tracker', 'network',
                                       'recording'})

        def groups_of(name):  # GenericAnalyzer: the whole name matches
            return [group for group, regex in groups.items() if re.fullmatch(regex, name)]

        self.calibrate()
        cameras = sorted(self.description['cameras'])
        expected = {'calibration: cameras': 'calibration', 'master_watch: ROS master': 'network',
                    'manager: triangulation': 'tracker', 'manager: body wand': 'tracker'}
        for camera in cameras:
            expected[f'{camera}/driver: Wii Remote {camera}'] = 'cameras'
            expected['manager: ' + camera] = 'tracker'
        self.wait(lambda: set(expected) <= self.statuses, 'diagnostics of all nodes')
        names = set(self.statuses)  # others may come meanwhile
        self.assertEqual({name: groups_of(name) for name in names},
                         {name: [expected.get(name)] for name in names})
        # Without the manager, and in a namespace.
        for name, group in expected.items():
            own = 'room/' + name.replace('manager: ', 'triangulation: ')
            self.assertEqual(groups_of(own), [group])
        self.assertEqual(groups_of('room/record_watch: recording'), ['recording'])
        # Nodes that wait since their parameters were refused.
        for node, group in [('calibration', 'calibration'), ('wiimote_1/driver', 'cameras'),
                            ('triangulation', 'tracker')]:
            for name in (node + ': parameters', 'room/' + node + ': parameters'):
                self.assertEqual(groups_of(name), [group])

    def test_plotjuggler(self):
        """Every curve of the layout is a number that is published."""
        layout = ElementTree.parse(PACKAGE + '/config/plotjuggler.xml')
        curves = {curve.get('name') for curve in layout.iter('curve')}
        self.assertGreater(len(curves), 10)
        self.calibrate()
        self.wait(lambda: '/wand/odometry' in dict(rospy.get_published_topics()), 'the body')
        for curve in curves:
            self.wait(lambda: rostopic.get_topic_class(curve)[0], curve)
            kind, _, value_of = rostopic.get_topic_class(curve)
            self.assertIsInstance(value_of(kind()), float, curve)


if __name__ == '__main__':
    sys.exit(rostest.rosrun('wiimote_tracker_bringup', 'consumers', Consumers))
