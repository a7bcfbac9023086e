"""What the simulated hand does with its LED beside a calibration."""

import os

import pytest
import rospy
from wiimote_tracker_msgs.msg import CalibrationStatus

import program_module

hand = program_module.load('simulation/simulated_hand')
RIGS = os.path.join(os.path.dirname(hand.__file__), '..', 'simulation')


class Conductor:
    """Remembers what it was asked for."""

    def __init__(self, *_, **__):
        self.calls = []

    def __getattr__(self, name):
        return lambda *arguments: self.calls.append((name,) + arguments)


@pytest.mark.parametrize('rig, done', [('paper_rig.yaml', 'circle_from'),
                                       ('body_rig.yaml', 'switch')])
def test_it_walks_about_unless_there_are_bodies(rig, done, monkeypatch):
    monkeypatch.setattr(rospy, 'get_param', lambda name, default=None: {
        '~description': os.path.join(RIGS, rig)}.get(name, default))
    monkeypatch.setattr(rospy, 'resolve_name', lambda name: name)
    monkeypatch.setattr(rospy, 'wait_for_message', lambda *_: None)
    monkeypatch.setattr(hand, 'Conductor', Conductor)
    person = hand.Hand()
    person._follow(CalibrationStatus(step=CalibrationStatus.SAVED))
    last = person._conductor.calls[-1]
    assert last[0] == done
    if done == 'switch':
        assert last == ('switch', 'led', False)
        assert ('switch', 'wand_0', True) in person._conductor.calls
