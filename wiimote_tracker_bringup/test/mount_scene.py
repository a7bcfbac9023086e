"""A simulated body with a base or an IMU on it, and the Cramer-Rao bounds of where that sits.

Independent of the solver: motions are formulas, rates and forces their differences, and the bounds
come from the linear errors of dead reckoning.
"""

import numpy as np
from scipy.spatial.transform import Rotation

from wiimote_tracker_body_motion.inertial import Samples
from wiimote_tracker_body_motion.poses import Poses

START = 1e9  # [s]
TURN = Rotation.from_euler('zyx', [0.5, -0.2, 0.1])  # body_from_base
ARM = np.array([0.12, -0.05, -0.2])  # [m]
OFFSET = 0.0373  # [s]
BIASES = np.array([0.02, -0.01, 0.015]), np.array([0.2, -0.1, 0.15])  # [rad/s, m/s^2]
DENSITIES = 2e-4, 4e-3  # [rad/s, m/s^2 / sqrt(Hz)]
NOISE = 0.01, 0.002  # of the tracker [rad, m]
ODOM = Rotation.from_euler('z', 1.1), np.array([3.0, 2.0, 0.0])  # world_from_odom
GRAVITY = np.array([0.0, 0.0, 9.80665])  # [m/s^2]
POSE_INTERVAL = 0.04  # [s]


def body_at(t, tilt=1.0, turn=1.0):
    """Positions and rotations of the body in the world."""
    positions = np.stack([0.8 * np.sin(0.9 * t), 0.6 * np.cos(0.7 * t), 0.2 * np.sin(1.1 * t)], 1)
    angles = np.stack([turn * 1.2 * np.sin(0.8 * t), tilt * 0.4 * np.sin(1.3 * t + 1.0),
                       tilt * 0.35 * np.sin(1.7 * t)], axis=1)
    return positions, Rotation.from_euler('zyx', angles)


def imu_at(t, **motion):
    """Rotations in the world, rates along the IMU's axes, specific forces along the world's."""
    h = 1e-3
    (before, back), (now, turned), (after, ahead) = (body_at(t + s, **motion) for s in (-h, 0.0, h))
    places = [p + r.apply(ARM) for p, r in ((before, back), (now, turned), (after, ahead))]
    force = (places[0] - 2.0 * places[1] + places[2]) / h ** 2 + GRAVITY
    return turned * TURN, TURN.inv().apply((back.inv() * ahead).as_rotvec()) / (2.0 * h), force


def tracked(random, duration, **motion):
    """Poses of the body, as the tracker has them."""
    t = np.arange(0.0, duration, POSE_INTERVAL)
    positions, rotations = body_at(t, **motion)
    return Poses(START + t, positions + random.normal(0.0, NOISE[1], positions.shape),
                 Rotation.from_rotvec(random.normal(0.0, NOISE[0], positions.shape)) * rotations,
                 'world', 'robot')


def miscalibrated(random, poses, size=(0.003, 0.002)):
    """With errors that are a smooth function of the pose, as those of calibrated cameras, of these
    standard deviations [rad, m]."""
    features = np.hstack([poses.positions / 0.5, poses.rotations.as_matrix().reshape(-1, 9)])
    waves = np.cos(features @ random.normal(0.0, 0.7, (12, 60)) + random.uniform(0.0, 6.3, 60))
    errors = waves @ random.normal(0.0, 1.0 / np.sqrt(30.0), (60, 6))
    return Poses(poses.times, poses.positions + size[1] * errors[:, 3:],
                 Rotation.from_rotvec(size[0] * errors[:, :3]) * poses.rotations,
                 poses.parent, poses.child)


def imu_samples(random, duration, interval=0.02, **motion):
    """Samples by the IMU's own clock."""
    t = np.arange(-0.3, duration + 0.3, interval)
    rotations, rates, forces = imu_at(t, **motion)
    white = [density / np.sqrt(interval) * random.normal(size=(len(t), 3)) for density in DENSITIES]
    return Samples(START + t - OFFSET, rates + BIASES[0] + white[0],
                   rotations.inv().apply(forces) + BIASES[1] + white[1], 'imu_link')


def odometry(random, duration, noise=2e-4, drift=0.0, **motion):
    """Poses of the base by its own clock. noise: white [rad, m]; drift: random walk, of the
    rotation and of the position [rad, m / sqrt(s)]."""
    t = np.arange(-0.3, duration + 0.3, 0.025)
    positions, rotations = body_at(t, **motion)
    world_from_odom, place = ODOM
    positions = world_from_odom.inv().apply(positions + rotations.apply(ARM) - place)
    walk = drift * np.sqrt(0.025) * random.normal(size=(2, *positions.shape))
    turned = Rotation.from_rotvec(walk[0].cumsum(axis=0))
    steps = np.diff(positions, axis=0, prepend=0.0)
    return Poses(START + t - OFFSET, (turned.apply(steps) + walk[1]).cumsum(axis=0)
                 + random.normal(0.0, noise, positions.shape),
                 turned * world_from_odom.inv() * rotations * TURN
                 * Rotation.from_rotvec(random.normal(0.0, noise, positions.shape)),
                 'odom', 'base_link')


def skew(v):
    return np.cross(np.eye(3), -v)


def odometry_bound(duration):
    """Standard deviations, at the least, of the rotation about the body's axes [rad], translation
    [m] and offset [s]. The body's pose is predicted from exact odometry, whose frame is unknown."""
    t = np.arange(0.0, duration, POSE_INTERVAL)

    def predicted(step):
        there, rotations = body_at(t + step[6])
        there = there + rotations.apply(ARM)
        rotations = Rotation.from_rotvec(step[7:10]) * rotations * Rotation.from_rotvec(-step[:3])
        there = Rotation.from_rotvec(step[7:10]).apply(there) + step[10:]
        return rotations, there - rotations.apply(ARM + step[3:6])

    columns = []
    for step in 1e-5 * np.eye(13):
        (turned, moved), (back, reached) = predicted(step), predicted(-step)
        columns.append(np.hstack([(turned * back.inv()).as_rotvec() / NOISE[0],
                                  (moved - reached) / NOISE[1]]).reshape(-1) / 2e-5)
    columns = np.stack(columns, axis=1)
    return np.sqrt(np.diag(np.linalg.inv(columns.T @ columns))[:7])


def imu_bound(duration, interval=0.02, block=5):
    """As odometry_bound. Dead reckoning starts anywhere; its noise is one unknown for each sensor,
    axis and block of steps. Columns: those of the bound, 6 biases, 9 of the start, noise."""
    t = np.arange(0.0, duration, interval)
    rotations, _, forces = imu_at(t)
    positions, bodies = body_at(t)
    later, ahead = body_at(t + 1e-4)
    velocities, spins = (later - positions) / 1e-4, (ahead * bodies.inv()).as_rotvec() / 1e-4
    blocks = -(-len(t) // block)
    error, rows = np.zeros((9, 22 + 6 * blocks)), []
    error[:, 13:22] = np.eye(9)
    for k, (turned, body) in enumerate(zip(rotations.as_matrix(), bodies.as_matrix())):
        if k % round(POSE_INTERVAL / interval) == 0:
            rotation, position, lever = error[:3].copy(), error[6:].copy(), skew(body @ ARM)
            rotation[:, :3] -= body
            position += lever @ rotation
            rotation[:, 6] -= spins[k]
            position[:, 6] -= velocities[k]
            position[:, 3:6] -= body
            rows += [rotation / NOISE[0], position / NOISE[1]]
        noise = 22 + 6 * (k // block)
        error[6:] += interval * error[3:6]
        error[3:6] -= interval * skew(forces[k]) @ error[:3]
        for row, bias, unknown in ((0, 7, noise), (3, 10, noise + 3)):
            error[row:row + 3, bias:bias + 3] -= interval * turned
            error[row:row + 3, unknown:unknown + 3] -= interval * turned
    rows = np.vstack(rows)
    information = rows.T @ rows
    prior = block * interval / np.repeat(DENSITIES, 3) ** 2
    information[np.diag_indices(len(information))] += np.r_[np.zeros(22), np.tile(prior, blocks)]
    return np.sqrt(np.diag(np.linalg.inv(information))[:7])


def error_of(found):
    return np.r_[(found.rotation * TURN.inv()).as_rotvec(), found.translation - ARM,
                 found.offset - OFFSET]
