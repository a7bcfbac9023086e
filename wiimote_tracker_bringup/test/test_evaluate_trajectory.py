"""evaluate_trajectory: errors in closed form, and a bag."""

import dataclasses
import json

import numpy as np
import pytest
import rosbag
import rospy
from nav_msgs.msg import Odometry
from scipy.spatial.transform import Rotation

from wiimote_tracker_body_motion import comparison, evaluate_trajectory, mount
from wiimote_tracker_body_motion.poses import Poses
from wiimote_tracker_bringup.errors import Refusal

RADIUS, SPEED = 2.0, 0.5  # of the circle [m, m/s]


def around(duration=20.0, speed=SPEED, start=1000.0, rate=50.0):
    """Along a circle, heading forward; the whole angle is speed * duration / RADIUS."""
    times = np.arange(0.0, duration, 1.0 / rate)
    angles = speed * times / RADIUS
    positions = np.stack([RADIUS * np.cos(angles), RADIUS * np.sin(angles), 0.1 * angles], axis=1)
    turns = np.stack([0.0 * angles, 0.0 * angles, angles + np.pi / 2.0], axis=1)
    return Poses(start + times, positions, Rotation.from_rotvec(turns))


def along(duration=20.0, speed=SPEED, turning=0.0):
    """Along a line; the orientation turns about z [rad/s]."""
    times = np.arange(0.0, duration, 0.02)
    zero = 0.0 * times
    return Poses(times, np.stack([speed * times, zero, zero], axis=1),
                 Rotation.from_rotvec(np.stack([zero, zero, turning * times], axis=1)))


def moved(poses, rotation, translation, scale=1.0):
    return Poses(poses.times, scale * rotation.apply(poses.positions) + translation,
                 rotation * poses.rotations)


def test_another_frame_is_no_error():
    truth = around()
    estimate = moved(truth, Rotation.from_rotvec([0.3, -0.5, 2.0]), [4.0, -1.0, 7.0])
    for errors in comparison.compare(estimate, truth).errors.values():
        assert np.max(errors) < 1e-6
    assert comparison.compare(estimate, truth, 'absolute').figures()['ATE [m]']['rmse'] > 1.0


def test_a_shift_is_an_absolute_error_only():
    truth = around()
    figures = comparison.compare(moved(truth, Rotation.identity(), [0.3, 0.0, 0.4]), truth,
                                 'absolute').figures()
    assert all(value == pytest.approx(0.5) for value in figures['ATE [m]'].values())
    assert figures['RPE of 1 s [m]']['max'] < 1e-9
    assert figures['ATE [deg]']['max'] < 1e-6


def test_a_wrong_scale():
    truth = around(duration=8.0 * np.pi)  # a whole circle
    truth.positions[:, 2] = 0.0
    estimate = moved(truth, Rotation.identity(), [0.0, 0.0, 0.0], 1.1)
    figures = comparison.compare(estimate, truth).figures()
    assert figures['ATE [m]']['rmse'] == pytest.approx(0.1 * RADIUS, rel=1e-3)
    chord = 2.0 * RADIUS * np.sin(0.5 * SPEED / RADIUS)  # of 1 s
    assert figures['RPE of 1 s [m]']['mean'] == pytest.approx(0.1 * chord, rel=1e-4)
    scaled = comparison.compare(estimate, truth, 'similarity').figures()
    assert scaled['scale'] == pytest.approx(1.0 / 1.1)
    assert scaled['ATE [m]']['max'] < 1e-6 and scaled['RPE of 1 s [m]']['max'] < 1e-6


def test_drift():
    truth, estimate = along(), along(speed=1.02 * SPEED, turning=0.01)
    figures = comparison.compare(estimate, truth, 'absolute', interval=2.0).figures()
    last = 0.02 * SPEED * truth.times[-1]  # the error grows from zero in proportion to the time
    shares = {'rmse': np.sqrt(1.0 / 3.0), 'mean': 0.5, 'median': 0.5, 'p95': 0.95, 'max': 1.0}
    assert figures['ATE [m]'] == {name: pytest.approx(share * last, rel=1e-3)
                                  for name, share in shares.items()}
    assert figures['ATE [m]']['max'] == pytest.approx(last)
    assert figures['RPE of 2 s [deg]']['mean'] == pytest.approx(np.degrees(0.02))
    angles = 0.01 * truth.times[:-100]  # the law of cosines, in the estimate's own frame
    lengths = np.sqrt(1.0 + 1.02 ** 2 - 2.04 * np.cos(angles)) * 2.0 * SPEED
    assert figures['RPE of 2 s [m]']['rmse'] == pytest.approx(np.sqrt((lengths ** 2).mean()),
                                                              rel=1e-6)


def test_clocks_and_gaps():
    truth = around()
    late = truth.shifted(0.4)
    error = comparison.compare(late, truth, 'absolute').figures()['ATE [m]']['mean']
    assert error == pytest.approx(0.4 * np.hypot(SPEED, 0.1 * SPEED / RADIUS), rel=1e-3)
    assert comparison.compare(late.shifted(-0.4), truth, 'absolute').errors['ATE [m]'].max() < 1e-6
    hole = truth.chosen(np.abs(truth.times - 1010.0) > 1.0)
    used = comparison.compare(truth, hole).truth.times
    assert np.abs(used - 1010.0).min() > 1.0 and len(used) >= len(hole.times) - 1
    with pytest.raises(Refusal, match='fewer than three'):
        comparison.compare(truth.shifted(100.0), truth)


def test_a_straight_path_tells_all_but_the_turn_about_it():
    random, truth = np.random.default_rng(3), along(turning=0.2)
    noise = random.normal(0.0, 1e-3, truth.positions.shape)
    for offsets, error in ((noise, np.sqrt(3.0) * 1e-3), (0.0 * noise, 0.0)):
        estimate = moved(dataclasses.replace(truth, positions=truth.positions + offsets),
                         Rotation.from_rotvec([0.3, -0.5, 2.0]), [4.0, -1.0, 7.0])
        compared = comparison.compare(estimate, truth)
        figures = compared.figures()
        assert figures['ATE [m]']['rmse'] == pytest.approx(error, rel=0.05, abs=1e-9)
        assert figures['RPE of 1 s [m]']['rmse'] == pytest.approx(np.sqrt(2.0) * error, rel=0.05,
                                                                  abs=1e-9)
        assert figures['RPE of 1 s [deg]']['max'] < 1e-5 and 'ATE [deg]' not in figures
        assert 'ATE [deg] is left out' in list(evaluate_trajectory.table(figures))[-1]
    assert 'ATE [deg]' in comparison.compare(truth, truth, 'absolute').figures()


def test_a_body_that_rests_does_not_tell_the_alignment():
    random, truth = np.random.default_rng(4), around(speed=0.0)
    estimate = dataclasses.replace(truth, positions=truth.positions
                                   + random.normal(0.0, 1e-3, truth.positions.shape))
    truth.positions[:] += random.normal(0.0, 1e-6, truth.positions.shape)
    with pytest.raises(Refusal, match='too short to align.*--alignment absolute'):
        comparison.compare(estimate, truth)
    truth.positions[:] = estimate.positions[:] = truth.positions[0]
    with pytest.raises(Refusal, match='too short to align'):
        comparison.compare(estimate, truth)
    assert comparison.compare(estimate, truth, 'absolute').errors['ATE [deg]'].max() < 1e-6
    truth.positions[:] += np.linspace(0.0, 1.0, len(truth.times))[:, None]
    for kind in ('rigid', 'similarity'):
        with pytest.raises(Refusal, match='--alignment absolute'):
            comparison.compare(estimate, truth, kind)


def test_an_interval_that_no_two_poses_have():
    for interval, word in ((100.0, 'smaller'), (0.001, 'larger')):
        with pytest.raises(Refusal, match=f'use a {word} --interval'):
            comparison.compare(around(), around(), interval=interval)


def write(bag, topic, poses, delay=0.0):
    for time, position, turn in zip(poses.times, poses.positions, poses.rotations.as_quat()):
        message = Odometry()
        message.header.stamp = rospy.Time.from_sec(time)
        message.header.frame_id, message.child_frame_id = poses.parent, poses.child
        for name, value in zip('xyz', position):
            setattr(message.pose.pose.position, name, value)
        for name, value in zip('xyzw', turn):
            setattr(message.pose.pose.orientation, name, value)
        bag.write(topic, message, rospy.Time.from_sec(time + delay))


def test_a_bag_with_a_mount(tmp_path, capsys):
    truth = around()
    found = mount.Mount(Rotation.from_rotvec([0.1, 0.2, 1.0]), np.array([0.1, 0.0, -0.3]), 0.25)
    estimate = truth.of_mounted(found.rotation, found.translation).shifted(-0.25)
    path = str(tmp_path / 'run.bag')
    with rosbag.Bag(path, 'w') as bag:
        write(bag, '/wand/odometry', truth)
        write(bag, '/odom', estimate)
    mount.write(found, str(tmp_path / 'mount.yaml'))
    picture, result = tmp_path / 'plot.svg', tmp_path / 'result.json'
    topics = ['--estimate', '/odom', '--truth', '/wand/odometry']
    evaluate_trajectory.main([path, *topics, '--mount', str(tmp_path / 'mount.yaml'),
                              '--json', str(result), '--plot', str(picture)])
    assert 'ATE [m]' in capsys.readouterr().out
    assert json.loads(result.read_text())['ATE [m]']['max'] < 1e-4
    assert '<svg' in picture.read_text()
    before = open(path, 'rb').read()
    for option in ('--json', '--plot'):
        with pytest.raises(SystemExit, match='run.bag: write to another file'):
            evaluate_trajectory.main([path, *topics, option, path])
    assert open(path, 'rb').read() == before
    with pytest.raises(SystemExit, match='Topics with poses: /odom, /wand/odometry'):
        evaluate_trajectory.main([path, '--estimate', '/imu', '--truth', '/wand/odometry'])


def test_a_clock_that_was_set_back_mixes_no_times(tmp_path):
    path = str(tmp_path / 'run.bag')
    with rosbag.Bag(path, 'w') as bag:
        for start, recorded in ((1000.0, 1000.0), (1002.0, 1004.0)):
            write(bag, '/odom', around(duration=4.0, start=start), recorded - start)
    with pytest.raises(SystemExit, match=r'go back by 2\.0 s'):
        evaluate_trajectory.main([path, '--estimate', '/odom', '--truth', '/odom'])


def test_bags_that_cannot_be_read(tmp_path, monkeypatch):
    path = tmp_path / 'run.bag'
    with rosbag.Bag(str(path), 'w') as bag:
        write(bag, '/odom', around(duration=1.0))
    arguments = ['--estimate', '/odom', '--truth', '/odom']
    broken = tmp_path / 'broken.bag'
    for content in (path.read_bytes()[:-4000], b'no bag', b''):
        broken.write_bytes(content)
        with pytest.raises(SystemExit, match='broken.bag cannot be read'):
            evaluate_trajectory.main([str(broken), *arguments])
    with pytest.raises(SystemExit, match='missing.bag cannot be read .*; name a bag'):
        evaluate_trajectory.main([str(tmp_path / 'missing.bag'), *arguments])
    monkeypatch.setattr(rosbag.Bag, 'read_messages', lambda *_, **__: iter(()))
    with pytest.raises(SystemExit, match='fewer than two poses'):
        evaluate_trajectory.main([str(path), *arguments])
