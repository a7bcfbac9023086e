"""Where the base of a robot sits on a tracked body, from the motions of both (A X = X B).

The body's pose in the world times X = body_from_base is the base's pose in the world, which is
that of the odometry, world_from_odom * odom_from_base, at the time by the clock of the odometry.
Odometry drifts, so each segment of time has its own world_from_odom. X, the clock offset and these
are solved together by Gauss-Newton, which is maximum likelihood for white noise. The start is that
of R. Y. Tsai and R. K. Lenz (IEEE Trans. Robotics and Automation 5(3), 1989): first the rotation from
rotation vectors, then the translation, which is linear.
"""

import dataclasses
import functools

import numpy as np
from scipy.spatial.transform import Rotation

from wiimote_tracker_evaluation.errors import ExperimentError
from wiimote_tracker_evaluation.motion.mount import Mount
from wiimote_tracker_evaluation.motion.poses import smoothed

LAG = 0.5  # of rotations that tell the axes [s]
LEAST_TURN = np.radians(3.0)  # RMS about the second axis in LAG, to tell the transform
GRID = 0.01  # of the search for the offset [s]
LONGEST_GAP = 0.1  # between two poses to interpolate [s]
MOST_POSES = 20000
ITERATIONS = 15
COMMON, LOCAL = 7, 6  # parameters: of the mount; of each segment


def solve(body, base, segment=5.0, largest_offset=2.0):
    """body, base: Poses of both. segment: in which the odometry hardly drifts [s]. @returns Mount"""
    offset = start_of_offset(body, base, largest_offset)
    body = common_part(body, base.shifted(offset))
    base = smoothed(base)
    rotation = start_of_rotation(body, base.shifted(offset))
    problem = Problem(body, base, segment)
    state = problem.start(rotation, offset)
    for _ in range(ITERATIONS):
        previous = state
        state, covariance = problem.step(state)
        change = np.r_[state.translation - previous.translation, state.offset - previous.offset]
        if (np.abs(change) < 0.05 * np.sqrt(np.diag(covariance)[3:])).all():
            break
    else:
        raise ExperimentError('no solution was found: do both topics belong to one robot?')
    return Mount(state.rotation, state.translation, state.offset, covariance, body.child, base.child)


def turns(poses, times, lag):
    """Rotation vectors in the moving frame from each time to the one lag later, n x 3 [rad]."""
    before, after = poses.at(times).rotations, poses.at(times + lag).rotations
    return (before.inv() * after).as_rotvec()


def start_of_offset(body, base, largest):
    """The shift for which the speeds of rotation, which do not depend on X, agree best [s]."""
    lag = 10 * GRID
    if min(poses.times[-1] - poses.times[0] for poses in (body, base)) < 10.0:
        raise ExperimentError('the bag has less than 10 s of motion; record a minute')
    speeds = []
    for poses in (body, base):
        times = np.arange(poses.times[0], poses.times[-1] - lag, GRID)
        speed = np.linalg.norm(turns(poses, times, lag), axis=1)
        speeds.append(speed - speed.mean())
    product = np.correlate(*speeds, mode='full')  # at 0: the last of base with the first of body
    shifts = body.times[0] - base.times[0] + GRID * (np.arange(len(product)) - len(speeds[1]) + 1)
    product[np.abs(shifts) > largest] = -np.inf
    if not np.isfinite(product).any():
        raise ExperimentError(f'the two topics share no time within {largest:g} s: use '
                              '--largest-offset, if their clocks differ by more')
    return shifts[np.argmax(product)]


def common_part(body, base):
    """The poses of the body for which the base has some, with room for a better offset."""
    room = 3 * GRID
    inside = (body.times > base.times[0] + room) & (body.times < base.times[-1] - room)
    which = np.flatnonzero(inside & base.covers(body.times, LONGEST_GAP))
    which = which[::max(1, -(-len(which) // MOST_POSES))]
    if len(which) < 100:
        raise ExperimentError('fewer than 100 poses of the body lie between poses of the base')
    return body.chosen(which)


def start_of_rotation(body, base):
    """X's rotation. Throws ExperimentError if the rotations do not tell the transform."""
    end = min(body.times[-1], base.times[-1]) - LAG
    times = body.times[body.times < end]
    times = times[body.covers(times + LAG, LONGEST_GAP)]
    if not len(times):
        raise ExperimentError(f'no two poses are {LAG:g} s apart')
    of_body, of_base = turns(body, times, LAG), turns(base, times, LAG)
    spread = np.sqrt(np.linalg.eigvalsh(of_base.T @ of_base / len(times)))[::-1]
    if spread[0] < LEAST_TURN:
        raise ExperimentError(
            f'the base turns by {np.degrees(spread[0]):.1f} degrees in {LAG:g} s (RMS); '
            f'{np.degrees(LEAST_TURN):.0f} are needed: turn it more, about two axes')
    if spread[1] < LEAST_TURN:
        raise ExperimentError(
            'the base turns about one axis only, so the transform along it cannot be told: '
            f'about a second axis by {np.degrees(spread[1]):.1f} degrees in {LAG:g} s (RMS); '
            f'{np.degrees(LEAST_TURN):.0f} are needed. Tilt it by hand')
    return Rotation.align_vectors(of_body, of_base)[0]


@dataclasses.dataclass
class State:
    """body_from_base, the offset [s], and world_from_odom of each segment."""

    rotation: Rotation
    translation: np.ndarray
    offset: float
    worlds: Rotation
    places: np.ndarray

    def moved(self, common, local):
        """common: 7, rotations about the body's axes first. local: segments x 6."""
        return State(Rotation.from_rotvec(common[:3]) * self.rotation,
                     self.translation + common[3:6], self.offset + common[6],
                     Rotation.from_rotvec(local[:, :3]) * self.worlds, self.places + local[:, 3:])


class Problem:
    """Residuals of one bag, and steps of Gauss-Newton."""

    def __init__(self, body, base, segment):
        self.body = body
        self.base = base
        number = np.floor((body.times - body.times[0]) / segment).astype(int)
        used, self.segment = np.unique(number, return_inverse=True)
        self.seconds = np.unique(np.floor(body.times), return_inverse=True)[1]
        self.segments = [np.flatnonzero(self.segment == k) for k in range(len(used))]
        middles = [base.positions[np.searchsorted(base.times, body.times[each[0]]) - 1]
                   for each in self.segments]
        self.middles = np.array(middles)  # what the segments turn about, in the odometry's frame

    @functools.lru_cache(maxsize=1)
    def base_at(self, offset):
        return self.base.at(np.clip(self.body.times - offset, *self.base.times[[0, -1]]))

    def start(self, rotation, offset):
        base, body = self.base_at(offset), self.body
        turned = body.rotations * rotation * base.rotations.inv()
        worlds = Rotation.from_quat([turned[each].mean().as_quat() for each in self.segments])
        moved = worlds[self.segment].apply(base.positions - self.middles[self.segment])
        arms, rests = body.rotations.as_matrix(), moved - body.positions
        mean = [[values[each].mean(axis=0) for each in self.segments] for values in (arms, rests)]
        mean_arms, mean_rests = np.array(mean[0]), np.array(mean[1])
        translation = np.linalg.lstsq((arms - mean_arms[self.segment]).reshape(-1, 3),
                                      (rests - mean_rests[self.segment]).reshape(-1), rcond=None)[0]
        return State(rotation, translation, offset, worlds, mean_arms @ translation - mean_rests)

    def residuals(self, state):
        """Rotation [rad] and translation [m], n x 6: odometry against tracker, in the world.

        The odometry, which is the smoother of the two, predicts the body's pose. The other way
        round the tracker's noise of rotation would shorten the lever arm.
        """
        base, body = self.base_at(state.offset), self.body
        worlds = state.worlds[self.segment]
        turned = worlds * base.rotations * state.rotation.inv()
        moved = worlds.apply(base.positions - self.middles[self.segment])
        there = moved + state.places[self.segment] - turned.apply(state.translation)
        return np.hstack([(turned * body.rotations.inv()).as_rotvec(), there - body.positions])

    def derivatives(self, state):
        """n x 6 x (COMMON + LOCAL), by central differences."""
        steps = 1e-4 * np.eye(COMMON + LOCAL)
        columns = []
        for step in steps:
            local = np.tile(step[COMMON:], (len(self.segments), 1))
            columns.append((self.residuals(state.moved(step[:COMMON], local))
                            - self.residuals(state.moved(-step[:COMMON], -local))) / 2e-4)
        return np.stack(columns, axis=2)

    def step(self, state):
        """The next state, and the covariance of the common parameters.

        The covariance is White's (Econometrica 48(4), 1980) with the gradients of each second
        summed, because residuals are correlated in time.
        """
        residuals = self.residuals(state)
        scale = np.sqrt((residuals ** 2).reshape(-1, 2, 3).mean(axis=(0, 2))).repeat(3)
        residuals = residuals / scale
        derivatives = self.derivatives(state) / scale[:, None]
        gradients, information, parts = np.zeros((self.seconds[-1] + 1, COMMON)), 0.0, []
        for each in self.segments:  # without what its own parameters explain
            rest = residuals[each].reshape(-1)
            common, local = np.split(derivatives[each].reshape(len(rest), -1), [COMMON], axis=1)
            own = np.linalg.pinv(local)
            common_left, rest_left = common - local @ (own @ common), rest - local @ (own @ rest)
            information = information + common_left.T @ common_left
            np.add.at(gradients, self.seconds[each].repeat(6), common_left * rest_left[:, None])
            parts.append((own @ rest, own @ common))
        inverse = np.linalg.inv(information)
        common = -inverse @ gradients.sum(axis=0)
        local = np.array([-rest - by_common @ common for rest, by_common in parts])
        number = len(gradients)
        covariance = inverse @ gradients.T @ gradients @ inverse * number / max(number - COMMON, 1)
        return state.moved(common, local), covariance
