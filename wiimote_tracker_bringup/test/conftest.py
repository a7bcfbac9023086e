"""Where the tests find the modules of the source tree; launch files, loaded in a user's folder."""

import os
import sys

import pytest

HERE = os.path.dirname(os.path.realpath(__file__))
sys.path[:0] = [os.path.join(HERE, '..', folder) for folder in (
    'body_motion', 'evaluation', 'python', 'rig_planning', 'scripts')]


@pytest.fixture
def load(monkeypatch):
    import launch_files  # takes long, and few tests need it
    monkeypatch.setenv('PWD', '/home/my lab')
    return launch_files.load
