"""The steps from a Wii Remote in the hand to one that this computer knows."""

import re
import subprocess
import time

# [s] How long bluetoothctl may take for something that needs no remote.
COMMAND_TIMEOUT = 10.0
# [s] Until a pairing or a connection has succeeded or failed.
REMOTE_TIMEOUT = 30.0
# [s] In which a connected remote must have become usable, or gone away.
SETTLE_TIMEOUT = 10.0
SETTLE_INTERVAL = 0.5  # [s]

NAMES = ('Nintendo RVL-CNT-01', 'Nintendo RVL-CNT-01-TR')
PROMPT = r'\[[^\]]*\][#>]$'
DEVICE = re.compile(r'(?:\[(NEW|CHG|DEL)\] )?Device ((?:[0-9A-F]{2}:){5}[0-9A-F]{2}) (.*)')

SYNC = ('press the red SYNC button in the battery compartment of the remote (not 1 and 2: a '
        'pairing made that way does not last, and a -TR switches off)')
BONDED_ONLY = ('BlueZ turns away remotes without a bond: take the batteries out and put them back, '
               'run pair again and use SYNC; if that does not help, set ClassicBondedOnly=false '
               'under [General] in /etc/bluetooth/input.conf and run  sudo systemctl restart '
               'bluetooth')
NO_ACCESS = ('you may not use Bluetooth here: run pair as the user at the seat of this computer, or '
             'with sudo')
NO_SERVICE = 'the Bluetooth service does not run: run  sudo systemctl enable --now bluetooth'


class PairingError(Exception):
    """Pairing is not possible; the text says why and what to do."""


class Pairing(object):
    """Leads one remote through pairing. bluetoothctl: a Bluetoothctl; say: tells people."""

    def __init__(self, bluetoothctl, say):
        self._ctl = bluetoothctl
        self._say = say
        self._names = {}  # address -> name

    def prepare(self):
        """Makes sure that there is a service and an adapter, and that it is on."""
        if self._wait({'ready': PROMPT}, COMMAND_TIMEOUT)[0] is None:
            if _service_runs():
                raise PairingError(NO_ACCESS)
            raise PairingError(NO_SERVICE)
        self._ctl.send('power on')
        what, line = self._wait({
            'on': r'Changing power on succeeded',
            'none': r'No default controller available',
            'failed': r'Failed to set power',
        }, COMMAND_TIMEOUT)
        if what == 'none':
            raise PairingError('there is no Bluetooth adapter: plug one in, and if one is there '
                               'see whether  lsusb  shows it')
        if what == 'failed':
            self._refuse_access(line)
            raise PairingError('the Bluetooth adapter cannot be switched on: run  rfkill unblock '
                               'bluetooth  and use the wireless switch of this computer if it has '
                               'one')
        if what is None:
            raise PairingError('the Bluetooth adapter does not answer: unplug it and plug it in '
                               'again')
        self._say('The Bluetooth adapter is on.')
        self._ctl.send('agent on')
        self._wait({'agent': r'gent (is already )?registered|Failed to register'}, COMMAND_TIMEOUT)
        self._ctl.send('pairable on')
        self._wait({'done': r'Changing pairable on succeeded|Failed to set pairable'},
                   COMMAND_TIMEOUT)

    def find(self, timeout, wanted=None):
        """Waits up to timeout [s] for a remote in search of a host (the one with the address
        wanted). Returns its address, and whether it is connected already."""
        self._ctl.send('devices')  # names of those that are known are not told again
        self._ctl.send('scan on')
        self._say('Now %s.' % SYNC)
        end = time.monotonic() + timeout
        started = False
        while True:
            line = self._next(end)
            if line is None:
                raise PairingError(
                    'no Wii Remote was found in %.0f s: put fresh batteries in, hold it within a '
                    'metre of the adapter, run pair again and %s' % (timeout, SYNC))
            if 'Failed to start discovery' in line and 'InProgress' not in line:
                self._refuse_access(line)
                raise PairingError('the adapter cannot search (%s): unplug it and plug it in again'
                                   % _error(line))
            if 'Discovery started' in line or 'Failed to start discovery' in line:
                started = True
            match = DEVICE.match(line)
            if not match:
                continue
            event, address, text = match.groups()
            self._note_name(event, address, text)
            if self._names.get(address) not in NAMES or wanted not in (None, address):
                continue
            if event == 'CHG' and text == 'Connected: yes':
                self._say('%s (%s) is known here and has just connected.'
                          % (self._names[address], address))
                return address, True
            is_here = event == 'NEW' or event == 'CHG' and re.match(r'(RSSI|Name|Alias): ', text)
            if started and is_here:
                self._say('Found %s (%s).' % (self._names[address], address))
                return address, False

    def pair(self, address):
        """Returns whether it is paired; if not, an old pairing was in the way and is removed."""
        self._ctl.send('pair ' + address)
        end = time.monotonic() + REMOTE_TIMEOUT
        while True:
            what, line = self._wait({
                'paired': r'Pairing successful',
                'failed': r'Failed to pair',
                'gone': r'Device %s not available' % address,
                'pin': r'\[agent\].*(PIN code|passkey)',
                'question': r'\[agent\].*\(yes/no\)',
            }, end - time.monotonic())
            if what == 'question':
                self._ctl.send('yes')
                continue
            if what == 'paired':
                self._say('Paired.')
                return True
            if what == 'failed' and 'AlreadyExists' in line:
                self._ctl.send('remove ' + address)
                self._wait({'removed': r'Device has been removed|Failed to remove'},
                           COMMAND_TIMEOUT)
                self._say('This computer remembered an old pairing, which is now removed.')
                return False
            if what == 'pin':
                raise PairingError('BlueZ asks for a PIN, which it ought to know itself: install '
                                   'its plugins, Debian package bluez, and  sudo systemctl restart '
                                   'bluetooth')
            if what == 'gone':
                raise PairingError('the remote has gone to sleep: run pair again and press SYNC '
                                   'when asked to')
            why = _error(line) if what == 'failed' else 'no answer'
            if what == 'failed':
                self._refuse_access(line)
            raise PairingError('the remote refused to pair (%s): run pair again and %s'
                               % (why, SYNC))

    def connect(self, address):
        """Lets the remote come back by itself from now on, and connects it."""
        self._ctl.send('scan off')
        self._ctl.send('trust ' + address)
        if self._wait({'trusted': r'trust succeeded'}, COMMAND_TIMEOUT)[0] is None:
            raise PairingError('BlueZ does not trust the remote: run  bluetoothctl trust %s  and '
                               'press a button of the remote' % address)
        self._say('Trusted: from now on any button brings it back.')
        self._ctl.send('connect ' + address)
        what, line = self._wait({
            'connected': r'Connection successful',
            'failed': r'Failed to connect|Device %s not available' % address,
        }, REMOTE_TIMEOUT)
        if what != 'connected':
            why = _error(line) if what == 'failed' else 'no answer'
            raise PairingError('the remote does not connect (%s): press a button of the remote and '
                               'see  list_wiimotes; if its LEDs just blink, %s'
                               % (why, BONDED_ONLY))
        self._say('Connected.')

    def settle(self, address, is_usable):
        """Waits until is_usable() (a text when not yet, None when it is). A remote that goes away
        again is an error."""
        end = time.monotonic() + SETTLE_TIMEOUT
        while True:
            problem = is_usable()
            gone = self._wait({'gone': r'\[CHG\] Device %s Connected: no' % address},
                              SETTLE_INTERVAL if problem else 0.0)[0]
            if gone:
                raise PairingError('the remote connected and went away at once: %s' % BONDED_ONLY)
            if problem is None:
                return
            if time.monotonic() > end:
                raise PairingError('the remote is connected, but cannot be used yet:\n%s' % problem)

    def _note_name(self, event, address, text):
        if event == 'DEL':
            self._names.pop(address, None)
        elif event == 'CHG':
            name = re.match(r'(?:Name|Alias): (.*)', text)
            if name:
                self._names[address] = name.group(1)
        else:  # new, or in the answer to "devices"
            self._names[address] = text

    def _refuse_access(self, line):
        if 'AccessDenied' in line or 'NotAuthorized' in line or 'NotPermitted' in line:
            raise PairingError(NO_ACCESS)

    def _next(self, end):
        """The next line before the time end, or None."""
        line = self._ctl.line(max(0.0, end - time.monotonic()))
        if line is None and self._ctl.ended:
            if not _service_runs():
                raise PairingError(NO_SERVICE)
            raise PairingError('bluetoothctl has ended: run  sudo systemctl restart bluetooth  and '
                               'run pair again')
        return line

    def _wait(self, patterns, timeout):
        """The key of the first pattern that a line matches, and the line; (None, '') when none
        came within timeout [s]."""
        end = time.monotonic() + timeout
        while True:
            line = self._next(end)
            if line is None:
                return None, ''
            for key, pattern in patterns.items():
                if re.search(pattern, line):
                    return key, line
            match = DEVICE.match(line)
            if match:
                self._note_name(*match.groups())


def _service_runs():
    try:
        return subprocess.call(['systemctl', 'is-active', '--quiet', 'bluetooth'],
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) == 0
    except OSError:
        return False


def _error(line):
    """What bluetoothctl gives as the reason."""
    return line.split('org.bluez.Error.')[-1].split(': ')[-1].strip()
