"""Stores recent messages of a running tracker."""

import collections
import functools
import time

import numpy as np

from wiimote_tracker_launch.master import master_problem

from wiimote_tracker_bringup.errors import Refusal
from wiimote_tracker_bringup.waiting import wait_until
from wiimote_tracker_evaluation.live.dialogue import SKIP, Dialogue

KEPT = 60.0         # [s]
STILL_TIME = 1.5    # at rest, for a measurement [s]
STILL = 0.01        # greatest motion at rest [m]
ELSEWHERE = 0.15    # least distance from the previous place [m]
FEWEST = 20         # least number of points at a place
THERE = 10.0        # to hear a running tracker [s]

Seen = collections.namedtuple('Seen', 'stamp heard leds')  # [s since 1970]; leds: of one instant
Led = collections.namedtuple('Led', 'id label since tracked position')
Place = collections.namedtuple('Place', 'position scatter points')  # mean, standard deviation [m]


class RunningTracker:
    """Points and rig of a running tracker. @raise Refusal: there is no ROS master."""

    def __init__(self):
        import rospy
        problem = master_problem('start the tracker first: roslaunch wiimote_tracker_bringup '
                                 'tracker.launch cameras:=FILE')
        if problem:
            raise Refusal(problem)
        if not rospy.core.is_initialized():
            rospy.init_node('evaluation', anonymous=True, disable_signals=True)
        from wiimote_tracker_msgs.msg import RigCalibration, TrackedPointArray
        self._rospy = rospy
        self._seen = collections.deque()
        self._rig = None
        self._subscribers = [
            rospy.Subscriber('points', TrackedPointArray, self._on_points, queue_size=1000,
                             tcp_nodelay=True),
            rospy.Subscriber('calibration/rig', RigCalibration, self._on_rig)]

    def close(self):
        for subscriber in self._subscribers:
            subscriber.unregister()

    def is_simulated(self):
        """Whether the remotes are virtual, which the report must state."""
        return any(name.startswith('/simulation/')
                   for name, _ in self._rospy.get_published_topics())

    def now(self):
        return self._rospy.get_time()

    def _on_points(self, message):
        leds = [Led(p.id, p.label, p.label_since.to_sec(), p.state == p.TRACKED,
                    np.array([p.position.x, p.position.y, p.position.z]))
                for p in message.points if p.state in (p.TRACKED, p.PREDICTED)]
        heard = self._rospy.get_time()
        self._seen.append(Seen(message.header.stamp.to_sec(), heard, leds))
        while self._seen[0].heard < heard - KEPT:
            self._seen.popleft()

    def _on_rig(self, message):
        self._rig = message

    # --- The rig

    def rig(self):
        wait_until(lambda: self._rig is not None, THERE,
                   f'the tracker has no calibration: calibrate first ({self._calibrate()})')
        return self._rig

    def side(self):
        """Side of the square used to calibrate the rig [m]."""
        sides = self.rig().square_sides
        if not sides or len(set(sides)) > 1:
            raise Refusal('the ten points need a rig calibrated with a square; its '
                          f"sides are {list(sides) or 'unknown'}")
        return sides[0]

    def up(self):
        """1 if z points up; -1 if down, as in the paper: cameras are above the floor."""
        heights = [camera.world_from_camera.position.z for camera in self.rig().cameras]
        return 1.0 if np.mean(heights) > 0.0 else -1.0

    # --- The LEDs

    def wait_for_points(self):
        wait_until(lambda: self._seen, THERE,
                   f'no points come; see {self._calibrate()} for what the cameras see')

    def _calibrate(self):
        """The command, in this program's namespace."""
        namespace = self._rospy.get_namespace().rstrip('/')
        return (f'ROS_NAMESPACE={namespace} ' if namespace else '') + (
            'rosrun wiimote_tracker_calibration calibrate')

    def since(self, begin):
        """Points that arrived after a time [s since 1970]."""
        return [seen for seen in list(self._seen) if seen.heard > begin]

    def newest(self):
        return self._seen[-1] if self._seen else None

    def still(self, dialogue, before=None):
        """Waits until the only LED has been at rest for some time, away from the previous place
        [m]. Returns the Place; None if the person skips it."""
        begin = self.now()
        while dialogue.typed() != SKIP:
            rows = [(seen.stamp, seen.leds)
                    for seen in self.since(max(begin, self.now() - STILL_TIME))]
            place = self._place(rows) if self.now() - begin > STILL_TIME else None
            if place is None:
                dialogue.passing('waiting for one still LED (%d seen)'
                                 % (len(rows[-1][1]) if rows else 0))
            elif before is not None and np.linalg.norm(place.position - before) < ELSEWHERE:
                dialogue.passing('waiting for the LED at the next place')
            else:
                dialogue.beep()
                return place
            time.sleep(0.05)
        return None

    @staticmethod
    def _place(rows):
        if len(rows) < FEWEST or any(len(leds) != 1 or not leds[0].tracked for _, leds in rows):
            return None
        positions = np.array([leds[0].position for _, leds in rows])
        mean = positions.mean(axis=0)
        if np.linalg.norm(positions - mean, axis=1).max() > STILL:
            return None
        return Place(mean, float(np.sqrt(((positions - mean) ** 2).sum() / (len(rows) - 1))),
                     len(rows))


def with_tracker(measure):
    """Makes measure(run, tracker, dialogue) the live(run) of a section."""
    @functools.wraps(measure)
    def live(run, dialogue=None):
        tracker = RunningTracker()
        try:
            run.simulated = tracker.is_simulated()
            measure(run, tracker, dialogue or Dialogue())
        finally:
            tracker.close()
    return live
