"""Numbers out of range are refused with the name of the option or parameter."""

import pytest
import rospy

import program_module
from wiimote_tracker_body_motion import body_to_base, evaluate_trajectory, probe
from wiimote_tracker_bringup import ranges
from wiimote_tracker_bringup.errors import Refusal
from wiimote_tracker_evaluation import evaluation
from wiimote_tracker_rig_planning import plan_rig

hand = program_module.load('simulation/simulated_hand')

TRAJECTORY = evaluate_trajectory.main, ['run.bag', '--estimate', '/odom', '--truth', '/body/pose']
BASE = body_to_base.main, ['run.bag', '--body', '/body/pose', '--odom', '/odom']


@pytest.mark.parametrize('program, option, values', [
    (TRAJECTORY, '--interval', ['-1', '0', 'nan', 'inf', '1e30', 'long']),
    (TRAJECTORY, '--gap', ['-1', '0', 'nan', 'inf']),
    (TRAJECTORY, '--offset', ['nan', 'inf', '1e300']),
    (BASE, '--largest-offset', ['-1', '0', 'nan', 'inf']),
    ((plan_rig.main, ['plan.yaml']), '--generations', ['-1', '0', '1.5', 'nan', str(10 ** 30)]),
    ((plan_rig.main, ['plan.yaml']), '--seed', ['-1', '1.5', str(2 ** 32)]),
    ((evaluation.parse, []), '--seed', ['-1', '1.5', str(2 ** 31)])])
def test_options(program, option, values, capsys):
    main, arguments = program
    for value in values:
        with pytest.raises(SystemExit) as raised:
            main(arguments + [option, value])
        assert raised.value.code == 2
        assert f'argument {option}: ' in capsys.readouterr().err


def test_numbers_of_the_range_are_taken():
    read = ranges.within(-1.0, 2.0)
    assert [read(text) for text in ('-1', '0', '2', '1e-3')] == [-1.0, 0.0, 2.0, 1e-3]
    assert ranges.within(0, 5, int)('5') == 5


@pytest.mark.parametrize('value', [-1.0, 0.0, float('nan'), float('inf'), '5', None, True, [1.0]])
def test_parameters(value, monkeypatch):
    monkeypatch.setattr(rospy, 'get_param', lambda name, default=None: value
                        if name in ('~duration', '~side') else default)
    monkeypatch.setattr(rospy, 'resolve_name', lambda name: name)
    monkeypatch.setattr(probe, 'read_body', lambda: 'wand')
    with pytest.raises(Refusal, match='duration is .*, but must be within 0.1 and 3600'):
        probe.Node()
    with pytest.raises(Refusal, match='side is .*, but must be within 0.1 and 20'):
        hand.Hand()


@pytest.mark.parametrize('content, words', [
    ('seed: 1\nleds: {left: {}}', 'rig.yaml has no LED led, .*: correct ~led'),
    ('cameras: {}', '~description is .*rig.yaml.*, but must be the file that describes'),
    (None, '~description is .*rig.yaml.*, but must be the file that describes')])
def test_the_simulated_hand_needs_a_rig_with_its_led(content, words, monkeypatch, tmp_path):
    path = tmp_path / 'rig.yaml'
    if content:
        path.write_text(content)
    monkeypatch.setattr(rospy, 'get_param', lambda name, default=None: {
        '~description': str(path)}.get(name, default))
    monkeypatch.setattr(rospy, 'resolve_name', lambda name: name)
    with pytest.raises(Refusal, match=words):
        hand.Hand()


def test_the_simulated_hand_needs_a_description(monkeypatch):
    def get_param(name, *default):
        if not default:
            raise KeyError(name)
        return default[0]
    monkeypatch.setattr(rospy, 'get_param', get_param)
    monkeypatch.setattr(rospy, 'resolve_name', lambda name: name)
    with pytest.raises(Refusal, match="~description is '', but"):
        hand.Hand()
