"""The list of cameras, and the script that starts their drivers."""

import json
import os
import subprocess
import types

import program_module
import pytest
from wiimote_tracker_bringup import cameras_file
from wiimote_tracker_bringup.errors import Refusal

HERE = os.path.dirname(os.path.realpath(__file__))
drivers = program_module.load('launch/drivers')


def read(tmp_path, text, socket_directory=''):
    path = tmp_path / 'cameras.yaml'
    path.write_text(text)
    return cameras_file.read_devices(str(path), socket_directory)


def test_addresses_and_paths_in_the_order_of_the_file(tmp_path):
    assert read(tmp_path, 'cameras:\n  b: "00:1f:32:00:00:02"\n  a: /dev/hidraw3\n') == [
        ('b', '00:1f:32:00:00:02'), ('a', '/dev/hidraw3')]


def test_the_example_can_be_read():
    devices = cameras_file.read_devices(os.path.join(HERE, '../config/cameras.yaml'), '')
    assert [name for name, _ in devices] == [f'wiimote_{i}' for i in (1, 2, 3, 4)]


def test_a_rig_description_names_its_cameras_and_sockets():
    devices = cameras_file.read_devices(os.path.join(HERE, '../simulation/paper_rig.yaml'),
                                        '/tmp/s')
    assert devices[0] == ('wiimote_1', 'virtual:/tmp/s/wiimote_1.sock')
    assert len(devices) == 4


def test_a_camera_may_have_parameters_of_its_own(tmp_path):
    path = tmp_path / 'cameras.yaml'
    path.write_text('cameras:\n'
                    '  a: {identity: "00:1f:32:00:00:01", driver: {ir_sensitivity: max}}\n'
                    '  b: "00:1f:32:00:00:02"\n')
    assert cameras_file.read_devices(str(path), '')[0] == ('a', '00:1f:32:00:00:01')
    assert cameras_file.read_parameters(str(path)) == {'a': {'ir_sensitivity': 'max'}, 'b': {}}


def test_a_rig_description_has_keys_of_its_own():
    assert cameras_file.read_parameters(os.path.join(HERE, '../simulation/paper_rig.yaml'))[
        'wiimote_1'] == {}


HEAD, ADDRESS = 'cameras:\n', '"00:1f:32:00:00:01"'
ONE = f'{HEAD}  a: {ADDRESS}\n'
IDENTITY = f'{HEAD}  a:\n    identity: {ADDRESS}\n'


@pytest.mark.parametrize('text, complaint', [
    (ONE, None), ('discover: true\n' + ONE, None), ('discover: true\ncameras:\n', None),
    (HEAD + '  a: /dev/hidraw3\n  b: "virtual:/tmp/b.sock"\n  c: "replay:c.wiirec"\n', None),
    (IDENTITY + '    driver: {ir_mode: full}\n', None), (IDENTITY + '    driver:\n', None),
    (HEAD + '  a: 10:22:33:44:55:66\n', None),
    ('', 'must have "cameras:"'),
    ('discover: true\n', 'must have "cameras:"'),
    ('cameras: {}', 'must have "cameras:"'),
    ('cameras: [a, b]', 'must have "cameras:"'),
    (f'wiimote_1: {ADDRESS}\n', 'must have "cameras:"'),
    ('cameras: {a: [1', 'not valid YAML'),
    (HEAD + '  a: 12\n', 'as a text in quotes'),
    (HEAD + '  a: ""\n', 'as a text in quotes'),
    (HEAD + '  a: {}\n', 'as a text in quotes, after "identity:"'),
    (HEAD + '  a:\n    driver: {ir_mode: full}\n', 'as a text in quotes, after "identity:"'),
    (HEAD + '  a: 11:22:33:44:55:06\n', 'as a text in quotes'),
    (HEAD + '  a: "00:1f:32:00:00"\n', 'camera a has the device 00:1f:32:00:00:'),
    (HEAD + '  a: /dev/ttyUSB0\n', 'a path such as /dev/hidraw0'),
    (HEAD + '  a: /tmp/x\n', 'a path such as /dev/hidraw0'),
    (HEAD + '  a: "virtual:"\n', 'a path such as /dev/hidraw0'),
    (f'{HEAD}  a b: {ADDRESS}\n', "camera name 'a b'"),
    (f'{HEAD}  1: {ADDRESS}\n', 'camera name 1'),
    (f'{HEAD}  küche: {ADDRESS}\n', "camera name 'küche'"),
    (f'{HEAD}  "a\\n": {ADDRESS}\n', "camera name 'a\\n'"),
    (ONE + '  a: /dev/hidraw1\n', 'a is there twice'),
    (ONE + ONE, 'cameras is there twice'),
    (ONE + '  b: "00:1F:32:00:00:01"\n', 'so has another one'),
    ('discovr: true\n' + ONE, 'unknown key discovr'),
    ('discover: perhaps\n' + ONE, '"discover" must be true or false'),
    (ONE + 'discover: true\n', 'above "cameras:"'),
    (IDENTITY + '    drivers: {}\n', 'camera a has the unknown key drivers'),
    (IDENTITY + '    ir_sensitivity: max\n', 'camera a has the unknown key ir_sensitivity'),
    (IDENTITY + '    driver: full\n', '"driver" of camera a must have lines')])
def test_a_list_is_read_or_refused_with_a_reason_as_by_list_wiimotes(tmp_path, text, complaint):
    path = tmp_path / 'cameras.yaml'
    path.write_text(text, encoding='utf-8')
    try:
        cameras_file.read_devices(str(path), '')
        cameras_file.read_parameters(str(path))
        assert complaint is None
    except Refusal as refusal:
        assert str(path) in str(refusal) and complaint and complaint in str(refusal)
    program = drivers.roslib.packages.find_node('wiimote_tracker_driver', 'list_wiimotes')[0]
    listed = subprocess.run(
        [program, '--json', '--cameras', str(path), '--virtual', str(tmp_path / 'none.sock')],
        stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True).stdout
    assert (listed != '' and json.loads(listed)['camera_problems'] == []) == (complaint is None)


def test_a_missing_file_is_named(tmp_path):
    path = str(tmp_path / 'nothing.yaml')
    with pytest.raises(Refusal, match=f'there is no {path}: .* list_wiimotes --write {path}$'):
        cameras_file.read_devices(path, '')
    with pytest.raises(Refusal, match='cannot be read .*: correct its path'):
        cameras_file.read_devices(str(tmp_path), '')


def test_discovered_remotes_keep_their_names(tmp_path, monkeypatch):
    path = tmp_path / 'cameras.yaml'
    path.write_text('discover: true\ncameras:\n')
    assert cameras_file.is_discovering(str(path))
    assert cameras_file.read_devices(str(path), '') == []
    # Replaces list_wiimotes by a program that has found a remote.
    finder = tmp_path / 'finder'
    finder.write_text('#!/bin/sh\n[ "$1" = --write ] || exit 2\n'
                      'printf \'  wiimote_1: "00:1f:32:00:00:01"\\n\' >> "$2"\n'
                      'echo a warning >&2; echo {}\n')
    finder.chmod(0o755)
    monkeypatch.setattr(drivers.roslib.packages, 'find_node', lambda *_: [str(finder)])
    drivers.discover(str(path), '')
    assert cameras_file.read_devices(str(path), '') == [('wiimote_1', '00:1f:32:00:00:01')]
    assert cameras_file.is_discovering(str(path))


def test_discovery_needs_a_file_with_one_line_per_camera(tmp_path):
    path = tmp_path / 'cameras.yaml'
    path.write_text('discover: true\ncameras:\n  a: "00:1f:32:00:00:01"\n')
    drivers.discover(str(path), '')
    assert cameras_file.read_devices(str(path), '')[0] == ('a', '00:1f:32:00:00:01')
    path.write_text('cameras: {a: "00:1f:32:00:00:01"}\n')  # not one line per camera
    with pytest.raises(Refusal, match='remotes cannot be looked for'):
        drivers.discover(str(path), '')


def test_listed_cameras_start_although_others_cannot_be_looked_for(tmp_path, monkeypatch):
    def fail(*_):
        raise Refusal('remotes cannot be looked for: the disk is full')
    said, started = [], []
    monkeypatch.setattr(drivers, 'discover', fail)
    monkeypatch.setattr(drivers.rospy, 'logwarn_throttle', lambda period, text: said.append(text))
    monkeypatch.setattr(drivers.Drivers, '_start', lambda _, name, *__: started.append(name))
    path = tmp_path / 'cameras.yaml'
    those = object.__new__(drivers.Drivers)
    those.is_discovering, those._started, those._common = True, set(), {}
    those._path, those._socket_directory = str(path), ''
    path.write_text('discover: true\n' + ONE)
    those.start()
    assert started == ['a'] and said == ['remotes cannot be looked for: the disk is full']
    path.write_text('discover: true\ncameras:\n')
    with pytest.raises(Refusal, match='the disk is full'):
        those.start()


def test_a_discovered_virtual_remote_keeps_its_socket(tmp_path):
    text = 'discover: true\ncameras:\n  a: "virtual:/tmp/x.sock"\n  b: "00:1f:32:00:00:01"\n'
    assert read(tmp_path, text, '/tmp/s') == [('a', 'virtual:/tmp/x.sock'),
                                              ('b', 'virtual:/tmp/s/b.sock')]


def test_remotes_are_discovered_in_a_folder_with_brackets(tmp_path, monkeypatch):
    sockets = tmp_path / 'room [1]'
    sockets.mkdir()
    (sockets / 'a.sock').touch()
    finder = tmp_path / 'finder'
    finder.write_text('#!/bin/sh\necho "$@" | tee "$2"\n')
    finder.chmod(0o755)
    monkeypatch.setattr(drivers.roslib.packages, 'find_node', lambda *_: [str(finder)])
    drivers.discover(str(tmp_path / 'found'), str(sockets))
    assert (tmp_path / 'found').read_text().endswith(f'--virtual {sockets}/a.sock\n')


def test_discovery_must_be_true_or_false(tmp_path):
    path = tmp_path / 'cameras.yaml'
    path.write_text('discover: maybe\ncameras: {a: "00:1f:32:00:00:01"}')
    with pytest.raises(Refusal, match='"discover" must be true or false'):
        cameras_file.is_discovering(str(path))
    path.write_text('cameras: {a: "00:1f:32:00:00:01"}')
    assert not cameras_file.is_discovering(str(path))


def test_too_many_remotes_for_the_adapters_are_named():
    def remotes(number):
        return [(f'wiimote_{i}', f'00:1f:32:00:00:{i:02x}') for i in range(number)]
    assert cameras_file.too_many(remotes(7), 1) is None
    assert '8 remotes' in cameras_file.too_many(remotes(8), 1)
    assert cameras_file.too_many(remotes(14), 2) is None
    assert cameras_file.too_many(remotes(15), 2)
    assert cameras_file.too_many(remotes(7), 0) is None, 'adapters that cannot be counted'
    assert cameras_file.too_many([(f'a{i}', f'virtual:/tmp/{i}') for i in range(30)], 1) is None


def test_without_a_master_the_drivers_that_run_stay(monkeypatch):
    class NoMaster:
        def start(self):
            raise ConnectionRefusedError(111, 'Connection refused')
    said = []
    monkeypatch.setattr(drivers.rospy, 'logwarn_throttle', lambda period, text: said.append(text))
    drivers.try_to_start_more(NoMaster())
    assert len(said) == 1 and 'check that the ROS master runs' in said[0]


@pytest.mark.parametrize('error', [
    drivers.rospy.exceptions.TransportTerminated('unable to receive data'),
    ConnectionResetError(104, 'Connection reset by peer')])
def test_a_manager_may_end_amid_a_request(monkeypatch, error):
    def request():
        raise error
    monkeypatch.setattr(drivers.rospy, 'ServiceProxy', lambda *_: request)
    manager = object.__new__(drivers.Manager)
    manager._name = '/manager'
    assert manager._call('list', drivers.NodeletList) is None


def test_a_manager_that_was_started_again_gets_its_drivers_soon(monkeypatch):
    now, back, loaded = [0.0], 1.3, []

    def call(_, service, __, *arguments):
        if 0.1 < now[0] < back:
            return None
        if service == 'load_nodelet':
            loaded.append((now[0], arguments[0]))
        return types.SimpleNamespace(nodelets=['/wiimote_1/driver'] if now[0] <= 0.1 else [])

    def sleep(duration):
        now[0] += duration
    monkeypatch.setattr(drivers.Manager, '_call', call)
    monkeypatch.setattr(drivers, 'time', types.SimpleNamespace(sleep=sleep))
    monkeypatch.setattr(drivers.rospy, 'is_shutdown', lambda: bool(loaded))
    manager = object.__new__(drivers.Manager)
    manager._drivers = ['/wiimote_1/driver']
    manager._keep()
    assert [name for _, name in loaded] == ['/wiimote_1/driver']
    assert back <= loaded[0][0] < back + 0.3


@pytest.mark.parametrize('given, complaint', [
    ({'file': 'f', 'drivr': {'ir_sensitivity': 'wii_3'}}, 'unknown parameter .*/drivr: correct'),
    ({'driver': 'wii_3'}, "driver is 'wii_3', but must be a map")])
def test_parameters_without_effect_are_refused(given, complaint):
    with pytest.raises(Refusal, match=complaint):
        drivers.check_parameters(given)
    drivers.check_parameters({'file': 'f', 'driver': {'ir_sensitivity': 'wii_3'}})


@pytest.mark.parametrize('is_ended', (True, False))
def test_drivers_that_are_ended_while_they_start_say_nothing(monkeypatch, is_ended):
    """Ctrl-C also ends rosversion, which roslaunch runs at its start."""
    ended = []

    class Launch:
        def start(self):
            raise drivers.roslaunch.core.RLException('rosversion returned with code [-2]')

        def stop(self):
            ended.append(self)
    monkeypatch.setattr(drivers.nodes, 'start', lambda *_: None)
    monkeypatch.setattr(drivers.roslaunch.scriptapi, 'ROSLaunch', Launch)
    monkeypatch.setattr(drivers.rospy, 'is_shutdown', lambda: is_ended)
    if is_ended:
        assert drivers.main() == 0
    else:
        with pytest.raises(drivers.roslaunch.core.RLException):
            drivers.main()
    assert len(ended) == 1
