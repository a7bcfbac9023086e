"""Where the tests find the modules of the source tree, and how they load a launch file."""

import os
import sys

import pytest

HERE = os.path.dirname(os.path.realpath(__file__))
sys.path[:0] = [os.path.join(HERE, '..', folder) for folder in (
    'body_motion', 'evaluation', 'python', 'rig_planning', 'scripts')]


@pytest.fixture
def load(monkeypatch):
    import roslaunch.config  # takes long, and few tests need it
    monkeypatch.setenv('PWD', '/home/my lab')

    def load(name, *arguments):
        """Nodes by name, and parameters, of a file in the folder launch."""
        config = roslaunch.config.load_config_default(
            [(os.path.join(HERE, '../launch', name), list(arguments))], 11311, verbose=False)
        return ({node.name: node for node in config.nodes},
                {name: parameter.value for name, parameter in config.params.items()})
    return load
