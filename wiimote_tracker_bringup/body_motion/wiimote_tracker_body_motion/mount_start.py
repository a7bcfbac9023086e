"""First guesses of where a base sits on a body: from rotations alone, which odometry and gyro have.

Rotation by R. Y. Tsai and R. K. Lenz (IEEE Trans. Robotics and Automation 5(3), 1989).
"""

import numpy as np
from scipy.spatial.transform import Rotation

from wiimote_tracker_bringup.errors import Refusal

LAG = 0.5  # of rotations that tell the axes [s]
LEAST_TURN = np.radians(3.0)  # RMS about the second axis in LAG, to tell the transform
GRID = 0.01  # of the search for the offset [s]
LONGEST_GAP = 0.1  # between two poses to interpolate [s]
MOST_RATIO = 4.0  # of the base's rate of rotation to the body's; 57 if it is in degrees
INDEPENDENT = 0.035  # between poses of the body whose errors do not depend on each other [s]


def start(body, base, largest_offset):
    """body, base: Poses, of which only the rotations are used.
    @returns the body's poses for which the base has some, rotation body_from_base, offset [s]"""
    offset = start_of_offset(body, base, largest_offset)
    base = base.shifted(offset)
    body = common_part(body, base)
    return body, start_of_rotation(body, base), offset


def turns(poses, times, lag):
    """Rotation vectors in the moving frame from each time to the one lag later, n x 3 [rad]."""
    before, after = poses.at(times).rotations, poses.at(times + lag).rotations
    return (before.inv() * after).as_rotvec()


def start_of_offset(body, base, largest):
    """The shift for which the speeds of rotation, which do not depend on the mount, agree best
    [s]."""
    lag = 10 * GRID
    if min(poses.times[-1] - poses.times[0] for poses in (body, base)) < 10.0:
        raise Refusal('the bag has less than 10 s of motion; record a minute')
    speeds, turned = [], []
    for poses in (body, base):
        times = np.arange(poses.times[0], poses.times[-1] - lag, GRID)
        speed = np.linalg.norm(turns(poses, times, lag), axis=1)
        turned.append(speed.mean())
        speeds.append(speed - speed.mean())
    if turned[1] > MOST_RATIO * turned[0]:
        raise Refusal(f'the base turns {turned[1] / turned[0]:.0f} times as fast as the '
                      'body: do both topics belong to one robot, and are rates in rad/s?')
    product = np.correlate(*speeds, mode='full')  # at 0: the last of base with the first of body
    shifts = body.times[0] - base.times[0] + GRID * (np.arange(len(product)) - len(speeds[1]) + 1)
    product[np.abs(shifts) > largest] = -np.inf
    if not np.isfinite(product).any():
        raise Refusal(
            f'the two topics share no time within {largest:g} s: the body begins at '
            f'{body.times[0]:.1f} s, the base at {base.times[0]:.1f} s. If their clocks differ so '
            'much, use --largest-offset')
    return shifts[np.argmax(product)]


def common_part(body, base):
    """Poses of the body for which the base has some, with room for a better offset, and so far
    apart that their errors are independent: correlated ones would be taken for motion."""
    room = 3 * GRID
    inside = (body.times > base.times[0] + room) & (body.times < base.times[-1] - room)
    which = np.flatnonzero(inside & base.covers(body.times, LONGEST_GAP))
    which = which[np.unique(body.times[which] // INDEPENDENT, return_index=True)[1]]
    if len(which) < 100:
        raise Refusal('fewer than 100 poses of the body lie between poses of the base')
    return body.chosen(which)


def start_of_rotation(body, base):
    """Rotation body_from_base. Throws Refusal if the rotations do not tell the transform."""
    end = min(body.times[-1], base.times[-1]) - LAG
    times = body.times[body.times < end]
    times = times[body.covers(times + LAG, LONGEST_GAP)]
    if not len(times):
        raise Refusal(f'no two poses are {LAG:g} s apart')
    of_body, of_base = turns(body, times, LAG), turns(base, times, LAG)
    spread = np.sqrt(np.linalg.eigvalsh(of_base.T @ of_base / len(times)))[::-1]
    if spread[0] < LEAST_TURN:
        raise Refusal(
            f'the base turns by {np.degrees(spread[0]):.1f} degrees in {LAG:g} s (RMS); '
            f'{np.degrees(LEAST_TURN):.0f} are needed: turn it more, about two axes')
    if spread[1] < LEAST_TURN:
        raise Refusal(
            'the base turns about one axis only, so the transform along it cannot be told: '
            f'about a second axis by {np.degrees(spread[1]):.1f} degrees in {LAG:g} s (RMS); '
            f'{np.degrees(LEAST_TURN):.0f} are needed. Tilt it by hand')
    return Rotation.align_vectors(of_body, of_base)[0]
