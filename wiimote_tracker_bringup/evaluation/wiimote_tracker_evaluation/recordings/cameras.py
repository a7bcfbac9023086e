"""Unsynchronised consumer cameras that see one light, and where it truly was.

A folder holds cameras.yaml (by name: rate [Hz], width, height, fx, fy, cx, cy [px], distortion k1,
k2, p1, p2, k3, and rolling_shutter: whether lines are read one by one), detections.csv (camera,
frame, u, v) and truth.csv (time,x,y,z, in s and m). The times of the truth are those since frame 0
of the first camera, to START.
"""

import os

import numpy as np

from wiimote_tracker_bringup.errors import Refusal
from wiimote_tracker_bringup.files import read_yaml
from wiimote_tracker_evaluation.recordings.lighthouse import read_table
from wiimote_tracker_evaluation.recordings.views import Camera, Truth, Views

START = 0.5  # [s]
BEGIN = 1000.0  # of each camera's frame 0, so that all times are positive [s]
KEYS = ('rate', 'width', 'height', 'fx', 'fy', 'cx', 'cy', 'distortion', 'rolling_shutter')
ROUNDS = 20  # of the inversion of a lens


def read(folder: str) -> Views:
    """@raise Refusal: a file is missing or has another format."""
    path = os.path.join(folder, 'cameras.yaml')
    lenses = read_yaml(path)
    try:
        for lens in lenses.values():
            *_, distortion, _ = [lens[key] for key in KEYS]
            if len(distortion) != 5:
                raise ValueError(f'distortion is {distortion}, but must have 5 numbers')
            for key in ('rate', 'height', 'fx', 'fy'):
                if not lens[key] > 0.0:
                    raise ValueError(f'{key} is {lens[key]}, but must be above 0')
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise Refusal(f'{path} cannot be read: {error}; each camera needs '
                      + ', '.join(KEYS))
    path = os.path.join(folder, 'detections.csv')
    try:
        table = np.genfromtxt(path, dtype=None, delimiter=',', names=True, encoding='utf-8')
        seen = {name: np.stack([table[column][table['camera'] == name].astype(float)
                                for column in ('frame', 'u', 'v')], axis=1) for name in lenses}
    except (OSError, ValueError, IndexError) as error:
        raise Refusal(f'{path} cannot be read: {error}; its columns are camera,frame,u,v')
    for name, rows in seen.items():
        if len(rows) < 3:
            raise Refusal(f'{path} has hardly any detection of {name}')
    truth = read_table(os.path.join(folder, 'truth.csv'), 4)
    return Views([camera_of(name, lenses[name], seen[name]) for name in lenses], np.zeros((1, 3)),
                 0.0, Truth(truth[:, 0], truth[:, 1:], 1.0, -BEGIN, START))


def camera_of(name, lens, rows):
    """A pinhole without distortion; what its lens saw, by the nominal rate. A frame with several
    detections is left out."""
    frames, first, count = np.unique(rows[:, 0], return_index=True, return_counts=True)
    rows = rows[first[count == 1]]
    times = BEGIN + rows[:, 0] / lens['rate']
    plane = undistorted((rows[:, 1:] - [lens['cx'], lens['cy']]) / [lens['fx'], lens['fy']],
                        lens['distortion'])
    size = 2 * int(np.ceil(lens['fx'] * np.abs(plane).max())) + 3
    pixels = 0.5 * (size - 1) + lens['fx'] * plane
    lines = rows[:, 2] / lens['height'] - 0.5 if lens['rolling_shutter'] else None
    return Camera(name, size, lens['fx'], times, pixels[:, None], lines)


def undistorted(seen, distortion):
    """Of the model of OpenCV, by fixed-point iteration; n x 2, in units of the focal length."""
    k1, k2, p1, p2, k3 = distortion
    plane = seen
    for _ in range(ROUNDS):
        x, y = plane.T
        square = x * x + y * y
        radial = 1.0 + square * (k1 + square * (k2 + square * k3))
        shift = np.stack([2.0 * p1 * x * y + p2 * (square + 2.0 * x * x),
                          p1 * (square + 2.0 * y * y) + 2.0 * p2 * x * y], axis=1)
        plane = (seen - shift) / radial[:, None]
    return plane
