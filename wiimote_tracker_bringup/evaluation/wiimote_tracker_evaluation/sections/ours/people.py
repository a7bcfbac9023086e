"""Simulated people who draw gestures, in the files that gesture_tool reads."""

import os

import numpy as np
from scipy.ndimage import uniform_filter1d
from scipy.spatial.transform import Rotation

from wiimote_tracker_bringup import timeseries

POINTS = 400   # of a line
RATE = 100.0   # of an LED's positions [1/s]
NOISE = 0.002  # of a tracked LED that moves, each coordinate [m]


def arc(begin, end, radius, height=0.0):
    """About (0, height), by 60 points. Angles in half turns; radius: of all or of each."""
    angle = np.pi * np.linspace(begin, end, 60)
    return np.column_stack([radius * np.cos(angle), radius * np.sin(angle) + height])


TURN = 2.0 * np.pi * np.linspace(0.0, 1.0, 60)
# In a unit square: to the right, up.
GESTURES = {
    'arrow': [(-0.5, 0), (0.5, 0), (0.2, 0.3), (0.5, 0), (0.2, -0.3)],
    'caret': [(-0.4, -0.4), (0, 0.4), (0.4, -0.4)],
    'check': [(-0.4, 0), (-0.15, -0.35), (0.45, 0.45)],
    'circle': arc(0.5, -1.5, 0.5),
    'hook': [(0.2, 0.5), (0.2, -0.3), (-0.1, -0.5), (-0.3, -0.25)],
    'infinity': np.column_stack([0.5 * np.sin(TURN), 0.25 * np.sin(2.0 * TURN)]),
    's_curve': np.concatenate([arc(0.3, 1.5, 0.25, 0.25), arc(0.5, -0.7, 0.25, -0.25)]),
    'spiral': arc(0.0, 5.0, np.linspace(0.08, 0.5, 60)),
    'square': [(-0.4, 0.4), (0.4, 0.4), (0.4, -0.4), (-0.4, -0.4), (-0.4, 0.4)],
    'star': [(-0.3, -0.45), (0, 0.5), (0.3, -0.45), (-0.45, 0.15), (0.45, 0.15), (-0.3, -0.45)],
    'triangle': [(0, 0.45), (0.45, -0.4), (-0.45, -0.4), (0, 0.45)],
    'zigzag': [(-0.5, 0.3), (-0.15, -0.3), (0.15, 0.3), (0.5, -0.3)]}


def evenly(line):
    """POINTS points at equal distances along a line, and its length [m]."""
    line = np.asarray(line, dtype=float)
    way = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1)))
    return timeseries.at(way, line, np.linspace(0.0, way[-1], POINTS)), way[-1]


class Person:
    """A way of drawing, which varies from drawing to drawing."""

    def __init__(self, random):
        self._random = random
        self._size, self._slant = random.uniform(0.25, 0.5), random.uniform(-0.3, 0.3)
        self._aspect, self._heading = random.uniform(0.75, 1.3), random.uniform(-0.25, 0.25)
        self._roundness, self._wobble = random.uniform(0.01, 0.06), random.uniform(0.01, 0.04)
        self._speed = random.uniform(0.6, 1.4)  # [m/s]

    def draw(self, gesture):
        """Times n [s] and positions n x 3 of the LED [m]."""
        uniform = self._random.uniform
        line, length = evenly(self._line(gesture))
        # Corners are rounded, as by a moving hand.
        line = uniform_filter1d(line, 2 * int(self._roundness * POINTS) + 1, axis=0,
                                mode='nearest')
        duration = length / self._speed * uniform(0.85, 1.15)
        times = np.arange(0.0, duration, 1.0 / RATE)
        # It accelerates and decelerates smoothly, at an uneven pace.
        share = times / duration - np.sin(2.0 * np.pi * times / duration) / (4.0 * np.pi)
        uneven, when = uniform(-0.3, 0.3), uniform(0.0, 2.0 * np.pi)
        share = share + uneven / (2.0 * np.pi) * (
            np.sin(2.0 * np.pi * share + when) - np.sin(when))
        positions = timeseries.at(np.linspace(0.0, 1.0, POINTS), line, share)
        return times, positions + NOISE * self._random.randn(*positions.shape)

    def _line(self, gesture):
        """Of POINTS points, N x 3, somewhere in the room [m]."""
        uniform = self._random.uniform
        right, up = evenly(gesture)[0].T
        line = np.column_stack([self._aspect * right + self._slant * up, 0.0 * up, up])
        along = np.linspace(0.0, 2.0 * np.pi, POINTS)[:, None]
        for wave in (1, 2, 3):  # as of people who miss the corners
            line += self._wobble * uniform(-1.0, 1.0, 3) * np.sin(
                wave * along + uniform(0.0, 2.0 * np.pi, 3))
        turn = Rotation.from_euler('yz', [uniform(-0.15, 0.15),
                                          self._heading + uniform(-0.1, 0.1)])
        return (uniform([0.9, 0.9, 1.0], [1.6, 1.6, 1.5])
                + self._size * uniform(0.9, 1.1) * turn.apply(line))


def write(folder, people, seed):
    """A folder per person with a CSV per gesture."""
    random = np.random.RandomState(seed)
    for number in range(1, people + 1):
        own = os.path.join(folder, f'person_{number:03}')
        os.makedirs(own)
        person = Person(random)
        for name, gesture in GESTURES.items():
            times, positions = person.draw(gesture)
            np.savetxt(os.path.join(own, name + '.csv'),
                       1e3 * np.column_stack([positions, times]), '%.2f')
