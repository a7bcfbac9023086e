"""The other computer of the fault matrix: packets are carried, delayed and lost."""

import socket
import subprocess
import sys
import time

import pytest

from wiimote_tracker_evaluation.faults import far_computer

PATIENCE = 60.0  # on a busy computer [s]
ECHO = """
import socket, sys
s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
s.bind((sys.argv[1], 0))
s.sendto(b'ready', (sys.argv[2], int(sys.argv[3])))
while True:
    s.sendto(*s.recvfrom(100))
"""


@pytest.mark.skipif(far_computer.why_not() != '', reason=far_computer.why_not())
def test_packets_are_carried_delayed_and_lost():
    far = far_computer.FarComputer()
    near = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    near.bind((far.here, 0))
    near.settimeout(PATIENCE)
    echo = subprocess.Popen(far.prefix() + [sys.executable, '-c', ECHO, far.there, far.here,
                                            str(near.getsockname()[1])])
    try:
        ready, there = near.recvfrom(100)
        assert (ready, there[0]) == (b'ready', far.there)

        far.change(delay=0.1)
        start = time.monotonic()
        near.sendto(b'delayed', there)
        assert near.recv(100) == b'delayed'
        assert time.monotonic() - start > 0.19

        far.change(cut=True)
        near.sendto(b'cut', there)
        far.change()
        near.sendto(b'after', there)
        assert near.recv(100) == b'after'
    finally:
        echo.kill()
        echo.wait()
        near.close()
        far.stop()
