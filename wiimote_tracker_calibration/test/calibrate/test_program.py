"""The program itself, without a ROS master."""

import os
import pty
import subprocess
import sys

import pytest

PROGRAM = os.path.join(os.path.dirname(os.path.realpath(__file__)), '../../scripts/calibrate')


@pytest.mark.parametrize('address, advice', [
    ('', 'ROS_MASTER_URI is empty, but must be such as http://HOST:11311: correct it'),
    ('htp://x', 'ROS_MASTER_URI is htp://x, but must be such as http://HOST:11311: correct it'),
    ('http://x.invalid:11311', 'there is no ROS master at http://x.invalid:11311: start the '),
    ('http://localhost:1', 'there is no ROS master at http://localhost:1: start the ')])
def test_without_a_master_it_says_what_to_do(address, advice):
    done = subprocess.run([sys.executable, PROGRAM], timeout=60,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True,
                          env=dict(os.environ, ROS_MASTER_URI=address))
    assert (done.returncode, done.stdout) == (1, '')
    assert done.stderr.startswith(advice) and done.stderr.count('\n') == 1


@pytest.mark.parametrize('name', ['', 'no_such_terminal'])
def test_an_unknown_terminal_is_named(name):
    master, terminal = pty.openpty()
    try:
        done = subprocess.run([sys.executable, PROGRAM], timeout=60, stdin=terminal,
                              stdout=terminal, stderr=subprocess.PIPE, universal_newlines=True,
                              env=dict(os.environ, TERM=name))
    finally:
        os.close(terminal)
        os.close(master)
    assert done.returncode == 1
    assert f'"{name}"' in done.stderr and 'use --plain' in done.stderr
    assert done.stderr.count('\n') == 1
