"""body_to_base on simulated motions: errors against the Cramer-Rao bound of the same motions."""

import dataclasses
import re

import numpy as np
import pytest
import rosbag
import rospy
from geometry_msgs.msg import Vector3
from sensor_msgs.msg import Imu
from std_msgs.msg import Header

from wiimote_tracker_body_motion import (
    body_to_base, evaluate_trajectory, hand_eye, inertial, mount, poses)
from wiimote_tracker_bringup.errors import Refusal
from wiimote_tracker_bringup.files import read_yaml, write_yaml

import mount_scene
from mount_scene import ARM, OFFSET, TURN, error_of
from test_evaluate_trajectory import write


def simulate(random, duration=30.0, **motion):
    """Poses of the body and of the base."""
    return (mount_scene.tracked(random, duration, **motion),
            mount_scene.odometry(random, duration, **motion))


def with_imu(random, duration=15.0, interval=0.02, **motion):
    """Poses of the body and samples of the IMU."""
    return (mount_scene.tracked(random, duration, **motion),
            mount_scene.imu_samples(random, duration, interval, **motion))


def check(solve, scene, bound, runs):
    """RMS of errors over the bound, the errors, and their mean square by the stated covariance."""
    errors, normalised = [], []
    for _ in range(runs):
        found = solve(*scene())
        errors.append(error_of(found))
        normalised.append(errors[-1] @ np.linalg.solve(found.covariance, errors[-1]) / 7.0)
    ratio = np.sqrt(np.mean((np.array(errors) / bound) ** 2))
    return ratio, np.array(errors), np.mean(normalised)


def test_odometry_reaches_the_bound():
    random = np.random.default_rng(5)
    ratio, errors, normalised = check(hand_eye.solve, lambda: simulate(random),
                                      mount_scene.odometry_bound(30.0), 5)
    assert ratio < 1.1
    assert np.abs(errors)[:, 6].max() < 0.0005  # [s]
    assert 0.7 < normalised < 1.5


def calibrated(_, body):
    return body


# miscalibrated: as the errors of a calibration, which come back with the pose, so that no mean is
# without them.
@pytest.mark.parametrize('mistake, seed, runs, least, largest', [
    (calibrated, 6, 5, 0.7, 0.002), (mount_scene.miscalibrated, 9, 12, 0.5, 0.006)])
def test_stated_errors_are_real_ones_though_the_odometry_drifts(mistake, seed, runs, least,
                                                                largest):
    """A random walk, which is estimated. least: of the normalised square; largest: [m]."""
    random = np.random.default_rng(seed)
    _, errors, normalised = check(  # errors, not ratios: the bound is 1
        hand_eye.solve, lambda: (mistake(random, mount_scene.tracked(random, 30.0)),
                                 mount_scene.odometry(random, 30.0, drift=0.001)), 1.0, runs)
    assert least < normalised < 1.5
    assert np.abs(errors[:, 3:6]).max() < largest


def test_odometry_that_pauses():
    body, base = simulate(np.random.default_rng(7))
    base = base.chosen(np.abs(base.times - base.times[600]) > 1.5)
    found = hand_eye.solve(body, base)
    assert (np.abs(error_of(found)) < 3.0 * found.stddev()).all()
    assert np.abs(error_of(found)).max() < 0.002


def test_imu_reaches_the_bound():
    random = np.random.default_rng(5)
    ratio, errors, normalised = check(inertial.solve, lambda: with_imu(random),
                                      mount_scene.imu_bound(15.0), 4)
    assert ratio < 1.1
    assert 0.6 < normalised < 1.6


def test_imu_of_a_minute():
    found = inertial.solve(*with_imu(np.random.default_rng(6), 60.0))
    assert found.stddev()[6] < 0.0005  # [s]
    assert found.stddev()[3:6].max() < 0.001
    assert (np.abs(error_of(found)) < 3.0 * found.stddev()).all()


def test_poses_whose_errors_are_correlated(monkeypatch):
    """As those of the tracker, which has a filter: at 125 Hz, interpolated."""
    monkeypatch.setattr(mount_scene, 'POSE_INTERVAL', 0.024)
    body, imu = with_imu(np.random.default_rng(7))
    often = np.arange(body.times[0], body.times[-1], 0.008)
    error = error_of(inertial.solve(body.at(often), imu))
    assert np.abs(error[3:6]).max() < 0.006 and abs(error[6]) < 0.002


REFUSED = [({'tilt': 0.02}, 'about one axis only'), ({'tilt': 0.02, 'turn': 0.01}, 'turn it more'),
           ({'duration': 8.0}, 'less than 10 s')]


@pytest.mark.parametrize('motion, reason', REFUSED)
@pytest.mark.parametrize('solve, scene', [(hand_eye.solve, simulate), (inertial.solve, with_imu)])
def test_refuses_what_does_not_tell(solve, scene, motion, reason):
    with pytest.raises(Refusal, match=reason):
        solve(*scene(np.random.default_rng(7), **motion))


def test_refuses_an_imu_that_pauses():
    body, imu = with_imu(np.random.default_rng(7))
    kept = np.abs(imu.times - imu.times[400]) > 0.2
    imu = inertial.Samples(imu.times[kept], imu.rates[kept], imu.forces[kept])
    with pytest.raises(Refusal, match=r'the IMU says nothing for 0\.4\d s'):
        inertial.solve(body, imu)


def test_refuses_clocks_too_far_apart():
    body, base = simulate(np.random.default_rng(7))
    with pytest.raises(Refusal, match=r'the base at \d+\.\d s\. .*--largest-offset'):
        hand_eye.solve(body, base.shifted(100.0))


@pytest.mark.parametrize('rate, force, reason', [
    (1.0, 1.0 / 9.80665, r'measures 1\.\d+ m/s\^2 \(median\), but about 9\.8'),
    (1.0, 0.0, 'not in g'), (57.3, 1.0, 'times as fast as the body: .* in rad/s')])
def test_refuses_an_imu_in_other_units(rate, force, reason):
    body, imu = with_imu(np.random.default_rng(7))
    imu = dataclasses.replace(imu, rates=rate * imu.rates, forces=force * imu.forces)
    with pytest.raises(Refusal, match=reason):
        inertial.solve(body, imu)


@pytest.mark.parametrize('rates, forces, reason', [
    (9.0, 9.0, r'the accelerometer clips: \d+\.\d % of the time it stays at 9 m/s\^2 along z'),
    (9.0, 9.9, r'the accelerometer clips: .* at 9\.9 m/s\^2 along z; set a larger range'),
    (0.5, 90.0, r'the gyro clips: .* at -?0\.5 rad/s along [xyz]')])
@pytest.mark.parametrize('interval', [0.02, 0.004])
def test_refuses_an_imu_that_clips(rates, forces, reason, interval):
    body, imu = with_imu(np.random.default_rng(7), interval=interval)
    imu = dataclasses.replace(imu, rates=np.clip(imu.rates, -rates, rates),
                              forces=np.clip(imu.forces, -forces, forces))
    with pytest.raises(Refusal, match=reason):
        inertial.solve(body, imu)


def test_an_imu_of_few_bits_does_not_clip():
    """Where it changes slowly, many of its samples equal the one before."""
    _, imu = with_imu(np.random.default_rng(7), 60.0)
    for sensor, values, bit in (('accelerometer', imu.forces, 0.3), ('gyro', imu.rates, 0.05)):
        inertial.check_range(sensor, bit * np.round(values / bit), '')


def test_refuses_stamps_that_are_zero(tmp_path):
    path = str(tmp_path / 'run.bag')
    with rosbag.Bag(path, 'w') as bag:
        for second in range(1, 200):
            bag.write('/imu/data', Imu(), rospy.Time(second))
    with pytest.raises(Refusal, match='all stamps of /imu/data in .* are 0'):
        inertial.read(path, '/imu/data')


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
    with pytest.raises(SystemExit, match='run.bag: write to another file'):
        body_to_base.main([path, '--body', '/robot/odometry', '--odom', '/odom', '--output', path])


def test_a_bag_with_an_imu(tmp_path, capsys):
    body, imu = with_imu(np.random.default_rng(8), interval=0.004)  # 250 Hz
    path, output = str(tmp_path / 'run.bag'), str(tmp_path / 'mount.yaml')
    with rosbag.Bag(path, 'w') as bag:
        write(bag, '/robot/odometry', body)
        for stamp, rate, force in zip(imu.times, imu.rates, imu.forces):
            message = Imu(header=Header(stamp=rospy.Time.from_sec(stamp), frame_id='imu_link'),
                          angular_velocity=Vector3(*rate), linear_acceleration=Vector3(*force))
            bag.write('/imu/data', message, message.header.stamp)
    body_to_base.main([path, '--body', '/robot/odometry', '--imu', '/imu/data', '--output', output])
    found = mount.read(output)
    assert np.abs(error_of(found)).max() < 0.005
    assert (found.body, found.base) == ('robot', 'imu_link')
    told = capsys.readouterr()
    assert 'step' not in told.out
    steps = re.findall(r'body_to_base: step (\d+) of at most 30: clock offset 3\d\.\d\d \+- ',
                       told.err)
    assert steps == [str(number + 1) for number in range(len(steps))] and len(steps) >= 7
    with pytest.raises(SystemExit, match='has no IMU samples on /imu'):
        body_to_base.main([path, '--body', '/robot/odometry', '--imu', '/imu'])


def test_no_solution_is_said_in_words(monkeypatch):
    def fail(*_):
        raise np.linalg.LinAlgError('Singular matrix')
    monkeypatch.setattr(body_to_base.poses, 'read', lambda *_: None)
    monkeypatch.setattr(body_to_base.hand_eye, 'solve', fail)
    with pytest.raises(SystemExit, match=r'no solution was found \(Singular matrix\)'):
        body_to_base.main(['run.bag', '--body', '/robot/odometry', '--odom', '/odom'])


@pytest.mark.parametrize('program, options', [
    (body_to_base, ['--body', '/b', '--odom', '/o']),
    (evaluate_trajectory, ['--truth', '/b', '--estimate', '/o'])])
def test_ctrl_c_is_answered_in_a_word(program, options, monkeypatch, capsys):
    def interrupt(*_):
        raise KeyboardInterrupt
    monkeypatch.setattr(poses, 'read', interrupt)
    with pytest.raises(SystemExit, match='^130$'):
        program.main(['run.bag', *options])
    assert capsys.readouterr().err.endswith(': interrupted\n')


def test_files_and_words(tmp_path):
    found = mount.Mount(TURN, ARM, OFFSET, np.diag(np.arange(1.0, 8.0)) * 1e-6, 'robot',
                        'base_link')
    path = str(tmp_path / 'mount.yaml')
    mount.write(found, path)
    read = mount.read(path)
    assert np.allclose(read.translation, ARM) and read.offset == OFFSET
    assert (read.rotation * TURN.inv()).magnitude() < 1e-9
    assert np.allclose(read.covariance, found.covariance)
    assert 'static_transform_publisher' in open(path).read()
    assert 'clock offset      37.30 ms' in '\n'.join(body_to_base.describe(found))
    content = read_yaml(path)
    mount.write(dataclasses.replace(found, offset=0.0), path)
    assert mount.read(path).offset == 0.0 and mount.read(path + '.bak').offset == OFFSET
    write_yaml(path, dict(content, translation=content['translation'][:2]))
    with pytest.raises(Refusal, match='no result of body_to_base: cannot reshape'):
        mount.read(path)
    (tmp_path / 'other.yaml').write_text('a: 1\n')
    with pytest.raises(Refusal, match="no result of body_to_base: 'format' is missing"):
        mount.read(str(tmp_path / 'other.yaml'))
