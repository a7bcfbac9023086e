"""The program virtual_wiimote, run as users run it; its path is in the environment."""
import math
import os
import signal
import socket
import subprocess
import time

import pytest

PROGRAM = os.environ["VIRTUAL_WIIMOTE"]
TIMEOUT = 20.0  # [s]

HANDSHAKE = [
    "13 04",
    "1a 04",
    "16 04 b0 00 30 01 01",
    "16 04 b0 00 00 09 02 00 00 71 01 00 aa 00 64",
    "16 04 b0 00 1a 02 63 03",
    "16 04 b0 00 33 01 03",
    "16 04 b0 00 30 01 08",
    "12 04 33",
]


def call(*arguments, folder=None):
    return subprocess.run([PROGRAM] + list(arguments), cwd=folder, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, timeout=TIMEOUT, universal_newlines=True)


class Remote:
    """The program, and a host connected to it."""

    def __init__(self, path, *arguments):
        self.path = str(path)
        self.process = subprocess.Popen([PROGRAM, "--socket", self.path] + list(arguments),
                                        stdout=subprocess.PIPE, universal_newlines=True)
        # The line is printed once the socket exists.
        self.process.stdout.readline()
        self.host = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self.host.settimeout(TIMEOUT)
        self.host.connect(self.path)
        self.identity = self.host.recv(64).decode()

    def say(self, text):
        self.host.send(bytes.fromhex(text))

    def next(self, report_id):
        deadline = time.monotonic() + TIMEOUT
        while time.monotonic() < deadline:
            report = self.host.recv(64)
            if report[0] == report_id:
                return report
        raise AssertionError("no report %02x" % report_id)

    def end(self):
        self.process.send_signal(signal.SIGINT)
        return self.process.communicate(timeout=TIMEOUT)[0]


@pytest.fixture
def start(tmp_path):
    remotes = []

    def starter(*arguments):
        remotes.append(Remote(tmp_path / "remote.sock", *arguments))
        return remotes[-1]

    yield starter
    for remote in remotes:
        remote.host.close()
        remote.process.kill()
        remote.process.wait()
        remote.process.stdout.close()


def test_led_moves_in_a_circle(start):
    remote = start("--battery", "100", "--address", "00:1f:32:12:34:56")
    assert remote.identity == "00:1f:32:12:34:56"
    remote.say("15 00")
    assert remote.next(0x20) == bytes.fromhex("20 00 00 00 00 00 64")
    for report in HANDSHAKE:
        remote.say(report)
    angles = set()
    deadline = time.monotonic() + TIMEOUT
    while len(angles) < 8:
        assert time.monotonic() < deadline, angles
        report = remote.next(0x33)
        if report[6:9] in (b"\xff\xff\xff", b"\0\0\0"):
            continue  # from before the first image
        x = report[6] + (report[8] >> 4 & 3) * 256 - 512
        y = report[7] + (report[8] >> 6) * 256 - 384
        assert math.hypot(x, y) == pytest.approx(250, abs=1)
        angles.add(math.floor(4 * math.atan2(y, x) / math.pi))


def test_prints_visible_changes_and_cleans_up(start):
    remote = start()
    remote.say("11 51")
    assert remote.process.stdout.readline() == "LEDs: 1 - 3 -\n"
    assert remote.process.stdout.readline() == "motor: on\n"
    remote.end()
    assert remote.process.returncode == 0
    assert not os.path.exists(remote.path)


def test_address_is_in_lower_case(start):
    assert start("--address", "00:1F:32:12:34:AB").identity == "00:1f:32:12:34:ab"


def test_faults(start):
    remote = start("--fault", "duplicated=1")
    remote.say("15 00")
    assert remote.next(0x20) == remote.next(0x20)


def test_plus_has_a_motion_plus(start):
    remote = start("--plus")
    remote.say("17 04 a6 00 fa 00 06")
    assert remote.next(0x21)[3:12] == bytes.fromhex("50 00 fa 00 00 a6 20 00 05")


@pytest.mark.parametrize("arguments, says", [
    ([], "--socket"),
    (["--socket", "a.sock", "--uhid"], "--uhid"),
    (["--socket", "a.sock", "--battery", "256"], "--battery"),
    (["--socket", "a.sock", "--address", "00-1f-32-00-00-01"], "'00-1f-32-00-00-01' is not a"),
    (["--socket", "a.sock", "--fault", "lost_answers=2"], "lost_answers"),
    (["--socket", "a.sock", "more"], "more"),
])
def test_wrong_arguments_are_refused(arguments, says, tmp_path):
    result = call(*arguments, folder=str(tmp_path))
    assert result.returncode == 2
    assert says in result.stderr


def test_a_path_that_cannot_exist(tmp_path):
    path = str(tmp_path / "none" / "remote.sock")
    result = call("--socket", path)
    assert result.returncode == 1
    assert path in result.stderr
