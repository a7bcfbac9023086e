"""Launch files take paths from the user's folder, with spaces, and leave no simulated time."""

import fnmatch
import glob
import os
import re
import shlex
import subprocess
import xml.etree.ElementTree as ElementTree

import pytest
import roslaunch.arg_dump

from launch_files import LAUNCH, configuration


@pytest.mark.parametrize('path', sorted(
    path for folder in ('launch', 'benchmark', 'evaluation')
    for path in glob.glob(os.path.join(LAUNCH, '../../wiimote_tracker_*', folder, '*.launch'))),
    ids=os.path.basename)
def test_roslaunch_lists_the_arguments(path):
    listed = roslaunch.arg_dump.get_args([path])
    given = {each.get('name') for each in ElementTree.parse(path).getroot()
             if each.tag == 'arg' and each.get('value') is None}
    assert given == set(listed)  # it would also list an argument of this file with an empty value
    assert [argument for argument in given if not listed[argument][0]] == [], 'without words'


@pytest.mark.parametrize('given, found', [
    ('cameras.yaml', '/home/my lab/cameras.yaml'), ('/etc/cameras.yaml', '/etc/cameras.yaml'),
    ('5', '/home/my lab/5'), ('', '')])
def test_cameras_are_where_the_user_says(load, given, found):
    assert load('tracker.launch', 'cameras:=' + given)[1]['/drivers/file'] == found


@pytest.mark.parametrize('given, found', [
    ('rig.yaml', '/home/my lab/rig.yaml'), ('/etc/rig.yaml', '/etc/rig.yaml')])
def test_a_description_is_where_the_user_says(load, given, found):
    parameters = load('simulated_rig.launch', 'description:=' + given, 'hand:=true')[1]
    assert {parameters[key] for key in (
        '/simulated_rig/description', '/simulated_hand/description', '/drivers/file')} == {found}
    parameters = load('simulated_rig.launch', 'cameras:=' + given, 'hand:=true')[1]
    assert parameters['/simulated_hand/cameras'] == parameters['/drivers/file'] == found


@pytest.mark.parametrize('name, given', [
    ('tracker.launch', []), ('simulated_rig.launch', []), ('replay.launch', ['bag:=x'])])
def test_a_file_of_parameters_wins(load, tmp_path, name, given):
    file = tmp_path / 'my.yaml'
    file.write_text('triangulation: {tracks: {gate: 9.0}, mode: instant}\n'
                    'calibration: {continuous_policy: all, side_length: 3.0}\n'
                    'drivers: {driver: {latency: 0.005}}\n')
    before = load(name, *given)[1]
    after = load(name, 'parameters:=' + str(file), *given)[1]
    changed = {'/triangulation/tracks/gate': 9.0, '/triangulation/mode': 'instant'}
    if name != 'replay.launch':
        changed.update({'/calibration/continuous_policy': 'all', '/calibration/side_length': 3.0,
                        '/drivers/driver/latency': 0.005})
    assert {key: after[key] for key in changed} == changed
    assert all(before.get(key) != value for key, value in changed.items())
    assert all(after[key] == value for key, value in before.items() if key not in changed)


@pytest.mark.parametrize('name, arguments, cleared', [
    ('tracker.launch', ['rviz:=true'],
     {'/calibration/', '/coverage/', '/drivers/', '/triangulation/'}),
    ('tracker.launch', ['one_manager:=true'], {'/calibration/', '/drivers/', '/triangulation/'}),
    ('replay.launch', ['bag:=x'], {'/triangulation/'}),
    ('../../wiimote_tracker_triangulation/launch/gestures.launch', [], {'/gestures/'}),
    ('../../wiimote_tracker_triangulation/launch/record_points.launch', [], {'/record_points/'}),
    ('../../wiimote_tracker_driver/launch/driver.launch', [], {'/wiimote_1/driver/'})])
def test_a_parameter_taken_out_of_a_file_is_not_kept_by_the_master(name, arguments, cleared):
    assert set(configuration(name, *arguments).clear_params) == cleared


def test_a_file_of_parameters_wins_over_those_of_the_coverage(load, tmp_path):
    file = tmp_path / 'my.yaml'
    file.write_text('coverage: {cell_size: 0.2}\n')
    parameters = load('tracker.launch', 'rviz:=true', 'parameters:=' + str(file))[1]
    assert parameters['/coverage/cell_size'] == 0.2


def test_a_file_of_parameters_wins_over_those_of_robot_localization(load, monkeypatch, tmp_path):
    (tmp_path / 'my robot.yaml').write_text(
        'ekf_odom: {frequency: 50}\nekf_map: {frequency: 20, process_noise_covariance: [0.1]}\n')
    monkeypatch.chdir(tmp_path)
    before = load('robot_localization.launch')[1]
    after = load('robot_localization.launch', 'parameters:=my robot.yaml')[1]
    changed = {'/ekf_odom/frequency': 50, '/ekf_map/frequency': 20,
               '/ekf_map/process_noise_covariance': [0.1]}
    assert after == dict(before, **changed)
    assert before['/ekf_odom/frequency'] == before['/ekf_map/frequency'] == 100


def started(node, path=''):
    """What the shell in front of a node does. path: where it looks for programs first."""
    return subprocess.run(shlex.split(node.launch_prefix) + ['echo', 'the node runs'],
                          capture_output=True, text=True, timeout=60,
                          env=dict(os.environ, PATH=f'{path}:{os.environ["PATH"]}'))


def test_the_folder_of_a_recording_is_made(load, tmp_path):
    (tmp_path / 'file').write_text('')
    for name, made in (('a/my bags', True), ('file', False)):
        nodes = load('record.launch', f'output:={tmp_path}/{name}/run')[0]
        node, = [node for node in nodes.values() if node.type == 'record']
        done = started(node)
        assert (tmp_path / name).is_dir() == made == ('the node runs' in done.stdout)
        assert ('choose another folder, by output:=' in done.stderr) != made
        assert (done.returncode == 0) == made and node.required


def test_without_robot_localization_its_launch_file_ends_and_says_what_to_install(load, tmp_path):
    node = load('robot_localization.launch')[0]['world_in_map']
    for status in (0, 1):
        rospack = tmp_path / 'rospack'
        rospack.write_text(f'#!/bin/sh\necho $@; exit {status}\n')
        rospack.chmod(0o755)
        done = started(node, str(tmp_path))
        assert done.stdout == ('' if status else 'the node runs\n')
        assert ('install ros-noetic-robot-localization' in done.stderr) == bool(status)
        assert done.returncode == status and node.required


def test_parameters_are_where_the_user_says(load, monkeypatch, tmp_path):
    (tmp_path / 'my lab.yaml').write_text('triangulation: {mode: instant}\n')
    monkeypatch.chdir(tmp_path)
    parameters = load('tracker.launch', 'parameters:=my lab.yaml')[1]
    assert parameters['/triangulation/mode'] == 'instant'


@pytest.mark.parametrize('name', ['tracker.launch', 'several_machines.launch',
                                  'calibrate.launch', 'triangulation.launch rviz:=true',
                                  'replay.launch bag:=x', 'rviz.launch', 'diagnostics.launch'])
def test_misspelt_arguments_are_named_once(load, name):
    types = [node.type for node in load(*name.split())[0].values()]
    assert types.count('master_watch') + types.count('check_arguments') == 1


OTHERS = '../../wiimote_tracker_'


@pytest.mark.parametrize('name, argument, parameter', [
    ('calibrate.launch', 'rig_file', '/calibration/rig_file'),
    ('calibrate.launch', 'socket_directory', '/drivers/socket_directory'),
    ('calibrate.launch', 'camera_info_directory', '/drivers/camera_info_directory'),
    ('simulated_rig.launch', 'socket_directory', '/simulated_rig/socket_directory'),
    ('simulated_rig.launch', 'socket_directory', '/drivers/socket_directory'),
    ('triangulation.launch', 'label_places', '/triangulation/label_places'),
    ('several_machines.launch', 'bodies', '/triangulation/bodies/file'),
    ('replay.launch bag:=x', 'blink_codes', '/triangulation/identity/codes'),
    (OTHERS + 'calibration/launch/calibration.launch', 'rig_file', '/calibration/rig_file'),
    (OTHERS + 'driver/launch/driver.launch', 'record', '/wiimote_1/driver/record'),
    (OTHERS + 'triangulation/launch/gestures.launch', 'file', '/gestures/file'),
    (OTHERS + 'triangulation/launch/record_points.launch', 'csv', '/record_points/csv'),
    (OTHERS + 'triangulation/launch/record_points.launch', 'tum', '/record_points/tum')])
def test_relative_paths_begin_where_the_user_is(load, name, argument, parameter):
    usual = load(*name.split())[1].get(parameter)
    assert not usual or usual.startswith('/') and 'my lab' not in usual
    for given, found in (('my file', '/home/my lab/my file'), ('5', '/home/my lab/5'),
                         ('places/', '/home/my lab/places/'), ('/etc/a.yaml', '/etc/a.yaml')):
        assert load(*name.split(), argument + ':=' + given)[1][parameter] == found


def test_without_the_folder_of_the_user_relative_paths_are_refused(load, monkeypatch):
    """As in a unit of systemd: nodes would take them for paths in ~/.ros."""
    monkeypatch.delenv('PWD')
    with pytest.raises(roslaunch.core.RLException, match="'PWD' is not set"):
        load('tracker.launch', 'rig_file:=rig.yaml')
    found = load('tracker.launch', 'rig_file:=/etc/rig.yaml')[1]['/calibration/rig_file']
    assert found == '/etc/rig.yaml'


@pytest.mark.parametrize('given, found', [
    ('replay:a.wiirec', 'replay:/home/my lab/a.wiirec'), ('replay:/a.wiirec', 'replay:/a.wiirec'),
    ('virtual:/tmp/x', 'virtual:/tmp/x'), ('virtual:x', 'virtual:/home/my lab/x'),
    ('virtual:', 'virtual:'), ('5', '5'), ('00:1f:32:00:00:01', '00:1f:32:00:00:01')])
def test_a_recording_or_socket_of_a_driver_is_where_the_user_says(load, given, found):
    parameters = load(OTHERS + 'driver/launch/driver.launch', 'device:=' + given)[1]
    assert parameters['/wiimote_1/driver/device'] == found


def test_simulated_rigs_share_no_files_with_another_rig(load, monkeypatch):
    monkeypatch.setenv('ROS_HOME', '/var/lib/lab')
    usual, real = (load(name)[1] for name in ('simulated_rig.launch', 'tracker.launch'))
    for name in ('/drivers/camera_info_directory', '/triangulation/label_places',
                 '/triangulation/bodies/file'):
        assert usual[name].startswith('/var/lib/lab/wiimote_tracker/simulated/')
        assert not real[name].startswith('/var/lib/lab/wiimote_tracker/simulated/')
    # Beside the rig its cameras and samples are saved.
    assert usual['/calibration/rig_file'] == '/var/lib/lab/wiimote_tracker/simulated/rig.yaml'
    for rig_file, folder in (('planned_rig.yaml', 'planned_cameras'), ('my.yaml', 'my_cameras'),
                             ('rig', 'rig_cameras'), ('planned/rig.yaml', 'planned/rig_cameras')):
        parameters = load('simulated_rig.launch', 'rig_file:=' + rig_file)[1]
        assert parameters['/drivers/camera_info_directory'] == '/home/my lab/' + folder


@pytest.mark.parametrize('namespace', ['', 'first', '/second'])
def test_each_namespace_has_its_own_label_places(load, monkeypatch, namespace):
    """A file in this folder, also where the namespace is that of a group."""
    monkeypatch.setenv('ROS_HOME', '/var/lib/lab')
    monkeypatch.setenv('ROS_NAMESPACE', namespace)
    places = [value for name, value in load('triangulation.launch')[1].items()
              if name.endswith('/label_places')]
    assert places == ['/var/lib/lab/wiimote_tracker/']


@pytest.mark.parametrize(
    'name', ['tracker.launch', 'simulated_rig.launch', 'several_machines.launch'])
def test_a_service_without_a_home_can_start_it(load, monkeypatch, name):
    monkeypatch.delenv('HOME')
    monkeypatch.setenv('ROS_HOME', '/var/lib/lab')
    assert load(name)[1]['/triangulation/bodies/file'].startswith('/var/lib/lab/wiimote_tracker/')


def test_each_user_has_own_virtual_remotes(load, monkeypatch):
    folders = []
    for user in ('anna', 'ben'):
        monkeypatch.setenv('USER', user)
        parameters = load('simulated_rig.launch')[1]
        folders.append(parameters['/simulated_rig/socket_directory'])
        assert parameters['/drivers/socket_directory'] == folders[-1]
    assert folders[0] != folders[1]


def test_rviz_beside_a_service_has_the_coverage(load):
    started = {name for name in load('rviz.launch')[0] if 'check_arguments' not in name}
    assert started == {'coverage', 'rviz'}
    service, all_at_once = load('tracker.launch')[0], load('tracker.launch', 'rviz:=true')[0]
    assert set(all_at_once) == set(service) | started


@pytest.mark.parametrize('given, frame', [([], 'world'), (['world:=second_world'], 'second_world')])
def test_rviz_shows_the_world_frame_of_its_rig(load, given, frame):
    words = shlex.split(load('rviz.launch', *given)[0]['rviz'].args)
    assert words[-2:] == ['-f', frame]
    with open(words[words.index('-d') + 1], encoding='utf-8') as file:
        assert set(re.findall('(?:Reference|Target) Frame: (.*)', file.read())) == {'<Fixed Frame>'}


@pytest.mark.parametrize('name', ['tracker.launch', 'calibrate.launch', 'triangulation.launch',
                                  'several_machines.launch', 'simulated_rig.launch hand:=true',
                                  'rviz.launch'])
def test_nodes_that_are_respawned_know_it(load, name):
    nodes = load(*name.split())[0].values()
    # Of drivers it is what they start that is respawned.
    respawned = [node for node in nodes
                 if (node.respawn or node.type == 'drivers') and node.type != 'master_watch']
    assert respawned
    for node in respawned:
        assert ('WIIMOTE_TRACKER_RESPAWNS', '1') in node.env_args


@pytest.mark.parametrize('given, name', [([], 'triangulation'), (['one_manager:=true'], 'manager')])
def test_the_tracker_is_started_again_soon(load, given, name):
    node = load('tracker.launch', *given)[0][name]
    assert node.respawn and node.respawn_delay <= 0.2


def test_the_hand_is_started_again(load):
    assert load('simulated_rig.launch', 'hand:=true')[0]['simulated_hand'].respawn


@pytest.mark.parametrize('arguments', [[], ['one_manager:=true'], ['rviz:=true']])
def test_the_demo_builds_what_its_launch_file_starts(load, arguments):
    with open(os.path.join(LAUNCH, '../CMakeLists.txt'), encoding='utf-8') as file:
        built = re.search(r'foreach\(target ([^)]*)\)', file.read()).group(1).split()
    packages = os.path.join(LAUNCH, '../..')
    started = {node.type for node in load('simulated_rig.launch', *arguments)[0].values()
               if node.package.startswith('wiimote_tracker_')}
    scripts = {name for package in os.listdir(packages) if package.startswith('wiimote_tracker_')
               for _, _, names in os.walk(os.path.join(packages, package)) for name in names}
    assert 'simulated_rig' in started
    assert started - scripts <= set(built)


@pytest.mark.parametrize('given, found', [
    ([], '/data/gestures.yaml'), (['file:=/tmp/own.yaml'], '/tmp/own.yaml')])
@pytest.mark.parametrize('nodelet', ['true', 'false'])
def test_the_parameter_file_names_the_examples_of_gestures(load, tmp_path, given, found, nodelet):
    file = tmp_path / 'my.yaml'
    file.write_text('file: /data/gestures.yaml\n')
    launch = os.path.join(LAUNCH, '../../wiimote_tracker_triangulation/launch/gestures.launch')
    parameters = load(launch, 'config:=' + str(file), 'nodelet:=' + nodelet, *given)[1]
    assert parameters['/gestures/file'] == found


def test_mavros_gets_one_of_two_messages(load):
    for message, topics in (('odometry', ['base_link/odometry', 'mavros/odometry/out']),
                            ('vision_pose', ['base_link/pose', 'mavros/vision_pose/pose_cov'])):
        node = load('mavros_vision.launch', 'message:=' + message)[0]['mavros_' + message]
        assert node.args.split()[1::2] == topics
    with pytest.raises(roslaunch.core.RLException, match='odometry.*vision_pose'):
        load('mavros_vision.launch', 'message:=odom')
    for rate in ('0', '-40', 'fast'):
        with pytest.raises(roslaunch.core.RLException, match='tag: .rate must be above 0'):
            load('mavros_vision.launch', 'rate:=' + rate)


@pytest.mark.parametrize('nodelet', ['true', 'false'])
def test_gestures_take_a_button_of_any_topic(load, nodelet):
    launch = os.path.join(LAUNCH, '../../wiimote_tracker_triangulation/launch/gestures.launch')
    node = load(launch, 'joy:=/wiimote_1/joy', 'nodelet:=' + nodelet)[0]['gestures']
    assert [list(each) for each in node.remap_args] == [['joy', '/wiimote_1/joy']]


@pytest.mark.parametrize('path', sorted(glob.glob(
    os.path.join(LAUNCH, '../../wiimote_tracker_*/test/**/*_nodelet.test'), recursive=True)),
    ids=os.path.basename)
def test_what_a_nodelets_test_chooses_is_there(path):
    """gtest runs nothing for a name that has changed, and calls it a success."""
    text = ''.join(open(each, encoding='utf-8').read() for each in glob.glob(
        os.path.join(os.path.dirname(path), '*.cpp')))
    tests = ['.'.join(found) for found in re.findall(r'^TEST(?:_F)?\((\w+), (\w+)\)', text, re.M)]
    for test in ElementTree.parse(path).getroot().iter('test'):
        for names in re.findall(r'--gtest_filter=(\S+)', test.get('args', '')):
            for name in names.split(':'):
                assert fnmatch.filter(tests, name), name
