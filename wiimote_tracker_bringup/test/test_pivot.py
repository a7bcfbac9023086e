"""The tip of a probe from a pivot: errors against the Cramer-Rao bound."""

import types
from unittest import mock

import numpy as np
import pytest
import rosgraph
import rospy
from nav_msgs.msg import Odometry
from sensor_msgs.msg import Joy
from scipy.spatial.transform import Rotation

from wiimote_tracker_body_motion import pivot, probe
from wiimote_tracker_bringup import published_bodies
from wiimote_tracker_bringup.errors import Refusal

TIP, PLACE = np.array([0.02, -0.01, -0.3]), np.array([1.0, 0.5, 0.0])  # [m]
STDDEVS = np.array([0.001, 0.001, 0.002, 0.015, 0.015, 0.01])  # of a pose [m, rad]


def poses(tilt=0.5, number=200):
    """Exact: the probe goes round, tilted to all sides."""
    phase = np.linspace(0.0, 4.0 * np.pi, number)
    rotations = Rotation.from_rotvec(np.stack([tilt * np.cos(phase), tilt * np.sin(1.5 * phase),
                                               0.3 * np.sin(phase)], axis=1))
    return PLACE - rotations.apply(TIP), rotations


def noisy(random, **motion):
    positions, rotations = poses(**motion)
    noise = STDDEVS * random.normal(size=(len(positions), 6))
    covariances = np.broadcast_to(np.diag(STDDEVS ** 2), (len(positions), 6, 6))
    return positions + noise[:, :3], Rotation.from_rotvec(noise[:, 3:]) * rotations, covariances


def bound():
    """Covariance of tip and place, for exact derivatives at the truth."""
    rotations = poses()[1]
    weights = []
    for rotation in rotations.as_matrix():
        x, y, z = rotation @ TIP
        by_pose = np.hstack([np.eye(3), [[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]]])
        by_tip = np.hstack([rotation, -np.eye(3)])
        weights.append(by_tip.T @ np.linalg.inv(by_pose * STDDEVS ** 2 @ by_pose.T) @ by_tip)
    return np.linalg.inv(sum(weights))[:3, :3]


def test_reaches_the_bound():
    random, errors, normalised = np.random.default_rng(3), [], []
    for _ in range(60):
        tip = pivot.solve(*noisy(random))
        errors.append(tip.position - TIP)
        normalised.append(errors[-1] @ np.linalg.solve(tip.covariance, errors[-1]) / 3.0)
    ratio = np.sqrt((np.array(errors) ** 2).sum(axis=1).mean() / np.trace(bound()))
    print(ratio, np.mean(normalised), np.sqrt(np.trace(bound())), np.mean(errors, axis=0))
    assert ratio < 1.1
    assert 0.8 < np.mean(normalised) < 1.2


def test_exact_poses():
    positions, rotations = poses()
    covariances = np.broadcast_to(np.diag(STDDEVS ** 2), (len(positions), 6, 6))
    tip = pivot.solve(positions, rotations, covariances)
    assert np.allclose(tip.position, TIP, atol=1e-6) and np.allclose(tip.place, PLACE, atol=1e-6)
    assert tip.residual < 1e-6


def test_refusals():
    random = np.random.default_rng(4)
    with pytest.raises(Refusal, match='tilt the probe further'):
        pivot.solve(*noisy(random, tilt=0.005))
    with pytest.raises(Refusal, match='20 poses, 30 are needed'):
        pivot.solve(*noisy(random, number=20))
    positions, rotations, covariances = noisy(random)
    positions[100:] += [0.04, 0.0, 0.0]
    with pytest.raises(Refusal, match='did not rest'):
        pivot.solve(positions, rotations, covariances)


def messages(positions, rotations, covariances, start=1000.0):
    for number, (position, turn) in enumerate(zip(positions, rotations.as_quat())):
        message = Odometry()
        message.header.stamp = rospy.Time.from_sec(start + 0.05 * number + 0.01)
        pose = message.pose.pose
        pose.position.x, pose.position.y, pose.position.z = position
        turned = pose.orientation
        turned.x, turned.y, turned.z, turned.w = turn
        message.pose.covariance = covariances[number].reshape(-1).tolist()
        yield message


def test_probe_saves_points(tmp_path):
    random, file = np.random.default_rng(5), tmp_path / 'points.csv'
    measuring = probe.Probe([0.0, 0.0, 0.0], 10.0, str(file))
    with pytest.raises(Refusal, match='never seen'):
        measuring.pivot()
    for message in messages(*noisy(random)):
        measuring.add(message)
    assert 'tip: [' in measuring.pivot()
    assert np.linalg.norm(measuring.tip - TIP) < 0.003
    moving, rotations, covariances = noisy(random, number=20)
    for message in messages(moving + np.linspace(0.0, 0.5, 20)[:, None], rotations, covariances,
                            1020.0):
        measuring.add(message)
    with pytest.raises(Refusal, match='hold it still'):
        measuring.save_point()
    for message in messages(*noisy(random, tilt=0.001, number=20), start=1030.0):
        measuring.add(message)
    measuring.save_point()
    time, *row = np.loadtxt(file, delimiter=',', skiprows=1)
    assert time == pytest.approx(1030.96)
    assert np.linalg.norm(row[:3] - PLACE) < 0.006 and 0.001 < row[3] < 0.01
    assert file.read_text().startswith('time [s],x [m]')


def test_a_hidden_probe_tells_no_point(tmp_path):
    random, file, now = np.random.default_rng(8), tmp_path / 'points.csv', [50.0]
    measuring = probe.Probe(TIP, 10.0, str(file), lambda: now[0])
    for message in messages(*noisy(random, tilt=0.001, number=20)):
        measuring.add(message)
    now[0] += 3.0
    with pytest.raises(Refusal, match='last seen 3.0 s ago'):
        measuring.save_point()
    assert not file.exists()
    now[0] += 10.0
    with pytest.raises(Refusal, match='last seen 13.0 s ago'):
        measuring.pivot()  # not of what was before


def test_a_pivot_begins_with_its_request():
    """What the cameras saw while the tip was carried to the dimple does not count."""
    random = np.random.default_rng(9)
    measuring = probe.Probe(TIP, 10.0, '')
    carried, rotations, covariances = noisy(random, number=60)
    carried += np.linspace(0.5, 0.0, 60)[:, None]
    for message in messages(carried, rotations, covariances, 997.0):
        measuring.add(message)
    since = measuring.last_stamp()
    with pytest.raises(Refusal, match='0 poses, 30 are needed'):
        measuring.pivot(since)
    for message in messages(*noisy(random, number=160)):  # then hidden for the last 2 s
        measuring.add(message)
    with pytest.raises(Refusal, match='did not rest'):
        measuring.pivot()
    assert 'tip: [' in measuring.pivot(since)


def test_points_are_taken_at_rest_once_a_place(tmp_path):
    random, file = np.random.default_rng(7), tmp_path / 'points.csv'
    measuring = probe.Probe(TIP, 10.0, str(file))
    _, rotations, covariances = noisy(random, tilt=0.001, number=100)
    steps = np.clip((np.arange(100) - 40.0) / 20.0, 0.0, 1.0)  # rests for 2 s, moves for 1 s, rests
    places = PLACE + np.outer(steps, [0.3, 0.0, 0.0]) - rotations.apply(TIP)
    for message in messages(places, rotations, covariances):
        measuring.add(message)
        if measuring.rests_elsewhere():
            measuring.save_point()
    points = np.loadtxt(file, delimiter=',', skiprows=1)[:, 1:4]
    assert np.abs(points - [PLACE, PLACE + [0.3, 0.0, 0.0]]).max() < 0.02 and len(points) == 2


def test_the_button_saves_once_when_pressed():
    node, saved = object.__new__(probe.Node), []
    node.probe = types.SimpleNamespace(save_point=lambda: saved.append(1) or 'saved')
    node.pressed = True
    for a in (1, 0, 1, 1, 0, 1):  # held down at the start: an old message
        node.on_joy(Joy(buttons=[0, 0, a]))
    node.on_joy(Joy())
    assert len(saved) == 2


def test_pose_of_the_tip():
    measuring = probe.Probe(TIP, 10.0, '')
    positions, rotations = poses(number=1)
    root = np.random.default_rng(6).normal(size=(6, 6)) * 1e-3
    message, = messages(positions, rotations, [root @ root.T])
    pose = measuring.tip_pose(message)
    place = pose.pose.pose.position
    assert np.allclose([place.x, place.y, place.z], PLACE)
    assert message.pose.pose.position.x == positions[0, 0], 'the message was changed'
    x, y, z = rotations[0].apply(TIP)
    moved = np.eye(6)
    moved[:3, 3:] = [[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]]
    assert np.allclose(np.reshape(pose.pose.covariance, (6, 6)), moved @ root @ root.T @ moved.T,
                       atol=1e-15)


def test_probe_forgets_when_time_jumps_back():
    measuring = probe.Probe(TIP, 10.0, '')
    for seconds in (100.0, 100.1, 50.0, 50.1):
        message = Odometry()
        message.header.stamp = rospy.Time.from_sec(seconds)
        measuring.add(message)
    assert [message.header.stamp.to_sec() for message in measuring.newest(10.0)] == [50.0, 50.1]


def test_probe_names_a_body_that_nobody_publishes(monkeypatch):
    said = []
    monkeypatch.setattr(rospy, 'get_name', lambda: '/probe')
    monkeypatch.setattr(rospy, 'logwarn', said.append)
    monkeypatch.setattr(published_bodies, 'names', lambda asker: ['/wand'])
    node = object.__new__(probe.Node)
    node.probe = probe.Probe(TIP, 10.0, '')
    for node.body in ('/wand', '/nix'):
        node.on_patience(None)
    assert said == ['Nobody publishes /nix/odometry: learn this body (learn_body), or name '
                    'another by _body:=; there are /wand']


@pytest.mark.parametrize('error', [ConnectionRefusedError, rosgraph.MasterException('gone')])
def test_probe_names_no_body_where_the_master_has_ended(monkeypatch, error):
    warn = mock.Mock()
    monkeypatch.setattr(rospy, 'get_name', lambda: '/probe')
    monkeypatch.setattr(rospy, 'logwarn', warn)
    monkeypatch.setattr(published_bodies, 'names', mock.Mock(side_effect=error))
    node = object.__new__(probe.Node)
    node.probe, node.body = probe.Probe(TIP, 10.0, ''), '/wand'
    node.on_patience(None)
    warn.assert_not_called()


def test_the_timers_of_probe_outlive_a_bag_that_starts_again(monkeypatch):
    ros = mock.Mock()
    ros.get_param.side_effect = lambda name, default: {'~body': 'wand', '~at_rest': True}.get(
        name, default)
    monkeypatch.setattr(probe, 'rospy', ros)
    monkeypatch.setattr(probe.nodes, 'number', lambda name, default, *_: default)
    probe.Node()
    assert [call[1].get('reset') for call in ros.Timer.call_args_list] == [True, True]


@pytest.mark.parametrize(
    'error', [np.linalg.LinAlgError('Singular matrix'), ValueError('zero norm')])
def test_probe_answers_in_words(error):
    def fail():
        raise error
    reply = probe.Node.answer(fail)
    assert not reply.success and f'({error})' in reply.message


@pytest.mark.parametrize(
    'tip', [[1.0, 2.0], [0.0, 0.0, float('nan')], ['a', 0, 0], 'tip', [None] * 3])
def test_probe_refuses_a_tip(tip, monkeypatch):
    monkeypatch.setattr(rospy, 'get_param', lambda name, default: tip)
    monkeypatch.setattr(rospy, 'resolve_name', lambda name: '/probe/tip')
    with pytest.raises(Refusal, match='/probe/tip'):
        probe.read_tip()


def test_probe_refuses_a_misspelt_parameter(monkeypatch):
    monkeypatch.setattr(rospy, 'get_name', lambda: '/probe')
    monkeypatch.setattr(rospy, 'get_param', lambda name, default: {'body': 'a', 'tipp': [1, 2, 3]})
    monkeypatch.setattr(rospy, 'resolve_name', lambda name: '/probe/' + name[1:])
    with pytest.raises(Refusal, match='unknown parameter /probe/tipp: .*rosparam delete'):
        probe.Node()


@pytest.mark.parametrize('given', [{}, {'~body': ''}, {'~body': 5}, {'~body': 'my wand'}])
def test_probe_refuses_a_body(given, monkeypatch):
    monkeypatch.setattr(rospy, 'get_param', lambda name, *default: given.get(name, *default))
    monkeypatch.setattr(rospy, 'resolve_name', lambda name: '/probe/body')
    with pytest.raises(Refusal, match='/probe/body.*_body:=wand'):
        probe.Node()
