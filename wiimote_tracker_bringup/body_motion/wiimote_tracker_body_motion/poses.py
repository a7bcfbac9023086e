"""Poses over time, from a topic of a bag."""

import dataclasses
import functools

import numpy as np
import rosbag
from scipy.spatial.transform import Rotation, Slerp

from wiimote_tracker_bringup import timeseries
from wiimote_tracker_bringup.errors import Refusal

BACK = 1.0  # by which stamps go back only where a clock was set, or a replay began again [s]
NEIGHBOURS = 9  # of a smoothed pose


def numbers(pose):
    """Position and quaternion."""
    position, turn = pose.position, pose.orientation
    return position.x, position.y, position.z, turn.x, turn.y, turn.z, turn.w


POSE_OF = {'nav_msgs/Odometry': lambda message: numbers(message.pose.pose),
           'geometry_msgs/PoseWithCovarianceStamped': lambda message: numbers(message.pose.pose),
           'geometry_msgs/PoseStamped': lambda message: numbers(message.pose)}


@dataclasses.dataclass
class Poses:
    """times: n, ascending [s]; positions: n x 3 [m]; rotations: n; of the frame child in parent."""

    times: np.ndarray
    positions: np.ndarray
    rotations: Rotation
    parent: str = 'world'
    child: str = 'body'

    def at(self, times):
        """Interpolated, linearly and by slerp, at times from the first to the last."""
        return dataclasses.replace(
            self, times=times, positions=timeseries.at(self.times, self.positions, times),
            rotations=self._slerp(times))

    @functools.cached_property
    def _slerp(self):
        return Slerp(self.times, self.rotations)

    def covers(self, times, longest_gap):
        """Mask of the times between two poses that are no further apart than longest_gap [s]."""
        return timeseries.covers(self.times, times, longest_gap)

    def chosen(self, which):
        return dataclasses.replace(self, times=self.times[which], positions=self.positions[which],
                                   rotations=self.rotations[which])

    def shifted(self, offset):
        """By another clock: offset is added to the times [s]."""
        return dataclasses.replace(self, times=self.times + offset)

    def of_mounted(self, rotation, translation):
        """The poses of a frame that is fixed to this one, where it has this pose."""
        return dataclasses.replace(self, rotations=self.rotations * rotation,
                                   positions=self.positions + self.rotations.apply(translation))


def smoothed(poses):
    """On a grid of a quarter of the median interval, without pauses: local quadratic regression.

    Between two noisy poses, linear interpolation is less noisy in the middle than at the ends, so
    that a time offset would be drawn to where most times are in the middle. In a pause a parabola
    would run far away.
    """
    interval = np.median(np.diff(poses.times))
    times = np.arange(poses.times[0], poses.times[-1], 0.25 * interval)
    times = times[poses.covers(times, NEIGHBOURS // 2 * interval)]
    first = np.searchsorted(poses.times, times) - NEIGHBOURS // 2
    first = np.clip(first, 0, max(len(poses.times) - NEIGHBOURS, 0))
    near = np.minimum(first[:, None] + np.arange(NEIGHBOURS), len(poses.times) - 1)
    center = near[:, NEIGHBOURS // 2]
    away = (poses.times[near] - times[:, None]) / interval
    powers = away[..., None] ** np.arange(3)
    weighted = powers * np.exp(-0.5 * (away / 1.5) ** 2)[..., None]
    # The value of the parabola at 0, as weights of the neighbours.
    weights = np.linalg.solve(weighted.transpose(0, 2, 1) @ powers,
                              weighted.transpose(0, 2, 1))[:, 0]
    turns = (poses.rotations[np.repeat(center, NEIGHBOURS)].inv()
             * poses.rotations[near.reshape(-1)]).as_rotvec().reshape(*near.shape, 3)
    return dataclasses.replace(
        poses, times=times, positions=np.einsum('ij,ijk->ik', weights, poses.positions[near]),
        rotations=poses.rotations[center] * Rotation.from_rotvec(
            np.einsum('ij,ijk->ik', weights, turns)))


def read(path, topic):
    """The poses of a topic. Throws Refusal if it has none, or if the bag cannot be read."""
    rows, message = read_rows(path, topic, POSE_OF, 'poses')
    rows = rows[np.linalg.norm(rows[:, 4:], axis=1) > 0.5]
    if len(rows) < 2:
        raise Refusal(f'{topic} in {path} has fewer than two poses at different times; '
                      'record it while the body is tracked')
    return Poses(rows[:, 0], rows[:, 1:4], Rotation.from_quat(rows[:, 4:]),
                 message.header.frame_id,
                 getattr(message, 'child_frame_id', '') or topic.strip('/'))


def read_rows(path, topic, numbers_of, what):
    """Stamps [s], ascending, with the finite numbers of a topic, and its last message.

    numbers_of: by type, a function of a message. what: the topic has, for messages.
    """
    rows, message = [], None
    try:
        with rosbag.Bag(path) as bag:
            topics = bag.get_type_and_topic_info().topics
            usable = {name: info.msg_type for name, info in topics.items()
                      if info.msg_type in numbers_of}
            if topic not in usable:
                raise Refusal(f'{path} has no {what} on {topic}. Topics with {what}: '
                              + (', '.join(sorted(usable)) or 'none'))
            for _, message, _ in bag.read_messages(topics=[topic]):
                rows.append((message.header.stamp.to_sec(), *numbers_of[usable[topic]](message)))
    except rosbag.ROSBagException as error:
        raise Refusal(f'{path} cannot be read ({error}); if it was not closed, repair it '
                      'with rosbag reindex') from error
    except OSError as error:
        raise Refusal(f'{path} cannot be read ({error.strerror}); name a bag') from error
    if not rows:
        raise Refusal(f'{topic} in {path} has fewer than two {what}; record it again')
    rows = np.array(rows)
    if not rows[:, 0].any():
        raise Refusal(f'all stamps of {topic} in {path} are 0: its driver must say when it '
                      'measured')
    back = np.maximum.accumulate(rows[:, 0]) - rows[:, 0]
    if back.max() > BACK:
        raise Refusal(f'stamps of {topic} in {path} go back by {back.max():.1f} s, so that '
                      'two times would be mixed: record again without setting the clock, '
                      'or keep one part with rosbag filter')
    rows = rows[np.isfinite(rows).all(axis=1)]
    return rows[np.unique(rows[:, 0], return_index=True)[1]], message
