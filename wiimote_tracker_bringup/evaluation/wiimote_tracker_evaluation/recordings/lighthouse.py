"""Bearings from two laser base stations (SteamVR tracking, version 1) as images of two cameras.

A station sweeps the room with a horizontal and a vertical plane of light in turn. A sensor measures
the angle of each plane when it passes. Both angles of a station are one pixel of a virtual camera,
at the time of one sweep, to which the other is moved by its rate of change and acceleration. A
folder holds bearings.csv.gz (time_ms, station, sensor, sweep, angle_rad), mocap.csv.gz (time_s,
position [m]) and markers_on_off.csv (time_ms of the truth's begin and end).
"""

import functools
import gzip
import itertools
import os
import zlib

import numpy as np

from wiimote_tracker_bringup.errors import Refusal
from wiimote_tracker_bringup.timeseries import to_nearest
from wiimote_tracker_evaluation.recordings.views import LONGEST_GAP, Camera, Truth, Views

# Of the sensors on Crazyflie's Lighthouse deck: x forward, y to the left [m].
SHAPE = np.array([[-0.015, 0.0075, 0.0], [-0.015, -0.0075, 0.0],
                  [0.015, 0.0075, 0.0], [0.015, -0.0075, 0.0]])
SWEEP = 1.0 / 120.0  # from a station's first sweep to its second [s]
ROTOR_PERIOD = 1.0 / 60.0  # [s]
# Angles of one station within this were logged together [s].
TOGETHER = 0.002
# Delays of the log vary by less [s]; beyond that the angles are of another turn.
JITTER = 0.003
# Of the virtual cameras [px]. Farther than 22 degrees from the axis the angles of stations are off
# by several mrad.
FOCAL, SIZE = 1000.0, 801
# Standard deviation of what the stations' correction leaves of an angle [rad]; with noise and
# errors of the truth, residuals are 0.5 to 0.7 mrad.
ACCURACY = 0.0005
# Error of the truth's start, as the switching of its markers tells it [s].
CLOCK_TOLERANCE = 0.1


def read(folder: str) -> Views:
    """@raise Refusal: a file is missing or has another format."""
    bearings = read_table(os.path.join(folder, 'bearings.csv.gz'), 5)
    mocap = read_table(os.path.join(folder, 'mocap.csv.gz'), 4)
    switched = read_table(os.path.join(folder, 'markers_on_off.csv'), 1)[:, 0] * 1e-3
    mocap = mocap[np.isfinite(mocap).all(axis=1)]
    if len(mocap) < 2 or len(switched) != 2:
        raise Refusal(f'{folder} has no truth: mocap.csv.gz needs two positions or more, '
                      'markers_on_off.csv two times')
    stations = [sweeps_of(bearings[bearings[:, 1] == station]) for station in (0, 1)]
    if any(len(times) < 3 for times, _ in stations):
        raise Refusal(f'{folder} has hardly any angles of one of the stations 0 and 1: at '
                      'least three pairs of sweeps must show all sensors')
    cameras = [Camera(f'station_{number}', SIZE, FOCAL, *images_of(*stations[number], sweep))
               for number, sweep in enumerate(nearest_sweeps(stations))]
    rate = (mocap[-1, 0] - mocap[0, 0]) / (switched[1] - switched[0])
    truth = Truth(mocap[:, 0], mocap[:, 1:], rate, mocap[0, 0] - rate * switched[0],
                  CLOCK_TOLERANCE)
    return Views(cameras, SHAPE, FOCAL * ACCURACY, truth)


def read_table(path, columns):
    try:
        with (gzip.open if path.endswith('.gz') else open)(path, 'rt') as file:
            table = np.atleast_2d(np.genfromtxt(file, delimiter=',', skip_header=1))
    except (OSError, EOFError, zlib.error, ValueError) as error:
        raise Refusal(f'{path} cannot be read: {error}')
    table = table.reshape(-1, columns) if columns == 1 or not table.size else table
    if table.shape[1] != columns:
        raise Refusal(f'{path} has {table.shape[1]} columns, but must have {columns}')
    return table


def sweeps_of(rows):
    """Times n x 2 [s] and tangents n x sensors x 2 of one station's pairs of sweeps that all
    sensors saw. An angle that is logged again is left out."""
    logged = rows[:, 0] * 1e-3
    first = np.flatnonzero(np.diff(logged, prepend=-np.inf) > TOGETHER)
    pair = np.searchsorted(first, np.arange(len(rows)), side='right') - 1
    angles = np.full((len(first), len(SHAPE), 2), np.nan)
    for sensor, sweep in itertools.product(range(len(SHAPE)), (0, 1)):
        chosen = np.flatnonzero((rows[:, 2] == sensor) & (rows[:, 3] == sweep))
        new = chosen[np.diff(rows[chosen, 4], prepend=np.nan) != 0.0]
        angles[pair[new], sensor, sweep] = rows[new, 4]
    complete = np.isfinite(angles).all(axis=(1, 2))
    turns, regular = turns_of(logged[first[complete]])
    angles = angles[complete][regular]
    delays = angles.mean(axis=1) / (2.0 * np.pi) * ROTOR_PERIOD
    times = turns[:, None] + np.array([0.0, SWEEP]) + delays
    return times, np.tan(angles)


def turns_of(logged):
    """Times of the rotor's turns, which are regular, without the varying delays of the log; and
    which entries are of such a turn, the first of each."""
    if len(logged) < 3:
        return logged, np.ones(len(logged), dtype=bool)
    middle, duration = np.median(np.diff(logged)), logged[-1] - logged[0]
    # Close enough to each other that the turns of a whole recording stay in step with one.
    periods = middle * np.linspace(0.995, 1.005, 10 + int(0.1 * duration / middle))
    # Rayleigh periodogram of the times: at the right period all phasors point the same way.
    phasors = [np.exp(2j * np.pi * logged / period).sum() for period in periods]
    best = np.argmax(np.abs(phasors))
    period = periods[best]
    start = period * np.angle(phasors[best]) / (2.0 * np.pi)
    for _ in range(5):
        turn = np.round((logged - start) / period)
        near = np.abs(start + period * turn - logged) < JITTER
        period, start = np.polyfit(turn[near], logged[near], 1)
    times = start + period * turn
    regular = np.flatnonzero(np.abs(times - logged) < JITTER)
    regular = regular[np.diff(turn[regular], prepend=-np.inf) > 0.0]
    return times[regular], regular


def nearest_sweeps(stations):
    """The sweep of each station at which its images are taken: those nearest in time."""
    def distance(sweeps):
        nearest = to_nearest(*(times[:, sweep] for (times, _), sweep in zip(stations, sweeps)))
        return np.median(nearest[nearest < LONGEST_GAP]) if nearest.min() < LONGEST_GAP else np.inf
    return min(itertools.product((0, 1), repeat=2), key=distance)


def images_of(times, tangents, sweep):
    """Times n and pixels n x sensors x 2 at one of both sweeps."""
    other = 1 - sweep
    moved = tangents.copy()
    moved[:, :, other] = interpolated_at(times[:, sweep], times[:, other], tangents[:, :, other])
    # The station looks along x, y to the left, z up; a camera along z, x to the right, y down.
    pixels = 0.5 * (SIZE - 1) - FOCAL * moved
    inside = ((pixels >= 0.0) & (pixels <= SIZE - 1)).all(axis=(1, 2))
    return times[inside, sweep], pixels[inside]


def interpolated_at(wanted, times, values):
    """Values n x k of times n at the times wanted, n, one near each: Newton's quadratic through
    three successive ones; linear through two where no third is near; NaN without neighbours."""
    # First and second divided differences.
    step = np.diff(times)
    slope = np.diff(values, axis=0) / np.where(step < LONGEST_GAP, step, np.nan)[:, None]
    bend = np.diff(slope, axis=0) / (times[2:] - times[:-2])[:, None]
    missing = np.full((2, values.shape[1]), np.nan)
    slope = np.concatenate([missing[1:], slope, missing[1:]])
    bend = np.concatenate([missing, bend, missing])
    before, after = slope[:-1], slope[1:]
    neighbour = np.where(np.isnan(after), np.append(np.nan, times[:-1])[:, None],
                         np.append(times[1:], np.nan)[:, None])
    bend = first_known(bend[1:-1], bend[2:], bend[:-2], np.zeros_like(values))
    return values + (wanted - times)[:, None] * (
        first_known(after, before) + (wanted[:, None] - neighbour) * bend)


def first_known(*choices):
    """The first that is not NaN, element by element."""
    return functools.reduce(lambda known, other: np.where(np.isnan(known), other, known), choices)
