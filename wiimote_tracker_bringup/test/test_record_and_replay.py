"""Launch files that record and replay."""

import re
import shlex

import pytest
import roslaunch


@pytest.mark.parametrize('given, found', [
    ('rec 1.bag', '/home/my lab/rec 1.bag'), ('/data/rec.bag', '/data/rec.bag'),
    ('5', '/home/my lab/5')])
def test_a_bag_is_replayed_from_where_the_user_says(load, given, found):
    nodes, _ = load('replay.launch', 'bag:=' + given)
    assert shlex.split(nodes['play'].args)[-1] == found


def test_a_replay_keeps_the_recorded_results_apart(load):
    nodes, parameters = load('replay.launch', 'bag:=x')
    remapped = dict(nodes['play'].remap_args)
    for topic in ('points', 'markers', 'bodies', 'gestures', 'zone_events', 'triggered_points',
                  'led/point', 'led/odometry'):
        assert remapped[topic] == 'recorded/' + topic
    assert remapped['/tf'] == 'recorded/tf'
    assert parameters['/triangulation/label_places'] == ''


def test_what_is_recorded_is_an_input_or_kept_apart_in_a_replay(load):
    """But for topics below the name of a body, which a launch file cannot list."""
    recorded = shlex.split(next(iter(load('record.launch')[0].values())).args)[-1]
    names = set(re.split(r'\|(?![^(]*\))', re.match(r'\(\.\*\)/\((.*)\)\|/tf\|', recorded)[1]))
    inputs = {'ir_blobs', 'camera_info', 'imu/data', 'imu/data_raw', 'battery', 'joy', 'trigger',
              'calibration/(rig|square|verdict)'}
    assert inputs < names
    apart = {name for name, _ in load('replay.launch', 'bag:=x')[0]['play'].remap_args}
    assert names - inputs - {'pose', 'twist', 'odometry'} <= apart


def test_a_live_start_ends_the_simulated_time_of_a_replay(load):
    assert load('replay.launch', 'bag:=x')[1]['/use_sim_time'] is True
    assert load('tracker.launch')[1]['/use_sim_time'] is False
    assert '/use_sim_time' not in load('calibrate.launch', 'drivers:=false')[1]


def test_a_replay_in_a_namespace_sets_the_time_of_all(load, monkeypatch):
    monkeypatch.setenv('ROS_NAMESPACE', 'lab')
    assert load('replay.launch', 'bag:=x')[1]['/use_sim_time'] is True


def test_a_recording_may_have_a_number_as_its_name(load):
    nodes, _ = load('record.launch', 'output:=20261123')
    assert "'--output-prefix=/home/my lab/20261123'" in next(iter(nodes.values())).args


def test_a_recording_has_all_results_and_is_written_where_the_user_stands(load):
    nodes, _ = load('record.launch')
    arguments = shlex.split(next(iter(nodes.values())).args)
    assert '--output-prefix=/home/my lab/tracker' in arguments
    for topic in ('/wiimote_1/ir_blobs', '/room/wiimote_1/joy', '/imu/data', '/calibration/rig',
                  '/points', '/bodies', '/wand/pose', '/gestures', '/tf', '/tf_static',
                  '/diagnostics'):
        assert re.fullmatch(arguments[-1], topic), topic
    assert not re.fullmatch(arguments[-1], '/markers')


@pytest.mark.parametrize('given, split', [
    ([], ['--duration=10m']), (['split_minutes:=600'], ['--duration=600m']),
    (['gigabytes:=20'], ['--size=2048', '--max-splits=9']),
    (['gigabytes:=0.5'], ['--size=51', '--max-splits=9']),
    (['gigabytes:=0.01'], ['--size=1', '--max-splits=9'])])
def test_a_recording_may_be_of_the_newest_gigabytes(load, given, split):
    nodes, _ = load('record.launch', *given)
    assert [word for word in shlex.split(next(iter(nodes.values())).args)
            if word.startswith(('--duration', '--size', '--max-splits'))] == split


# rosbag takes --size=0, of bags of whole MB, as no limit.
@pytest.mark.parametrize('gigabytes', ['-1', 'nan', '0.005', 'abc', '5GB'])
def test_gigabytes_too_few_are_refused(load, gigabytes):
    with pytest.raises(roslaunch.core.RLException, match='tag: .gigabytes must be 0, or 0.01'):
        load('record.launch', 'gigabytes:=' + gigabytes)


def test_a_replay_knows_bodies_and_codes(load):
    parameters = load('replay.launch', 'bag:=x', 'bodies:=b.yaml', 'blink_codes:=c.yaml')[1]
    assert parameters['/triangulation/bodies/file'] == '/home/my lab/b.yaml'
    assert parameters['/triangulation/identity/codes'] == '/home/my lab/c.yaml'
