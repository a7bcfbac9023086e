"""The program list_wiimotes with simulated remotes, byte by byte.

The environment variable LIST_WIIMOTES is the path of the program.
"""

import json
import os
import socket
import subprocess
import threading

import pytest

DEADLINE = 30.0  # [s]
EXAMPLE = 'cameras:\n  door: "virtual:%s"  # mine\n'


class Remote:
    """A remote at a local socket that answers a request for its status, and records its LEDs."""

    def __init__(self, path, address, battery=0x69, answers=True):
        self.path = path
        self._leds = []
        self._hung_up = threading.Condition()
        self._hosts = 0  # that have disconnected
        self._address = address.encode()
        self._battery = battery
        self._answers = answers
        self._server = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self._server.bind(path)
        self._server.listen(1)
        threading.Thread(target=self._serve, daemon=True).start()

    def _serve(self):
        while True:
            host, _ = self._server.accept()
            try:
                host.send(self._address)
                report = host.recv(32)
                while report:
                    if report[0] == 0x15 and self._answers:
                        host.send(bytes([0x20, 0, 0, 0x20, 0, 0, self._battery]))
                    if report[0] == 0x11:
                        self._leds.append(report[1] >> 4)
                    report = host.recv(32)
            except OSError:
                pass
            host.close()
            with self._hung_up:
                self._hosts += 1
                self._hung_up.notify_all()

    def leds_after(self, hosts):
        """The states of its LEDs, once this many hosts have disconnected."""
        with self._hung_up:
            assert self._hung_up.wait_for(lambda: self._hosts >= hosts, DEADLINE)
        return self._leds


def list_wiimotes(*arguments, **environment):
    done = subprocess.run([os.environ['LIST_WIIMOTES']] + list(arguments),
                          env=dict(os.environ, **environment), stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, timeout=DEADLINE)
    return done.returncode, done.stdout.decode()


@pytest.fixture
def remotes(tmp_path):
    return [Remote(str(tmp_path / ('%d.sock' % i)), '00:1f:32:00:00:0%d' % i) for i in (1, 2)]


def test_free_remotes_are_shown_with_their_battery(remotes):
    status, text = list_wiimotes('--virtual', remotes[0].path, remotes[1].path)
    assert status == 0
    assert '1  00:1f:32:00:00:01  virtual:%s' % remotes[0].path in text
    assert '2  00:1f:32:00:00:02' in text
    assert text.count('free, battery 100 % (raw 105)') == 2


def test_programs_read_json(remotes, tmp_path):
    path = tmp_path / 'cameras.yaml'
    path.write_text('cameras:\n  door: "x"\n')
    taken = Remote(str(tmp_path / 'ta"ken.sock'), f'taken by process {os.getpid()}')
    nowhere = str(tmp_path / 'nowhere.sock')
    status, text = list_wiimotes('--json', '--write', str(path), '--virtual', remotes[0].path,
                                 taken.path, nowhere)
    found = json.loads(text)
    free, used, absent = found['remotes']
    assert status == 1
    assert free == {
        'address': '00:1f:32:00:00:01', 'device': 'virtual:' + remotes[0].path,
        'camera': 'wiimote_1', 'description': 'virtual Wii Remote', 'usable': True,
        'state': 'free, battery 100 % (raw 105)', 'notes': [], 'problems': []}
    assert used['usable'] and 'in use' in used['notes'][0] and used['problems'] == []
    assert used['device'] == 'virtual:' + taken.path
    assert not absent['usable'] and 'listens at' in absent['problems'][0]
    assert found['absent'] == [{'camera': 'door', 'device': 'x'}]
    assert 'camera door has the device x' in found['camera_problems'][0]
    assert found['computer_problems'] == [] and found['advice'] == ''

    status, text = list_wiimotes('--json', '--device', '00:00:00:00:00:00')
    found = json.loads(text)
    assert status == 1
    assert found['remotes'] == [] and 'not connected' in found['advice']


def test_a_remote_in_use_is_no_error(tmp_path):
    # A virtual remote greets a second host so.
    taken = Remote(str(tmp_path / 'taken.sock'), f'taken by process {os.getpid()}')
    status, text = list_wiimotes('--virtual', taken.path)
    assert status == 0
    assert 'in use' in text


def test_a_silent_or_absent_remote_is_an_error(tmp_path):
    silent = Remote(str(tmp_path / 'silent.sock'), '00:1f:32:00:00:03', answers=False)
    status, text = list_wiimotes('--virtual', silent.path)
    assert status == 1
    assert 'take its batteries out' in text
    new_list = tmp_path / 'new.yaml'
    status, text = list_wiimotes('--write', str(new_list), '--virtual',
                                 str(tmp_path / 'nowhere.sock'))
    assert status == 1
    assert 'no virtual Wii Remote listens' in text
    assert f'Nothing was written to {new_list}.' in text and not new_list.exists()


def test_identify_flashes_each_remote_by_its_number(remotes):
    _, text = list_wiimotes('--identify', '--virtual', remotes[0].path, remotes[1].path)
    assert 'Remote 2 flashes 2 times.' in text
    # One host asks for the status, the next flashes it; at the end the LEDs are as before.
    assert remotes[0].leds_after(2) == [0, 15, 0, 2]
    assert remotes[1].leds_after(2) == [0, 15, 0, 15, 0, 2]


def test_write_adds_new_remotes_and_keeps_old_names(remotes, tmp_path):
    path = tmp_path / 'cameras.yaml'
    path.write_text(EXAMPLE % remotes[1].path)
    sockets = [remote.path for remote in remotes]
    status, text = list_wiimotes('--write', str(path), '--virtual', *sockets)
    assert status == 0
    assert 'Remote 1 (00:1f:32:00:00:01) is camera wiimote_1.' in text
    written = EXAMPLE % sockets[1] + '  wiimote_1: "virtual:%s"\n' % sockets[0]
    assert path.read_text() == written
    assert (tmp_path / 'cameras.yaml.bak').read_text() == EXAMPLE % sockets[1]

    _, text = list_wiimotes('--write', str(path), '--virtual', *sockets)
    assert 'needed no change' in text
    assert path.read_text() == written
    _, text = list_wiimotes('--cameras', str(path), '--virtual', sockets[0])
    assert 'sock  wiimote_1' in text
    assert 'camera door is not connected' in text


def test_cameras_that_no_driver_would_take_are_complained_of(remotes, tmp_path):
    path = tmp_path / 'cameras.yaml'
    device = 'virtual:' + remotes[0].path
    path.write_text('cameras:\n  door: "%s"\n  window: "%s"\n  wall: "00-1f-32-00-00-01"\n'
                    % (device, device))
    status, text = list_wiimotes('--cameras', str(path), '--virtual', remotes[0].path)
    assert status == 0
    assert '! camera window has the device %s, and so has camera door' % device in text
    assert '! camera wall has the device 00-1f-32-00-00-01: give a Bluetooth address' in text
    assert 'camera window is not connected' not in text


def test_write_begins_a_new_list(remotes, tmp_path):
    path = tmp_path / 'cameras.yaml'
    list_wiimotes('--write', str(path), '--virtual', remotes[0].path)
    assert 'cameras:\n  wiimote_1: "virtual:%s"\n' % remotes[0].path in path.read_text()


def test_a_relative_socket_is_found_from_other_folders(remotes, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    list_wiimotes('--write', 'cameras.yaml', '--virtual', os.path.basename(remotes[0].path))
    assert f'  wiimote_1: "virtual:{remotes[0].path}"\n' in (tmp_path / 'cameras.yaml').read_text()


def test_nothing_is_said_to_be_written_that_is_not(remotes, tmp_path):
    path = tmp_path / 'nowhere' / 'cameras.yaml'
    status, text = list_wiimotes('--write', str(path), '--virtual', remotes[0].path)
    assert status == 1
    assert 'cannot be written' in text
    assert 'is camera wiimote_1' not in text


def test_a_pipe_is_no_list(remotes, tmp_path):
    path = str(tmp_path / 'pipe')
    os.mkfifo(path)
    for arguments in (['--write', path, '--virtual', remotes[0].path],
                      ['--replace', 'door', '00:1f:32:00:00:01', '--cameras', path]):
        status, text = list_wiimotes(*arguments)
        assert status == 1
        assert path + ' is a pipe, device or socket' in text


def test_a_list_that_cannot_be_looked_at_is_refused_with_a_reason(remotes, tmp_path):
    path = tmp_path / 'cameras.yaml'
    path.symlink_to(path)
    status, text = list_wiimotes('--write', str(path), '--virtual', remotes[0].path)
    assert status == 1
    assert f'{path} cannot be read (Too many levels of symbolic links): correct the path' in text


def test_a_remote_that_is_not_there_is_not_written(tmp_path):
    path = tmp_path / 'cameras.yaml'
    _, text = list_wiimotes('--write', str(path), '--virtual', str(tmp_path / 'nowhere.sock'))
    assert 'Remote 1 is not written' in text
    assert not path.exists()


def test_replace_finds_the_calibration_where_ros_keeps_it(tmp_path):
    path = tmp_path / 'cameras.yaml'
    path.write_text('cameras:\n  door: "00:1f:32:00:00:01"\n')
    calibration = tmp_path / 'ros' / 'camera_info' / 'door.yaml'
    calibration.parent.mkdir(parents=True)
    calibration.write_text('old')
    status, text = list_wiimotes('--replace', 'door', '00:1F:32:00:00:09', '--cameras', str(path),
                                 ROS_HOME=str(tmp_path / 'ros'))
    assert status == 0 and 'solve this camera again (key r of calibrate)' in text
    assert 'the triangulation ignores this camera' in text
    assert path.read_text() == 'cameras:\n  door: "00:1f:32:00:00:09"\n'
    assert not calibration.exists()
    status, text = list_wiimotes('--replace', 'window', '00:1f:32:00:00:08', '--cameras', str(path))
    assert status == 1 and "no camera 'window'" in text


@pytest.mark.parametrize('arguments', [
    ['--identfy'], ['--write'], ['--virtual'], ['--replace', 'a'],
    ['--replace', 'a', '00:1f:32:00:00:01'], ['--device', 'hidraw0']])
def test_invalid_arguments_are_refused(arguments):
    status, text = list_wiimotes(*arguments)
    assert status == 2
    assert text.startswith('list_wiimotes: ')


@pytest.mark.parametrize('arguments, option', [
    ('--cameras a.yaml --write b.yaml', '--cameras'),
    ('--camera-info a', '--camera-info'),
    ('--device 00:1f:32:00:00:01 --virtual a.sock', '--device'),
    ('--json --identify', '--json'),
    ('--replace a 00:1f:32:00:00:01 --cameras a.yaml --identify', '--replace'),
    ('--replace a 00:1f:32:00:00:01 --cameras a.yaml --write b.yaml', '--replace')])
def test_an_option_without_effect_is_refused(arguments, option):
    status, text = list_wiimotes(*arguments.split())
    assert status == 2
    assert text.startswith('list_wiimotes: ' + option)


@pytest.mark.parametrize('device', ['foo', 'virtual:a.sock', 'replay:a.wiirec'])
def test_a_device_is_an_address_or_a_path(device):
    status, text = list_wiimotes('--device', device)
    assert status == 2
    assert "--device is '%s', but must be a Bluetooth address" % device in text
    assert 'must be empty' not in text
