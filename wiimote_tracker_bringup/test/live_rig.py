"""Shared by the tests with virtual Wii Remotes: the rig's description, its truth, and a deadline
for every wait."""

import collections
import time
import unittest

import numpy as np
import rospy
from geometry_msgs.msg import PointStamped
from wiimote_tracker_bringup import scene
from wiimote_tracker_bringup.files import read_yaml
from wiimote_tracker_bringup.true_rig import true_rig
from wiimote_tracker_msgs.msg import IrBlobArray, RigCalibration, TrackedPointArray

DEADLINE = 90.0  # [s]
LATE = 0.1       # from exposure to driver; about 0.01 while the simulation keeps real time [s]
GAP = 0.05       # of the truth, over which it can be interpolated [s]
PERIODS = 3      # that are tried; people_rig.yaml is made for two minutes


class NodeTest(unittest.TestCase):
    """Waits for what nodes do."""

    def wait(self, condition, what):
        deadline = time.monotonic() + DEADLINE
        while not condition():
            self.assertLess(time.monotonic(), deadline, 'waited too long for ' + what)
            time.sleep(0.01)


class LiveRigTest(NodeTest):
    """Listens to the nodes on the simulated rig of the file ~description."""

    @classmethod
    def setUpClass(cls):
        rospy.init_node(cls.__name__.lower() + '_rostest')
        cls.path = rospy.get_param('~description')
        cls.description = read_yaml(cls.path)
        cls.scene = scene.read_scene(cls.path)
        cls.leds = sorted(cls.description['leds'])
        cls.images = collections.Counter()
        cls.truth = {led: [] for led in cls.leds}
        cls.points = []
        cls.exposures = {camera.name: [] for camera in cls.scene.cameras}
        cls.image_subscribers = [
            rospy.Subscriber(camera.name + '/ir_blobs', IrBlobArray,
                             lambda _, name=camera.name: cls.images.update([name]))
            for camera in cls.scene.cameras]
        rospy.Subscriber('simulation/exposures', IrBlobArray, lambda message: cls.exposures[
            message.camera].append((message.header.stamp.to_sec(), message.arrival.to_sec(),
                                    rospy.get_time())))
        for led in cls.leds:
            rospy.Subscriber('simulation/truth/' + led, PointStamped, cls.truth[led].append)
        rospy.Subscriber('points', TrackedPointArray, cls.points.append, queue_size=1000,
                         tcp_nodelay=True)
        cls.rig_publisher = rospy.Publisher('calibration/rig', RigCalibration, queue_size=1,
                                            latch=True)

    def calibrate(self, masks=()):
        """Waits until all cameras deliver images and gives the tracker the true rig.
        @param masks: pairs of a camera's name and an IrMask."""
        self.wait(lambda: len(self.images) == len(self.scene.cameras), 'images of all cameras')
        while self.image_subscribers:  # 400 messages a second that nobody needs any more
            self.image_subscribers.pop().unregister()
        rig = true_rig(self.path)
        for camera in rig.cameras:
            camera.masks.extend(mask for name, mask in masks if name == camera.name)
        self.rig_publisher.publish(rig)

    def wait_until(self, time):
        """Waits until there are points and truth of that time [s]."""
        for messages in [self.points] + list(self.truth.values()):
            self.wait(lambda: messages and messages[-1].header.stamp.to_sec() > time,
                      f'the instant {time:.3f}')

    def in_real_time(self, judge, begin_at, duration, before=0.0, listening=False):
        """Judges a period, and a later one if it fails where the simulation did not keep real time.

        A simulation that the computer stops sends no images, then old ones at once. No remote does,
        and a tracker cannot know where the LEDs were. The simulation itself tells, and it does not
        wait for drivers or tracker: what they miss or delay always counts.
        @param judge: gets the begin and the end [s]; raises AssertionError.
        @param begin_at: returns the begin, once the period can begin; called for each one tried.
        @param duration: of the period [s]
        @param before: this time [s] before the begin matters, too.
        @param listening: this program, too, must have kept real time, since it measures ages.
        @return: begin and end of the period that passed
        """
        for period in range(1, PERIODS + 1):
            begin = begin_at()
            end = begin + duration
            self.wait_until(end)
            try:
                judge(begin, end)
                return begin, end
            except AssertionError as error:
                if period == PERIODS or self.kept_real_time(begin - before, end, listening):
                    raise
                print(f'a later time is judged, since real time was not kept: {error}')

    def kept_real_time(self, begin, end, listening=False):
        """Whether all images exposed in that time [s] were handed over in time, by a clock that was
        not set, and the truth of that time was heard without gaps."""
        self.wait(lambda: all(heard and heard[-1][0] > end for heard in self.exposures.values()),
                  f'the exposures until {end:.3f}')
        exposures = np.array([each for heard in self.exposures.values() for each in list(heard)
                              if begin <= each[0] <= end]).reshape(-1, 3)
        delays = exposures[:, 1] - exposures[:, 0]
        gaps = [np.diff([stamp for stamp in stamps if begin <= stamp <= end]).max(initial=0.0)
                for stamps in ([m.header.stamp.to_sec() for m in list(messages)]
                               for messages in self.truth.values())]
        return (delays.min(initial=0.0) >= 0.0 and delays.max(initial=0.0) < LATE
                and max(gaps) < GAP
                and not (listening and np.median(exposures[:, 2] - exposures[:, 0]) >= LATE))

    def truth_at(self, led, stamps):
        """N x 3 true positions at N times."""
        messages = list(self.truth[led])
        times = [m.header.stamp.to_sec() for m in messages]
        places = np.array([(m.point.x, m.point.y, m.point.z) for m in messages])
        return np.stack([np.interp(stamps, times, places[:, axis]) for axis in range(3)], axis=1)
