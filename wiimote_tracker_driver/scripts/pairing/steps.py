"""The steps of pairing a Wii Remote."""

import re
import subprocess
import time
from typing import Callable, Dict, List, Optional, Tuple

from .bluetoothctl import Bluetoothctl

COMMAND_TIMEOUT = 10.0  # for commands without a remote [s]
REMOTE_TIMEOUT = 30.0   # for pairing or connecting [s]
SETTLE_TIMEOUT = 10.0   # for a connected remote to become usable, or to go away [s]
SETTLE_INTERVAL = 0.5   # [s]

NAMES = ('Nintendo RVL-CNT-01', 'Nintendo RVL-CNT-01-TR')
PROMPT = r'\[[^\]]*\][#>]$'
ADAPTER = re.compile(r'(?:\[NEW\] )?Controller ((?:[0-9A-F]{2}:){5}[0-9A-F]{2}) '
                     r'(.*?)( \[default\])?$')
DEVICE = re.compile(r'(?:\[(NEW|CHG|DEL)\] )?Device ((?:[0-9A-F]{2}:){5}[0-9A-F]{2}) (.*)')

AGENT = r'[Aa]gent (is already )?registered|Failed to register'

SYNC = ('press the red SYNC button in the battery compartment of the remote (not 1 and 2: such a '
        'pairing does not last, and a -TR switches off)')
BONDED_ONLY = ('BlueZ refuses remotes without a bond: take the batteries out and put them back, '
               'run pair again and use SYNC; if that does not help, set ClassicBondedOnly=false '
               'under [General] in /etc/bluetooth/input.conf and run  sudo systemctl restart '
               'bluetooth')
NO_ACCESS = ('you have no permission to use Bluetooth: run pair as the user at the seat of this '
             'computer, or with sudo')
NO_SERVICE = 'the Bluetooth service does not run: run  sudo systemctl enable --now bluetooth'


class PairingError(Exception):
    """Pairing is not possible; the text says why and what to do."""


class Pairing:
    """Pairs one remote. say: prints a line for the user."""

    def __init__(self, bluetoothctl: Bluetoothctl, say: Callable[[str], None]):
        self._ctl = bluetoothctl
        self._say = say
        self._names: Dict[str, str] = {}  # by address
        self._adapters: Dict[str, str] = {}  # names by address
        self._default = ''  # BlueZ's adapter

    def prepare(self, adapter: Optional[str] = None) -> None:
        """Checks that the service runs and that there is an adapter, and switches it on. adapter:
        address of the one to use, or None for BlueZ's default."""
        if self._wait({'ready': PROMPT}, COMMAND_TIMEOUT)[0] is None:
            raise PairingError(NO_ACCESS if _service_runs() else NO_SERVICE)
        self._ctl.send('list')
        if adapter:
            self._ctl.send('select ' + adapter)
        self._ctl.send('power on')
        what, line = self._wait({
            'on': r'Changing power on succeeded',
            'none': r'No default controller available',
            'unknown': rf'Controller {adapter} not available',
            'failed': r'Failed to set power',
        }, COMMAND_TIMEOUT)
        # "select" answers first, but without any adapter it has none to choose from.
        if what == 'none' or what == 'unknown' and not self._adapters:
            raise PairingError('there is no Bluetooth adapter: plug one in; if there is one, check '
                               'that  lsusb  shows it')
        if what == 'unknown':
            raise PairingError(f'there is no Bluetooth adapter {adapter}: choose one of '
                               + ', '.join(self._adapters))
        if what == 'failed':
            self._refuse_access(line)
            raise PairingError('the Bluetooth adapter cannot be switched on: run  rfkill unblock '
                               'bluetooth  and use the wireless switch of this computer if it has '
                               'one')
        if what is None:
            raise PairingError('the Bluetooth adapter does not answer: unplug it and plug it in '
                               'again')
        used = adapter or self._default
        others = [address for address in self._adapters if address != used]
        self._say(f'Uses the Bluetooth adapter {used}.' + (
            f' --adapter chooses another: {", ".join(others)}.' if others else ''))

    def known_remotes(self) -> List[str]:
        """Addresses of the remotes that this computer knows, connected or not."""
        self._ctl.send('devices')
        self._ctl.send('agent on')  # its answer ends the list
        self._wait({'agent': AGENT}, COMMAND_TIMEOUT)
        return [address for address, name in self._names.items() if name in NAMES]

    def accept_pairing(self) -> None:
        """Lets this computer pair."""
        self._ctl.send('agent on')
        self._wait({'agent': AGENT}, COMMAND_TIMEOUT)
        self._ctl.send('pairable on')
        self._wait({'done': r'Changing pairable on succeeded|Failed to set pairable'},
                   COMMAND_TIMEOUT)

    def find(self, timeout: float, wanted: Optional[str] = None) -> Tuple[str, bool]:
        """Waits up to timeout [s] for a remote in search of a host; wanted: its address, or None.
        Returns its address, and whether it is already connected."""
        self._ctl.send('devices')  # bluetoothctl does not repeat the names of known devices
        self._ctl.send('scan on')
        self._say(f'Now {SYNC}.')
        end = time.monotonic() + timeout
        started = False
        while True:
            line = self._next(end)
            if line is None:
                raise PairingError(
                    f'no Wii Remote was found in {timeout:.0f} s: put fresh batteries in, hold it '
                    f'within a metre of the adapter, run pair again and {SYNC}')
            if 'Failed to start discovery' in line and 'InProgress' not in line:
                self._refuse_access(line)
                raise PairingError(f'the adapter cannot search ({_error(line)}): unplug it and '
                                   'plug it in again')
            if 'Discovery started' in line or 'Failed to start discovery' in line:
                started = True
            match = DEVICE.match(line)
            if not match:
                continue
            event, address, text = match.groups()
            self._note_name(event, address, text)
            name = self._names.get(address)
            if name not in NAMES or wanted not in (None, address):
                continue
            if event == 'CHG' and text == 'Connected: yes':
                self._say(f'{name} ({address}) is known here and has just connected.')
                return address, True
            is_here = event == 'NEW' or event == 'CHG' and re.match(r'(RSSI|Name|Alias): ', text)
            if started and is_here:
                self._say(f'Found {name} ({address}).')
                return address, False

    def pair(self, address: str) -> bool:
        """Returns whether the remote is paired. If not, an old pairing was removed: find() the
        remote again."""
        self._ctl.send('pair ' + address)
        end = time.monotonic() + REMOTE_TIMEOUT
        patterns = {
            'paired': r'Pairing successful',
            'failed': r'Failed to pair',
            'gone': rf'Device {address} not available',
            'pin': r'\[agent\].*(PIN code|passkey)',
            'question': r'\[agent\].*\(yes/no\)',
        }
        what, line = self._wait(patterns, REMOTE_TIMEOUT)
        while what == 'question':
            self._ctl.send('yes')
            what, line = self._wait(patterns, end - time.monotonic())
        if what == 'paired':
            self._say('Paired.')
            return True
        if what == 'failed' and 'AlreadyExists' in line:
            self._ctl.send('remove ' + address)
            self._wait({'removed': r'Device has been removed|Failed to remove'}, COMMAND_TIMEOUT)
            self._say('This computer had an old pairing, which is now removed.')
            return False
        if what == 'pin':
            raise PairingError('the remote refused the PIN, as it does when 1 and 2 were pressed: '
                               'take its batteries out and put them back, run pair again and '
                               f'{SYNC}. If it was SYNC, BlueZ lacks its wiimote plugin: install '
                               'the Debian package bluez and run  sudo systemctl restart bluetooth')
        if what == 'gone':
            raise PairingError('the remote has gone to sleep: run pair again and press SYNC '
                               'when asked to')
        if what == 'failed':
            self._refuse_access(line)
        why = _error(line) if what == 'failed' else 'no answer'
        raise PairingError(f'the remote refused to pair ({why}): run pair again and {SYNC}')

    def connect(self, address: str) -> None:
        """Allows the remote to reconnect by itself from now on, and connects it."""
        self._ctl.send('scan off')
        self._ctl.send('trust ' + address)
        if self._wait({'trusted': r'trust succeeded'}, COMMAND_TIMEOUT)[0] is None:
            raise PairingError(f'BlueZ does not trust the remote: run  bluetoothctl trust {address}'
                               '  and press a button of the remote')
        self._say('Trusted: from now on any button brings it back.')
        self._ctl.send('connect ' + address)
        what, line = self._wait({
            'connected': r'Connection successful',
            'failed': rf'Failed to connect|Device {address} not available',
        }, REMOTE_TIMEOUT)
        if what != 'connected':
            why = _error(line) if what == 'failed' else 'no answer'
            raise PairingError(f'the remote does not connect ({why}): press a button of the remote '
                               f'and see  list_wiimotes; if its LEDs only blink, {BONDED_ONLY}')
        self._say('Connected.')

    def wait_until_usable(self, address: str, problem_of: Callable[[], Optional[str]]) -> None:
        """Waits until problem_of() is None. Raises PairingError when the remote goes away."""
        end = time.monotonic() + SETTLE_TIMEOUT
        while True:
            problem = problem_of()
            gone = self._wait({'gone': rf'\[CHG\] Device {address} Connected: no'},
                              SETTLE_INTERVAL if problem else 0.0)[0]
            if gone:
                raise PairingError(f'the remote connected and went away at once: {BONDED_ONLY}')
            if problem is None:
                return
            if time.monotonic() > end:
                raise PairingError(f'the remote is connected, but cannot be used yet:\n{problem}')

    def _note_name(self, event: str, address: str, text: str) -> None:
        if event == 'DEL':
            self._names.pop(address, None)
        elif event == 'CHG':
            name = re.match(r'(?:Name|Alias): (.*)', text)
            if name:
                self._names[address] = name.group(1)
        else:  # new, or in the answer to "devices"
            self._names[address] = text

    @staticmethod
    def _refuse_access(line: str) -> None:
        if re.search('AccessDenied|NotAuthorized|NotPermitted', line):
            raise PairingError(NO_ACCESS)

    def _next(self, end: float) -> Optional[str]:
        """The next line before the time end, or None."""
        line = self._ctl.line(max(0.0, end - time.monotonic()))
        if line is None and self._ctl.ended:
            raise PairingError('bluetoothctl has ended: run  sudo systemctl restart bluetooth  and '
                               'run pair again' if _service_runs() else NO_SERVICE)
        return line

    def _wait(self, patterns: Dict[str, str], timeout: float) -> Tuple[Optional[str], str]:
        """Waits for a line that matches a pattern, and notes names and adapters in those before it.
        Returns the pattern's key and the line, or (None, '') after timeout [s]."""
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
            match = ADAPTER.match(line)
            if match:
                address, name, default = match.groups()
                self._adapters[address] = name
                if default:
                    self._default = address


def _service_runs() -> bool:
    try:
        return subprocess.call(['systemctl', 'is-active', '--quiet', 'bluetooth'],
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) == 0
    except OSError:
        return False


def _error(line: str) -> str:
    """The reason that bluetoothctl gives."""
    return line.split('org.bluez.Error.')[-1].split(': ')[-1].strip()
