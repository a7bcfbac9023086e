"""check_setup, with fakes of the driver's programs and of the ROS master."""

import http.server
import json
import os
import socket
import subprocess
import sys
import threading

import program_module
import pytest
import roslib.packages
from wiimote_tracker_bringup.waiting import wait_until

check_setup = program_module.load('launch/check_setup')

A, B = '00:1f:32:00:00:01', '00:1f:32:00:00:02'
BLUETOOTH = 'Uses the Bluetooth adapter 00:1A:7D:DA:71:13.\nPaired remotes: %s.\n' % A.upper()


def listed(*remotes, computer_problems=()):
    """What list_wiimotes --json prints."""
    advice = '' if remotes else 'No Wii Remote is connected'
    return json.dumps({'remotes': remotes, 'advice': advice,
                       'computer_problems': computer_problems})


def remote(address=A, usable=True, problems=()):
    return {'address': address, 'device': '/dev/hidraw3', 'usable': usable, 'problems': problems}


NO_PERMISSION = ['permission denied on /dev/hidraw3: install the rule']
CAMERAS = 'cameras:\n  door: "%s"\n'
RIG = ('version: 1\ncameras:\n  door:\n    identity: "%s"\n    extrinsics: {}\n'
       '    camera_matrix: {data: [1300, 0, 512, 0, 1300, 384, 0, 0, 1]}\ncomplete: true\n')


class Master:
    """A ROS master with these parameters and publishers; None: it does not run. All nodes have the
    same port."""
    parameters, publishers, port = {}, None, 0

    def __init__(self, name):
        pass

    def getSystemState(self):
        if self.publishers is None:
            raise ConnectionRefusedError()
        return self.publishers, [], []

    def lookupNode(self, name):
        return f'http://localhost:{self.port}/'

    def hasParam(self, name):
        return name in self.parameters

    def getParam(self, name):
        return self.parameters[name]


@pytest.fixture
def check(tmp_path, monkeypatch, capsys):
    """Runs check_setup on a computer where all is well but for what the arguments say."""
    monkeypatch.setenv('PATH', '%s:%s' % (tmp_path, os.environ['PATH']))
    monkeypatch.setenv('ROS_MASTER_URI', 'http://localhost:11311')
    monkeypatch.setattr(check_setup.rosgraph, 'Master', Master)
    monkeypatch.setattr(check_setup, 'BLUETOOTHD', [str(tmp_path / 'bluetoothd')])
    rosrun = tmp_path / 'rosrun'
    rosrun.write_text('#!/bin/sh\ncat {0}/$2 && ! grep -q ^pair: {0}/$2\n'.format(tmp_path))
    rosrun.chmod(0o755)

    def run(bluetooth=BLUETOOTH, remotes=listed(remote()), cameras=CAMERAS % A, rig=RIG % A,
            plugin='wiimote', master=None, parameters={}):
        monkeypatch.setattr(Master, 'publishers', master)
        monkeypatch.setattr(Master, 'parameters', parameters)
        for name, text in [('pair', bluetooth), ('list_wiimotes', remotes), ('rig.yaml', rig),
                           ('cameras.yaml', cameras), ('bluetoothd', plugin)]:
            if text is not None:
                (tmp_path / name).write_text(text)
        arguments = ['--rig', str(tmp_path / 'rig.yaml')]
        arguments += [] if cameras is None else [str(tmp_path / 'cameras.yaml')]
        monkeypatch.setattr(sys, 'argv', ['check_setup'] + arguments)
        status = check_setup.main()
        lines = capsys.readouterr().out.splitlines()
        assert lines[-1].startswith('Next: ')
        assert status == int(any(line.startswith('DO ') for line in lines))
        return status, lines

    return run


@pytest.mark.parametrize('cameras', [
    CAMERAS % A, 'cameras: {door: {identity: "%s", driver: {ir_sensitivity: max}}}' % A])
def test_all_is_well(check, cameras):
    status, lines = check(cameras=cameras)
    assert status == 0
    assert [line.split(':')[0] for line in lines[:-2]] == [
        'ok Bluetooth', 'ok computer', 'ok remote 00', 'ok cameras', 'ok ROS master',
        'ok calibration']
    assert 'tracker.launch cameras:=/' in lines[-1]


@pytest.mark.parametrize('situation, advice', [
    ({'bluetooth': 'pair: the Bluetooth service does not run: run  sudo systemctl'},
     'Next: Bluetooth: the Bluetooth service does not run'),
    ({'plugin': 'nothing'}, 'lacks its wiimote plugin'),
    ({'remotes': listed(computer_problems=['no udev rule'])}, 'Next: computer: no udev rule'),
    ({'remotes': listed()}, 'Next: remotes: No Wii Remote is connected'),
    ({'remotes': listed(remote(A, False, NO_PERMISSION))}, f'{A}: permission denied on /dev/'),
    ({'remotes': listed(remote('', False, NO_PERMISSION))}, 'Next: remote (address unknown): perm'),
    ({'remotes': ''}, 'list_wiimotes says nothing'),
    ({'cameras': CAMERAS % B, 'rig': RIG % B}, f'Next: camera door: {B} is not connected'),
    ({'cameras': None}, 'list_wiimotes --write cameras.yaml'),
    ({'cameras': 'cameras: {a: [1'}, 'not valid YAML'),
    ({'cameras': CAMERAS % A + '  window: "%s"\n' % A}, 'so has another one'),
    ({'cameras': 'cameras: {door: {identity: "%s", driver: {ir_sensitvity: max}}}' % A},
     'camera door has the unknown driver parameter ir_sensitvity: correct its spelling'),
    ({'rig': None}, 'rig.yaml yet: start the tracker, then run'),
    ({'rig': 'cameras:\n'}, 'no complete rig file'),
    ({'rig': 'cameras:\ncomplete: true\n'}, 'no complete rig file'),
    ({'rig': CAMERAS % A + 'complete: true\n'}, 'no complete rig file'),
    ({'rig': (RIG % A).replace('version: 1', 'version: 2')}, 'rig file of this version: start the'),
    ({'rig': (RIG % A).replace('1300', '-1300', 1)}, 'rig file of this version: start the tracker'),
    ({'rig': (RIG % A).replace('door', 'window')}, 'lacks door'),
    ({'rig': RIG % B}, f'door was {B}, but now is {A}'),
    ({'master': [], 'parameters': {'/use_sim_time': True}}, 'a replay has left its simulated time'),
    ({'master': [['/clock', ['/play']]], 'parameters': {'/use_sim_time': True}}, '/play sets'),
], ids=lambda value: '' if isinstance(value, dict) else value.split(':')[-1][:30])
def test_each_problem_gives_advice(check, situation, advice):
    status, lines = check(**situation)
    assert status == 1
    assert advice in lines[-1], lines


def program(name):
    return roslib.packages.find_node('wiimote_tracker_driver', name)[0]


def test_the_real_list_of_remotes_is_understood(check, tmp_path):
    sockets = [str(tmp_path / name) for name in ('a.sock', 'nowhere.sock')]
    command = [program('virtual_wiimote'), '--socket', sockets[0], '--address', A]
    with subprocess.Popen(command) as one:
        try:
            wait_until(lambda: os.path.exists(sockets[0]), 30.0, 'no virtual Wii Remote')
            found = subprocess.run([program('list_wiimotes'), '--json', '--virtual'] + sockets,
                                   stdout=subprocess.PIPE, text=True).stdout
        finally:
            one.terminate()
    _, lines = check(remotes=found)
    assert f'ok remote {A}: can be used' in lines
    assert any(line.startswith('DO remote (address unknown): no virtual Wii Remote listens')
               for line in lines)


@pytest.mark.parametrize('address, named', [
    ('robot:11311', 'robot:11311'), ('htp://robot:11311', 'htp://robot:11311'), ('', 'empty')])
def test_an_address_of_a_master_that_is_none_is_to_be_corrected(monkeypatch, address, named):
    monkeypatch.setenv('ROS_MASTER_URI', address)
    (_, is_fine, advice), = check_setup.check_master()
    assert not is_fine and f'ROS_MASTER_URI is {named}, but' in advice


@pytest.mark.parametrize('answer', [
    b'HTTP/1.0 404 Not Found\r\n\r\n', b'HTTP/1.0 200 OK\r\n\r\n<html>', b'SSH-2.0\r\n'])
def test_a_service_that_is_no_master_is_named(monkeypatch, answer):
    class Service(http.server.BaseHTTPRequestHandler):
        def do_POST(self):
            self.rfile.read(int(self.headers['Content-Length']))
            self.wfile.write(answer)

    with http.server.HTTPServer(('localhost', 0), Service) as server:
        monkeypatch.setenv('ROS_MASTER_URI', f'http://localhost:{server.server_port}')
        thread = threading.Thread(target=server.handle_request)
        thread.start()
        (_, is_fine, advice), = check_setup.check_master()
        thread.join()
    assert not is_fine and 'answers, but is no ROS master: correct ROS_MASTER_URI' in advice


def test_a_list_that_is_not_there_is_to_be_written(tmp_path):
    path = str(tmp_path / 'mine.yaml')
    _, (_, is_fine, advice) = check_setup.read_cameras(path)
    assert not is_fine
    assert f'there is no {path}' in advice and f'list_wiimotes --write {path}' in advice


def test_a_running_tracker_is_named(check, monkeypatch):
    with socket.create_server(('localhost', 0)) as node:
        monkeypatch.setattr(Master, 'port', node.getsockname()[1])
        status, lines = check(master=[['/diagnostics', ['/door/driver', '/master_watch']]],
                              parameters={'/use_sim_time': False})
    assert status == 0
    assert any('where /door/driver run already' in line for line in lines)
    assert f'ok remote {A}: can be used' in lines


def test_a_driver_that_cannot_be_reached_is_named(check, monkeypatch):
    with socket.create_server(('localhost', 0)) as ended:
        monkeypatch.setattr(Master, 'port', ended.getsockname()[1])
    status, lines = check(master=[['/diagnostics', ['/door/driver']]])
    assert status == 1
    assert 'driver /door/driver: it cannot be reached at localhost' in lines[-1]


def test_a_master_elsewhere_must_answer(check, monkeypatch):
    monkeypatch.setenv('ROS_MASTER_URI', 'http://192.0.2.1:11311')
    assert 'http://192.0.2.1:11311 does not answer' in check()[1][-1]


@pytest.mark.parametrize('variable, value', [
    ('ROS_HOSTNAME', 'nohost.invalid'), ('ROS_IP', '203.0.113.1')])
def test_a_computer_must_reach_itself(check, monkeypatch, variable, value):
    monkeypatch.setattr(check_setup, 'MASTER_TIMEOUT', 0.5)
    monkeypatch.delenv('ROS_HOSTNAME', raising=False)  # which counts before ROS_IP
    monkeypatch.setenv(variable, value)
    assert f'network: this computer cannot reach itself as {value}' in check()[1][-1]


def test_only_a_backup_that_is_there_is_to_be_restored(check, tmp_path):
    assert '.bak' not in check(rig='cameras:\n')[1][-1]
    (tmp_path / 'rig.yaml.bak').write_text(RIG % A)
    assert 'restore it from' in check(rig='cameras:\n')[1][-1]


def test_a_computer_without_ros(check, monkeypatch, tmp_path):
    check()
    os.remove(str(tmp_path / 'rosrun'))
    monkeypatch.setenv('PATH', str(tmp_path))
    assert 'source the setup.bash' in check()[1][-1]


def test_without_the_workspace_it_says_to_source_it():
    program = os.path.join(program_module.PACKAGE, 'launch/check_setup')
    unsourced = ("import runpy, sys; sys.modules['wiimote_tracker_bringup'] = None; "
                 f"runpy.run_path({program!r}, run_name='__main__')")
    done = subprocess.run([sys.executable, '-c', unsourced], capture_output=True, text=True,
                          timeout=60)
    assert (done.returncode, done.stdout) == (1, '')
    assert done.stderr == 'check_setup: source the setup.bash of your workspace\n'
