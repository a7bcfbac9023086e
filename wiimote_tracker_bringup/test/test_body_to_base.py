"""body_to_base on simulated motions: errors against the Cramer-Rao bound of the same motions."""

import os
import sys

import numpy as np
import pytest
import rosbag
from scipy.spatial.transform import Rotation

HERE = os.path.dirname(os.path.realpath(__file__))
sys.path.insert(0, os.path.join(HERE, '..', 'evaluation'))

from wiimote_tracker_evaluation.errors import ExperimentError  # noqa: E402
from wiimote_tracker_evaluation.motion import body_to_base, hand_eye, mount  # noqa: E402
from wiimote_tracker_evaluation.motion.poses import Poses  # noqa: E402

from test_evaluate_trajectory import write  # noqa: E402

TURN = Rotation.from_euler('zyx', [0.5, -0.2, 0.1])
ARM = np.array([0.12, -0.05, -0.2])  # [m]
OFFSET = 0.0373  # [s]
ODOM = Rotation.from_euler('z', 1.1), np.array([3.0, 2.0, 0.0])  # world_from_odom
NOISE = 0.01, 0.002  # of the tracker [rad, m]
SEGMENT = 5.0  # [s]


def body_at(times, tilt=1.0, turn=1.0):
    """Positions and rotations of the body in the world."""
    t = times - 1e9
    positions = np.stack([0.8 * np.sin(0.9 * t), 0.6 * np.cos(0.7 * t), 0.2 * np.sin(1.1 * t)], 1)
    angles = np.stack([turn * 1.2 * np.sin(0.8 * t), tilt * 0.4 * np.sin(1.3 * t + 1.0),
                       tilt * 0.35 * np.sin(1.7 * t)], axis=1)
    return positions, Rotation.from_euler('zyx', angles)


def simulate(random, duration=30.0, odom_noise=2e-4, **motion):
    """Poses of the body and of the base, by its own clock."""
    times = 1e9 + np.arange(0.0, duration, 0.02)
    positions, rotations = body_at(times, **motion)
    body = Poses(times, positions + random.normal(0.0, NOISE[1], positions.shape),
                 Rotation.from_rotvec(random.normal(0.0, NOISE[0], positions.shape)) * rotations,
                 'world', 'robot')
    times = 1e9 + np.arange(0.3, duration - 0.3, 0.025)
    positions, rotations = body_at(times, **motion)
    world_from_odom, place = ODOM
    base = Poses(times - OFFSET,
                 world_from_odom.inv().apply(positions + rotations.apply(ARM) - place)
                 + random.normal(0.0, odom_noise, positions.shape),
                 world_from_odom.inv() * rotations * TURN
                 * Rotation.from_rotvec(random.normal(0.0, odom_noise, positions.shape)),
                 'odom', 'base_link')
    return body, base


def bound(duration=30.0):
    """Least standard deviations: of rotation about the body's axes, translation and offset. The pose
    of the body is predicted from the exact odometry, which has its own frame in each segment."""
    times = 1e9 + np.arange(0.35, duration - 0.35, 0.02)

    def predicted(step):
        there, rotations = body_at(times + step[6])
        there = there + rotations.apply(ARM)
        turn = Rotation.from_rotvec(step[:3])
        rotations = Rotation.from_rotvec(step[7:10]) * rotations * turn.inv()
        there = Rotation.from_rotvec(step[7:10]).apply(there) + step[10:]
        return rotations, there - rotations.apply(ARM + step[3:6])

    information = np.zeros((7, 7))
    columns = []
    for step in 1e-5 * np.eye(13):
        (turned, moved), (back, reached) = predicted(step), predicted(-step)
        columns.append(np.hstack([(turned * back.inv()).as_rotvec() / NOISE[0],
                                  (moved - reached) / NOISE[1]]) / 2e-5)
    derivatives = np.stack(columns, axis=2)
    for number in range(int(duration / SEGMENT)):
        inside = (times - times[0]) // SEGMENT == number
        part = derivatives[inside].reshape(-1, 13)
        whole = part.T @ part
        information += whole[:7, :7] - whole[:7, 7:] @ np.linalg.solve(whole[7:, 7:], whole[7:, :7])
    return np.sqrt(np.diag(np.linalg.inv(information)))


def error_of(found):
    return np.r_[(found.rotation * TURN.inv()).as_rotvec(), found.translation - ARM,
                 found.offset - OFFSET]


def test_reaches_the_bound():
    random, errors, normalised = np.random.default_rng(5), [], []
    for _ in range(6):
        found = hand_eye.solve(*simulate(random), segment=SEGMENT)
        errors.append(error_of(found))
        normalised.append(errors[-1] @ np.linalg.solve(found.covariance, errors[-1]) / 7.0)
    ratios = np.array(errors) / bound()
    print(np.sqrt((ratios ** 2).mean(axis=0)), np.mean(normalised))
    assert np.sqrt((ratios ** 2).mean()) < 1.1
    assert np.abs(errors)[:, 6].max() < 0.0005  # [s]
    assert 0.7 < np.mean(normalised) < 1.5


def test_odometry_that_drifts():
    """A random walk: the covariance takes it into account."""
    random, normalised = np.random.default_rng(6), []
    for _ in range(3):
        body, base = simulate(random)
        noise = np.sqrt(0.025) * random.normal(size=(2, *base.positions.shape))
        turned = Rotation.from_rotvec(0.001 * noise[0].cumsum(axis=0))
        steps = np.diff(base.positions, axis=0, prepend=0.0)
        base.positions = (turned.apply(steps) + 0.001 * noise[1]).cumsum(axis=0)
        base.rotations = turned * base.rotations
        found = hand_eye.solve(body, base, segment=SEGMENT)
        error = error_of(found)
        normalised.append(error @ np.linalg.solve(found.covariance, error) / 7.0)
        assert np.abs(error[3:6]).max() < 0.01
    print(normalised)
    assert 0.3 < np.mean(normalised) < 3.0


@pytest.mark.parametrize('motion, reason', [
    ({'tilt': 0.02}, 'about one axis only'), ({'tilt': 0.02, 'turn': 0.01}, 'turn it more'),
    ({'duration': 8.0}, 'less than 10 s')])
def test_refuses_what_does_not_tell(motion, reason):
    with pytest.raises(ExperimentError, match=reason):
        hand_eye.solve(*simulate(np.random.default_rng(7), **motion))


def test_refuses_clocks_too_far_apart():
    body, base = simulate(np.random.default_rng(7))
    with pytest.raises(ExperimentError, match='--largest-offset'):
        hand_eye.solve(body, base.shifted(100.0))


def test_a_bag(tmp_path):
    body, base = simulate(np.random.default_rng(8))
    path, output = str(tmp_path / 'run.bag'), str(tmp_path / 'mount.yaml')
    with rosbag.Bag(path, 'w') as bag:
        write(bag, '/robot/odometry', body)
        write(bag, '/odom', base)
    body_to_base.main([path, '--body', '/robot/odometry', '--odom', '/odom', '--output', output])
    found = mount.read(output)
    assert np.abs(error_of(found)).max() < 0.002
    assert (found.body, found.base) == ('robot', 'base_link')


def test_no_solution_is_said_in_words(monkeypatch):
    def fail(*_):
        raise np.linalg.LinAlgError('Singular matrix')
    monkeypatch.setattr(body_to_base.poses, 'read', fail)
    with pytest.raises(SystemExit, match=r'no solution was found \(Singular matrix\)'):
        body_to_base.main(['run.bag', '--body', '/robot/odometry', '--odom', '/odom'])


def test_files_and_words(tmp_path):
    found = mount.Mount(TURN, ARM, OFFSET, np.diag(np.arange(1.0, 8.0)) * 1e-6, 'robot', 'base_link')
    path = str(tmp_path / 'mount.yaml')
    mount.write(found, path)
    read = mount.read(path)
    assert np.allclose(read.translation, ARM) and read.offset == OFFSET
    assert (read.rotation * TURN.inv()).magnitude() < 1e-9
    assert np.allclose(read.covariance, found.covariance)
    assert 'static_transform_publisher' in open(path).read()
    assert 'clock offset      37.30 ms' in '\n'.join(body_to_base.describe(found))
    (tmp_path / 'other.yaml').write_text('a: 1\n')
    with pytest.raises(ExperimentError, match='is no result of body_to_base'):
        mount.read(str(tmp_path / 'other.yaml'))
