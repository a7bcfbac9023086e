"""Where the base of a robot sits on a tracked body, from odometry (A X = X B).

The odometry tells how the base moves from one state of the chain to the next, with errors that add
up to a random walk.
"""

import functools

import numpy as np

from wiimote_tracker_body_motion import mount_solver, mount_start
from wiimote_tracker_body_motion.poses import smoothed

INTERVAL = 0.2  # in which the odometry hardly drifts [s]


def solve(body, base, largest_offset=2.0, report=lambda sentence: None):
    """body, base: Poses of both. report: see mount_solver. @returns Mount"""
    body, rotation, offset = mount_start.start(body, base, largest_offset)
    problem = Problem(body, smoothed(base))
    return mount_solver.solve(problem, problem.start(rotation, offset),
                              (body.child, base.child), report)


class Problem:
    """Of mount_solver. States: pose of the base in the world at each of times."""

    noise = 1e-3, 1e-3  # of the drift [rad, m / sqrt(s)]

    def __init__(self, body, base):
        self.body, self.base = body, base
        number = int(np.ceil((body.times[-1] - body.times[0]) / INTERVAL))
        self.times = body.times[0] + INTERVAL * np.arange(number + 1)
        self.durations = np.full((number, 1), INTERVAL)

    def rows(self, _):
        since = self.body.times - self.body.times[0]
        return np.minimum((since / INTERVAL).astype(int), len(self.durations) - 1)

    @functools.lru_cache(maxsize=2)
    def base_at(self, offset):
        """At the times of the states and of the body's poses."""
        return [self.base.at(np.clip(times - offset, *self.base.times[[0, -1]]))
                for times in (self.times, self.body.times)]

    def start(self, rotation, offset):
        body = self.body.at(np.minimum(self.times, self.body.times[-1]))
        return mount_solver.State(rotation, np.array([0.0, 0.0, 0.0, offset]),
                                  body.rotations * rotation,
                                  np.hstack([np.zeros((len(self.times), 6)), body.positions]))

    def motions(self, before, after):
        states, _ = self.base_at(before.vector[3])
        turned, there = moved(before, states, slice(-1), states.chosen(slice(1, None)))
        return ((turned * after.rotations[1:].inv()).as_rotvec() / np.sqrt(INTERVAL),
                (there - after.vectors[1:, 6:]) / np.sqrt(INTERVAL))

    def poses(self, state, rows):
        states, poses = self.base_at(state.vector[3])
        return moved(state, states, rows, poses)


def moved(state, odometry, first, ends):
    """Where the odometry comes to from the first states: rotations and positions. odometry, ends:
    its poses at all states, and then."""
    back = (state.rotations * odometry.rotations.inv())[first]
    return (back * ends.rotations,
            state.vectors[first, 6:] + back.apply(ends.positions - odometry.positions[first]))
