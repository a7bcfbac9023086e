"""Pairing, against a FAKE bluetoothctl (see fake_bluetoothctl) and a fake list_wiimotes."""

import json
import os
import sys

import pytest

from conftest import load
from pairing import steps

HERE = os.path.dirname(os.path.realpath(__file__))
pair = load('pair')

# The remote, and the computer's adapter.
A = '00:1F:32:12:34:56'
C = '00:1A:7D:DA:71:13'

# Output of bluetoothctl at each step of a successful pairing.
START = 'Waiting to connect to bluetoothd...\nAgent registered\n'
LIST = '> list\nController %s this computer [default]\n' % C
POWER = LIST + '''> power on
[CHG] Controller %s Powered: yes
Changing power on succeeded
> agent on
Agent is already registered
> pairable on
[CHG] Controller %s Pairable: yes
Changing pairable on succeeded
''' % (C, C)
SCAN = '''> devices
> scan on
Discovery started
[CHG] Controller %s Discovering: yes
''' % C
STRANGERS = '''[NEW] Device 5C:F3:70:00:00:01 Headset
[CHG] Device 5C:F3:70:00:00:01 RSSI: -71
[NEW] Device 9C:E6:35:00:00:01 Nintendo RVL-CNT-01-UC
[NEW] Device 00:24:44:00:00:01 Nintendo RVL-WBC-01
'''
NEW = '[NEW] Device %s Nintendo RVL-CNT-01\n' % A
PAIR = '''> pair %s
Attempting to pair with %s
[CHG] Device %s Connected: yes
''' % (A, A, A)
PAIRED = '''[CHG] Device {0} Bonded: yes
[CHG] Device {0} Modalias: usb:v057Ep0306d8600
[CHG] Device {0} UUIDs: 00001124-0000-1000-8000-00805f9b34fb
[CHG] Device {0} ServicesResolved: yes
[CHG] Device {0} Paired: yes
Pairing successful
'''.format(A)
TRUST = '''> scan off
Discovery stopped
> trust {0}
[CHG] Device {0} Trusted: yes
Changing {0} trust succeeded
'''.format(A)
CONNECT = '> connect %s\nAttempting to connect to %s\n' % (A, A)
CONNECTED = 'Connection successful\n'
FOUND = START + POWER + SCAN + NEW
TO_THE_END = PAIR + PAIRED + TRUST + CONNECT + CONNECTED
SILENCE = '~\n'


class Impatient(pair.Bluetoothctl):
    """Takes SILENCE for the end of the time-out. Before it, nothing is too slow."""

    is_silent = False

    def line(self, timeout):
        line = None if self.is_silent else super().line(60.0)
        self.is_silent = self.is_silent or line == 'fake_bluetoothctl is silent'
        return None if self.is_silent else line


class Computer:
    """A computer on which the programs that pair calls are fakes."""

    def __init__(self, folder, monkeypatch, capsys):
        self.folder = folder
        self.monkeypatch = monkeypatch
        self.capsys = capsys
        os.symlink(os.path.join(HERE, 'fake_bluetoothctl'), str(folder / 'bluetoothctl'))
        self.lists({'device': '/dev/hidraw3', 'usable': True, 'state': 'free', 'problems': []})
        self.program('systemctl', 'exit 3')
        monkeypatch.setenv('PATH', '%s:%s' % (folder, os.environ['PATH']))
        monkeypatch.setattr(steps, 'SETTLE_INTERVAL', 0.05)

    def program(self, name, script):
        path = self.folder / name
        path.write_text('#!/bin/sh\n%s\n' % script)
        path.chmod(0o755)

    def lists(self, *remotes):
        """list_wiimotes --json prints this."""
        (self.folder / 'listed').write_text(json.dumps({'remotes': remotes}))
        self.program('rosrun', 'echo "$@" >> {0}/calls; cat {0}/listed'.format(self.folder))

    def calls(self):
        return (self.folder / 'calls').read_text().splitlines()

    def pair(self, dialogue, *arguments):
        """Exit status, standard output and error output of pair."""
        (self.folder / 'dialogue').write_text(dialogue)
        self.monkeypatch.setenv('FAKE_BLUETOOTHCTL', str(self.folder / 'dialogue'))
        self.monkeypatch.setattr(sys, 'argv', ['pair'] + list(arguments))
        status = pair.main()
        said = self.capsys.readouterr()
        assert 'fake_bluetoothctl:' not in said.out
        return status, said.out, said.err


@pytest.fixture
def computer(tmp_path, monkeypatch, capsys):
    return Computer(tmp_path, monkeypatch, capsys)


@pytest.mark.parametrize('dialogue', [
    START + POWER + SCAN + STRANGERS + NEW + TO_THE_END,
    (FOUND + TO_THE_END).replace('RVL-CNT-01\n', 'RVL-CNT-01-TR\n'),
    # Its name comes after its address.
    START + POWER + SCAN + '[NEW] Device %s 00-1F-32-12-34-56\n' % A
    + '[CHG] Device %s Name: Nintendo RVL-CNT-01\n' % A + TO_THE_END,
    # It was known before: old versions report it at the start, new ones in a list.
    START + NEW + POWER + SCAN + '[CHG] Device %s RSSI: 0xffffffc9 (-55)\n' % A + TO_THE_END,
    START + POWER + SCAN.replace('> scan', 'Device %s Nintendo RVL-CNT-01\n> scan' % A)
    + '[CHG] Device %s RSSI: -55\n' % A + TO_THE_END,
    FOUND + PAIR + '? [agent] Authorize service 00001124-0000-1000-8000-00805f9b34fb (yes/no):\n'
    + '> yes\n' + TO_THE_END[len(PAIR):],
], ids=['new', 'plus', 'late_name', 'known_at_start', 'known_in_list', 'question'])
def test_a_remote_is_paired_and_tried(computer, dialogue):
    status, out, err = computer.pair(dialogue, '--verbose')
    assert (status, err) == (0, ''), out
    assert 'SYNC' in out and 'Paired.' in out and 'Connected.' in out
    assert '/dev/hidraw3: free' in out
    assert f'--replace CAMERA {A.lower()} ' in out
    assert computer.calls() == [f'wiimote_tracker_driver list_wiimotes --device {A} --json']


def test_bluetooth_is_checked_without_pairing(computer):
    status, out, err = computer.pair(
        START + POWER[:POWER.index('> agent')] + '> devices\nDevice %s Nintendo RVL-CNT-01\n' % A
        + STRANGERS + '> agent on\nAgent is already registered\n' + SILENCE, '--check')
    assert (status, err) == (0, '')
    assert out.endswith('Paired remotes: %s.\n' % A)
    assert not (computer.folder / 'calls').exists()


def test_an_old_pairing_is_replaced(computer):
    again = SCAN.replace('Discovery started',
                         'Failed to start discovery: org.bluez.Error.InProgress')
    status, out, _ = computer.pair(
        FOUND + '> pair %s\nAttempting to pair with %s\n' % (A, A)
        + 'Failed to pair: org.bluez.Error.AlreadyExists\n'
        + '> remove %s\n[DEL] Device %s Nintendo RVL-CNT-01\nDevice has been removed\n' % (A, A)
        + again + NEW + TO_THE_END)
    assert status == 0
    assert 'old pairing' in out
    assert out.count('Now press the red SYNC button') == 2


def test_a_remote_that_reconnects_is_not_paired_again(computer):
    status, out, _ = computer.pair(
        START + POWER + SCAN.replace('> scan', 'Device %s Nintendo RVL-CNT-01\n> scan' % A)
        + '[CHG] Device %s Connected: yes\n' % A + SILENCE)
    assert status == 0
    assert 'is known here' in out


def test_another_remote_than_the_wanted_one_is_left_alone(computer):
    other = NEW.replace(A, '00:1F:32:00:00:99')
    status, out, _ = computer.pair(START + POWER + SCAN + other + NEW + TO_THE_END,
                                   '--address', A.lower())
    assert status == 0
    assert '00:1F:32:00:00:99' not in out


@pytest.mark.parametrize('dialogue, to_do', [
    ('Waiting to connect to bluetoothd...\n' + SILENCE, 'systemctl enable --now bluetooth'),
    ('Waiting to connect to bluetoothd...\n!\n', 'systemctl enable --now bluetooth'),
    (START + LIST + '> power on\nNo default controller available\n' + SILENCE, 'plug one in'),
    (START + LIST + '> power on\nFailed to set power: org.bluez.Error.Blocked\n' + SILENCE,
     'rfkill unblock'),
    (START + LIST + '> power on\nFailed to set power on: org.bluez.Error.Busy\n' + SILENCE,
     'rfkill unblock'),
    (START + LIST + '> power on\nFailed to set power: org.freedesktop.DBus.Error.AccessDenied\n'
     + SILENCE, 'with sudo'),
    (START + LIST + '> power on\n' + SILENCE, 'unplug it'),
    (START + POWER + '> devices\n> scan on\nFailed to start discovery: org.bluez.Error.NotReady\n'
     + SILENCE, 'cannot search (NotReady)'),
    (START + POWER + SCAN + STRANGERS + SILENCE, 'no Wii Remote was found'),
    (FOUND + PAIR + 'Failed to pair: org.bluez.Error.AuthenticationFailed\n' + SILENCE,
     'refused to pair (AuthenticationFailed): run pair again and press the red SYNC'),
    (FOUND + PAIR + SILENCE, 'refused to pair (no answer)'),
    (FOUND + '> pair %s\nDevice %s not available\n' % (A, A) + SILENCE, 'gone to sleep'),
    (FOUND + PAIR + 'Request PIN code\n? [agent] Enter PIN code:\n',
     'the remote refused the PIN'),
    (FOUND + PAIR + PAIRED + '> scan off\n> trust %s\n' % A + SILENCE, 'bluetoothctl trust'),
    (FOUND + PAIR + PAIRED + TRUST + CONNECT
     + 'Failed to connect: org.bluez.Error.Failed br-connection-create-socket\n' + SILENCE,
     'does not connect (Failed br-connection-create-socket)'),
    (FOUND + PAIR + PAIRED + TRUST + CONNECT + SILENCE, 'does not connect (no answer)'),
], ids=['no_service', 'ends', 'no_adapter', 'blocked', 'busy', 'no_access', 'silent_adapter',
        'no_search', 'nothing_found', 'refused', 'no_answer', 'asleep', 'pin', 'no_trust',
        'not_connected', 'silent_connection'])
def test_each_failure_gives_advice(computer, monkeypatch, dialogue, to_do):
    monkeypatch.setattr(pair, 'Bluetoothctl', Impatient)
    status, out, err = computer.pair(dialogue)
    assert status == 1
    assert err.startswith('pair: ') and to_do in err, out
    assert not (computer.folder / 'calls').exists()


def test_an_open_question_is_not_answered_with_quit(computer):
    heard = computer.folder / 'heard'
    computer.monkeypatch.setenv('FAKE_BLUETOOTHCTL_ANSWER', str(heard))
    status, _, err = computer.pair(
        FOUND + PAIR + 'Request PIN code\n? [agent] Enter PIN code:\n')
    assert status == 1 and '1 and 2' in err
    assert not heard.exists()


def test_the_adapter_is_named_and_chosen(computer):
    other = '00:1A:7D:00:00:02'
    two = LIST + 'Controller %s a stick\n' % other
    status, out, _ = computer.pair(START + two + POWER[len(LIST):] + SCAN + NEW + TO_THE_END)
    assert status == 0
    assert 'adapter %s. --adapter chooses another: %s.' % (C, other) in out
    select = two + '> select %s\nController %s a stick\n' % (other, other)
    status, out, _ = computer.pair(START + select + POWER[len(LIST):] + SCAN + NEW + TO_THE_END,
                                   '--adapter', other.lower())
    assert status == 0
    assert 'Uses the Bluetooth adapter %s.' % other in out
    status, _, err = computer.pair(
        START + two + '> select %s\nController %s not available\n' % (A, A) + SILENCE,
        '--adapter', A)
    assert status == 1
    assert 'there is no Bluetooth adapter %s: choose one of %s, %s' % (A, C, other) in err


def test_an_adapter_is_missing_where_there_is_none(computer):
    status, _, err = computer.pair(
        START + '> list\n> select %s\nController %s not available\n' % (A, A) + SILENCE,
        '--adapter', A)
    assert status == 1
    assert 'plug one in' in err


def test_a_bluetoothctl_that_cannot_be_run_is_not_missing(computer):
    os.remove(str(computer.folder / 'bluetoothctl'))
    (computer.folder / 'bluetoothctl').write_text('no program')
    (computer.folder / 'bluetoothctl').chmod(0o755)
    _, _, err = computer.pair('')
    assert 'cannot be run' in err and 'apt install' not in err


def test_a_running_service_without_answer_is_a_permission_problem(computer, monkeypatch):
    monkeypatch.setattr(steps, 'COMMAND_TIMEOUT', 1.0)
    computer.program('systemctl', 'exit 0')
    _, _, err = computer.pair('Waiting to connect to bluetoothd...\n' + SILENCE)
    assert 'with sudo' in err


def test_a_service_that_runs_while_bluetoothctl_ends_is_restarted(computer):
    computer.program('systemctl', 'exit 0')
    _, _, err = computer.pair('Waiting to connect to bluetoothd...\n!\n')
    assert 'systemctl restart bluetooth' in err


def test_a_remote_that_goes_away_again_has_no_bond(computer):
    # Not there yet at the first check.
    computer.lists()
    _, _, err = computer.pair(FOUND + TO_THE_END + '[CHG] Device %s Connected: no\n' % A + SILENCE)
    assert 'went away at once' in err and 'ClassicBondedOnly=false' in err


def test_a_missing_node_is_a_kernel_problem(computer, monkeypatch):
    monkeypatch.setattr(steps, 'SETTLE_TIMEOUT', 0.5)
    computer.lists()
    _, _, err = computer.pair(FOUND + TO_THE_END + SILENCE)
    assert 'modprobe hid-wiimote' in err


def test_problems_found_by_list_wiimotes_are_passed_on(computer, monkeypatch):
    monkeypatch.setattr(steps, 'SETTLE_TIMEOUT', 0.5)
    computer.lists({'device': '/dev/hidraw3', 'usable': False, 'state': '',
                    'problems': ['permission denied on /dev/hidraw3: install the rule']})
    _, _, err = computer.pair(FOUND + TO_THE_END + SILENCE)
    assert 'permission denied on /dev/hidraw3: install the rule' in err


def test_waits_for_a_late_node(computer):
    computer.program('rosrun', 'test -e {0}/second && cat {0}/listed; touch {0}/second'.format(
        computer.folder))
    status, _, err = computer.pair(FOUND + TO_THE_END + SILENCE)
    assert (status, err) == (0, '')


def test_without_bluetoothctl(computer, monkeypatch):
    os.remove(str(computer.folder / 'bluetoothctl'))
    monkeypatch.setenv('PATH', str(computer.folder))
    _, _, err = computer.pair('')
    assert 'apt install bluez' in err


@pytest.mark.parametrize('arguments', [
    ['--timeout', '0'], ['--timeout', 'nan'], ['--address', 'hidraw0']])
def test_invalid_arguments_are_refused_before_anything_is_done(computer, arguments):
    with pytest.raises(SystemExit) as stop:
        computer.pair('', *arguments)
    assert stop.value.code == 2
