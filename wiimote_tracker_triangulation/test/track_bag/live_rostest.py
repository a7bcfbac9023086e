#!/usr/bin/env python3
"""The running node or nodelet gets images one by one and publishes; track_bag gets the same images
from a bag: the results are equal bit for bit."""

import os
import shutil
import subprocess
import sys
import tempfile
import unittest

import rosbag
import roslib.packages
import rospy
from geometry_msgs.msg import PointStamped
from std_msgs.msg import Header
from tf2_msgs.msg import TFMessage
from wiimote_tracker_msgs.msg import IrBlobArray, RigCalibration, TrackedPointArray, ZoneEvent

sys.path.insert(0, os.path.dirname(os.path.realpath(__file__)))
import recording  # noqa: E402
from live import bytes_of, wait_for  # noqa: E402

PACKAGE = 'wiimote_tracker_triangulation'
TOPICS = {'/points': TrackedPointArray, '/triggered_points': TrackedPointArray,
          '/zone_events': ZoneEvent, '/led/point': PointStamped, '/tf': TFMessage}


class LiveEqualsOffline(unittest.TestCase):
    def test_same_results(self):
        folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, folder)
        live = {topic: [] for topic in TOPICS}
        subscribers = [rospy.Subscriber(topic, kind, live[topic].append, tcp_nodelay=True)
                       for topic, kind in TOPICS.items()]
        rig = recording.rig(zones=[('right', (0, -1, 0), (1, 1, 2)),
                                   ('left', (-1, -1, 0), (0, 1, 2))])
        rig_publisher = rospy.Publisher('/calibration/rig', RigCalibration, latch=True,
                                        queue_size=1)
        trigger_publisher = rospy.Publisher('/trigger', Header, queue_size=10, tcp_nodelay=True)
        publishers = {name: rospy.Publisher('/%s/ir_blobs' % name, IrBlobArray, queue_size=1000,
                                            tcp_nodelay=True) for name in recording.NAMES}
        rig_publisher.publish(rig)
        for connection in list(publishers.values()) + [trigger_publisher] + subscribers:
            wait_for(lambda: connection.get_num_connections() > 0, connection.resolved_name)
        images = recording.images(1.0, (recording.walk, recording.other))
        triggers = {100: recording.trigger(0.2), 250: recording.trigger(0.5012345)}
        bag_path = os.path.join(folder, 'in.bag')
        with rosbag.Bag(bag_path, 'w') as bag:
            bag.write('/calibration/rig', rig, recording.time_of(-0.1))
            for i, image in enumerate(images):
                if i in triggers:
                    trigger_publisher.publish(triggers[i])
                    bag.write('/trigger', triggers[i], image.arrival)
                publishers[image.camera].publish(image)
                bag.write('/%s/ir_blobs' % image.camera, image, image.arrival)
                # So that the images of several cameras cannot overtake each other.
                wait_for(lambda: live['/points'] and abs(
                    (live['/points'][-1].latest_arrival - image.arrival).to_sec()) < 1e-6,
                    'the points of image %d' % i)
        wait_for(lambda: len(live['/triggered_points']) == 2, 'the answers to the triggers')

        program = roslib.packages.find_node(PACKAGE, 'track_bag')[0]
        out_path = os.path.join(folder, 'out.bag')
        process = subprocess.run([program, bag_path, out_path], stdout=subprocess.PIPE,
                                 stderr=subprocess.STDOUT, universal_newlines=True)
        self.assertEqual(process.returncode, 0, process.stdout)
        offline = {topic: [] for topic in TOPICS}
        with rosbag.Bag(out_path) as bag:
            for topic, message, _ in bag.read_messages():
                if topic in offline:
                    offline[topic].append(message)
        self.assertEqual(len(offline['/points']), len(images))
        self.assertGreater(sum(len(a.points) == 2 for a in offline['/points']), 300)
        self.assertEqual(len(offline['/zone_events']), 2)
        for topic in TOPICS:
            wait_for(lambda: len(live[topic]) >= len(offline[topic]), topic)
            self.assertEqual([bytes_of(m) for m in live[topic]],
                             [bytes_of(m) for m in offline[topic]], topic)


if __name__ == '__main__':
    import rostest
    rospy.init_node('live_equals_offline')
    rostest.rosrun(PACKAGE, 'live_equals_offline', LiveEqualsOffline, sys.argv)
