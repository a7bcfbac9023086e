"""The nodes in Python say what they do and what their parameters are, without a master."""

import os
import subprocess
import sys

import pytest

PACKAGE = os.path.join(os.path.dirname(os.path.realpath(__file__)), '..')


@pytest.mark.parametrize('program, words', [
    ('launch/drivers', '(default: 10)'),
    ('launch/master_watch', 'no parameters'),
    ('simulation/simulated_hand', '[m]'),
    ('evaluation/place_cameras', 'needed'),
    ('evaluation/probe', '[s] (default: 10)'),
])
def test_help_tells_the_parameters(program, words):
    done = subprocess.run([sys.executable, os.path.join(PACKAGE, program), '__name:=other',
                           '--help'], stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=60,
                          universal_newlines=True,
                          env=dict(os.environ, ROS_MASTER_URI='http://localhost:1'))
    assert (done.returncode, done.stderr) == (0, '')
    assert done.stdout.startswith(f'usage: {os.path.basename(program)} ')
    assert words in done.stdout
