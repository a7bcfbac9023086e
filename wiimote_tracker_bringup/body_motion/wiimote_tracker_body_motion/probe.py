"""Makes a tracked body with a tip measure points.

  rosrun wiimote_tracker_bringup probe _body:=wand

The service ~pivot finds the tip while it stays at one place and the body is turned about it.
~save_point, button A of joy, or the tip at rest elsewhere (at_rest) appends where the tip is to the
file.

Private parameters:
  body      name of the tracked body (needed)
  tip       in the body's frame [m] (default: [0, 0, 0]); ~pivot replaces it
  duration  of a pivot [s] (default: 10)
  file      table of the saved points [s, m] (default: ~/probe_points.csv)
  at_rest   save a point when the tip is held still for 0.5 s, 0.05 m or more from the last one
            (default: false)
"""

import collections
import copy
import os
import sys
import threading
import time

import numpy as np
import rosgraph
import rospy
from geometry_msgs.msg import PointStamped, PoseWithCovarianceStamped
from nav_msgs.msg import Odometry
from sensor_msgs.msg import Joy
from scipy.spatial.transform import Rotation
from std_srvs.srv import Trigger, TriggerResponse

from wiimote_tracker_body_motion import pivot
from wiimote_tracker_bringup import nodes, published_bodies, rigid_motion
from wiimote_tracker_bringup.errors import Refusal, sentence_of

INTERVAL = 0.05  # of the poses of a pivot, whose errors are then nearly independent [s]
REST = 0.5  # of which a saved point is the mean [s]
HIDDEN = 0.5  # without poses, after which the last ones tell nothing of the present [s]
BUTTON = 2  # index in joy: A of a Wii Remote
AWAY = 0.05  # from the last point, where a tip at rest is another one [m]
PARAMETERS = {'at_rest', 'body', 'duration', 'file', 'tip'}
HEADER = 'time [s],x [m],y [m],z [m],stddev_x [m],stddev_y [m],stddev_z [m]\n'


def arrays(messages):
    """Times, positions, rotations and covariances (n x 6 x 6) of nav_msgs/Odometry."""
    poses = [message.pose.pose for message in messages]
    turns = [pose.orientation for pose in poses]
    return (np.array([message.header.stamp.to_sec() for message in messages]),
            np.array([[pose.position.x, pose.position.y, pose.position.z] for pose in poses]),
            Rotation.from_quat([[turn.x, turn.y, turn.z, turn.w] for turn in turns]),
            np.array([message.pose.covariance for message in messages]).reshape(-1, 6, 6))


class Probe:
    """The tip, and where it was. tip: position in the body's frame [m] and its covariance. now:
    gives the time [s]."""

    def __init__(self, tip, duration, file, now=time.monotonic):
        self.tip, self.tip_covariance = np.array(tip, dtype=float), np.zeros((3, 3))
        self.duration, self.file = duration, os.path.expanduser(file)
        self.messages = collections.deque()  # of the newest `duration`
        self.now, self.seen = now, now()  # the time, and that of the last message
        self.saved = np.full(3, np.inf)  # the last point [m]
        self.saving = threading.Lock()  # button, service and timer are threads of their own

    def add(self, message):
        if self.messages and message.header.stamp < self.messages[-1].header.stamp:
            self.messages.clear()  # time jumped back, as when a bag starts again
        self.messages.append(message)
        self.seen = self.now()
        while message.header.stamp - self.messages[0].header.stamp > rospy.Duration(self.duration):
            self.messages.popleft()

    def newest(self, duration, hidden=HIDDEN):
        """The messages of the last duration [s]. Throws Refusal if the newest is older than
        hidden [s]."""
        messages = list(self.messages)
        if not messages:
            raise Refusal('the probe was never seen: check that the tracker runs and knows '
                          'the body, and turn it towards the cameras')
        if self.now() - self.seen > hidden:
            raise Refusal(f'the probe was last seen {self.now() - self.seen:.1f} s ago: '
                          'turn it towards the cameras')
        start = messages[-1].header.stamp - rospy.Duration(duration)
        return [message for message in messages if message.header.stamp >= start]

    def points(self, messages):
        """In the world: n x 3 [m], and covariances, n x 3 x 3."""
        _, positions, rotations, covariances = arrays(messages)
        turned = rotations.as_matrix()
        return (positions + rotations.apply(self.tip),
                rigid_motion.covariance_of_point(self.tip, rotations, covariances)
                + turned @ self.tip_covariance @ turned.transpose(0, 2, 1))

    def tip_pose(self, message):
        """The body's orientation, at the tip."""
        (point,), (of_point,) = self.points([message])
        pose = PoseWithCovarianceStamped(header=message.header, pose=copy.deepcopy(message.pose))
        place = pose.pose.pose.position
        arm = point - [place.x, place.y, place.z]
        place.x, place.y, place.z = point
        moved = np.eye(6)
        moved[:3] = rigid_motion.by_pose(arm)
        covariance = moved @ np.reshape(message.pose.covariance, (6, 6)) @ moved.T
        covariance[:3, :3] = of_point  # with that of the tip
        pose.pose.covariance = covariance.reshape(-1).tolist()
        return pose

    def last_stamp(self):
        return self.messages[-1].header.stamp.to_sec() if self.messages else 0.0

    def pivot(self, since=0.0):
        """Solves for the tip from the poses after this stamp [s]. @returns a sentence."""
        times, positions, rotations, covariances = arrays(self.newest(self.duration, self.duration))
        after = np.flatnonzero(times > since)
        which = after[np.unique(np.floor(times[after] / INTERVAL), return_index=True)[1]]
        found = pivot.solve(positions[which], rotations[which], covariances[which])
        self.tip, self.tip_covariance = found.position, found.covariance
        numbers = ', '.join(f'{value:.4f}' for value in found.position)
        return (f'tip: [{numbers}] +- {1e3 * np.sqrt(np.trace(found.covariance)):.2f} mm, '
                f'residual {1e3 * found.residual:.1f} mm')

    def save_point(self):
        """Appends where the tip is to the file. @returns a sentence."""
        messages = self.newest(REST)
        points, covariances = self.points(messages)
        spread = np.sqrt(points.var(axis=0).sum())
        stddevs = np.sqrt(np.diagonal(covariances.mean(axis=0)))
        if spread > 3.0 * np.linalg.norm(stddevs):
            raise Refusal(f'the tip moved by {1e3 * spread:.0f} mm (RMS) in the last '
                          f'{REST:g} s; hold it still')
        point = points.mean(axis=0)
        row = [messages[-1].header.stamp.to_sec(), *point, *stddevs]
        with self.saving:
            is_new = not os.path.exists(self.file)
            with open(self.file, 'a') as file:
                file.write((HEADER if is_new else '') + ','.join(f'{value:.6f}' for value in row)
                           + '\n')
            self.saved = point
        return f'{self.file}: ' + ', '.join(f'{value:.4f}' for value in point)

    def rests_elsewhere(self):
        """Whether the tip has been held still for REST, away from the last point."""
        messages = self.newest(REST)
        times = [message.header.stamp.to_sec() for message in messages]
        if times[-1] - times[0] < 0.9 * REST or np.diff(times).max() > 0.2 * REST:
            return False
        points, covariances = self.points(messages)
        stddev = np.sqrt(np.trace(covariances.mean(axis=0)))
        return (np.sqrt(points.var(axis=0).sum()) < stddev
                and np.linalg.norm(points.mean(axis=0) - self.saved) > AWAY)


def read_body():
    """The parameter ~body. Throws Refusal if it is no name."""
    body = rospy.get_param('~body', '')
    if not body or not isinstance(body, str) or not rosgraph.names.is_legal_name(body):
        raise Refusal(f'{rospy.resolve_name("~body")} is {body!r}: give the name of the '
                      'tracked body, such as _body:=wand')
    return body


def read_tip():
    """The parameter ~tip, 3 [m]. Throws Refusal if it is none."""
    value = rospy.get_param('~tip', [0.0, 0.0, 0.0])
    try:
        tip = np.array(value, dtype=float)
    except (TypeError, ValueError):
        tip = np.empty(0)
    if tip.shape != (3,) or not np.isfinite(tip).all():
        raise Refusal(f'{rospy.resolve_name("~tip")} is {value}: give three finite numbers '
                      '[m]')
    return tip


class Node:
    """Publishes <body>/tip and <body>/tip_pose. Services: ~pivot, ~save_point. Saves a point when
    button A of joy is pressed and, with ~at_rest, when the tip is held still elsewhere."""

    def __init__(self):
        nodes.refuse_unknown(rospy.get_param(rospy.get_name(), {}), PARAMETERS)
        body = read_body()
        self.body = rospy.resolve_name(body)
        self.probe = Probe(read_tip(), nodes.number('~duration', 10.0, 0.1, 3600.0),
                           rospy.get_param('~file', '~/probe_points.csv'), rospy.get_time)
        self.point = rospy.Publisher(f'{body}/tip', PointStamped, queue_size=10)
        self.pose = rospy.Publisher(f'{body}/tip_pose', PoseWithCovarianceStamped, queue_size=10)
        rospy.Subscriber(f'{body}/odometry', Odometry, self.on_odometry, queue_size=100,
                         tcp_nodelay=True)
        self.pressed = True  # joy is latched
        rospy.Subscriber('joy', Joy, self.on_joy, queue_size=10)
        rospy.Timer(rospy.Duration(published_bodies.PATIENCE), self.on_patience, oneshot=True,
                    reset=True)
        if rospy.get_param('~at_rest', False):
            rospy.Timer(rospy.Duration(0.1), self.on_timer, reset=True)
        rospy.Service('~pivot', Trigger, self.on_pivot)
        rospy.Service('~save_point', Trigger, lambda request: self.answer(self.probe.save_point))
        # A tip of an earlier start may still be among the parameters.
        rospy.loginfo(f'the tip is at {self.probe.tip.tolist()} [m] in the frame of {body}; points '
                      f'go to {self.probe.file}')

    def on_odometry(self, message):
        self.probe.add(message)
        pose = self.probe.tip_pose(message)
        self.point.publish(PointStamped(header=message.header, point=pose.pose.pose.position))
        self.pose.publish(pose)

    def on_patience(self, _):
        try:
            absence = not self.probe.messages and published_bodies.absence(
                rospy.get_name(), self.body, '_body:=')
        except (OSError, rosgraph.MasterException):
            return  # the master has ended
        if absence:
            rospy.logwarn(absence)

    def on_pivot(self, _):
        since = self.probe.last_stamp()
        rospy.sleep(self.probe.duration)
        return self.answer(lambda: self.probe.pivot(since))

    def on_joy(self, message):
        pressed = len(message.buttons) > BUTTON and bool(message.buttons[BUTTON])
        if pressed and not self.pressed:
            self.log(self.answer(self.probe.save_point))
        self.pressed = pressed

    def on_timer(self, _):
        try:
            rests = bool(self.probe.messages) and self.probe.rests_elsewhere()
        except (Refusal, ValueError):
            return  # time jumped back, or a pose is invalid
        if rests:
            self.log(self.answer(self.probe.save_point))

    @staticmethod
    def log(answer):
        (rospy.loginfo if answer.success else rospy.logwarn)(answer.message)

    @staticmethod
    def answer(action):
        try:
            return TriggerResponse(success=True, message=action())
        except (ValueError, np.linalg.LinAlgError) as error:
            return TriggerResponse(success=False, message='the poses of the probe cannot be used '
                                   f'({error}); turn it to other sides and try again')
        except (Refusal, OSError) as error:
            return TriggerResponse(success=False, message=sentence_of(error))


def main():
    nodes.start('probe', __doc__)
    try:
        Node()
    except Refusal as error:
        sys.exit(f'probe: {error}')
    rospy.spin()
