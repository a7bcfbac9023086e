"""The order of requests, answers and what is said in between."""

import pytest
from std_msgs.msg import String
from wiimote_tracker_msgs.msg import CalibrationStatus, CalibrationVerdict

from fakes import FakeNode, dialogue_with, status
from guide import screen

CAPTURE = status(CalibrationStatus.READY, 'capture_corner', 'capture')


@pytest.mark.parametrize('sound, rings', [
    ('captured', 1), ('refused', 2), ('enough', 1), ('solved', 1)])
def test_the_bell_rings_for_every_sound_and_twice_for_a_refusal(sound, rings):
    node = FakeNode()
    dialogue = dialogue_with(node, status(CalibrationStatus.READY))
    assert dialogue.take_events(1.0) == 0
    node.events.put(('sound', String(sound)))
    node.events.put(('status', status(CalibrationStatus.READY)))
    assert dialogue.take_events(2.0) == rings


def test_one_request_at_a_time_but_it_can_be_called_off():
    node = FakeNode()
    dialogue = dialogue_with(node, CAPTURE)
    dialogue.next()
    assert [r.name for r in node.sent] == ['capture_corner']
    dialogue.command('s')
    assert len(node.sent) == 1 and 'capture has not been answered' in dialogue.guide.answer
    dialogue.command('x')
    assert node.called_off == 1 and len(node.sent) == 1
    node.events.put(('feedback', 'wiimote_1 lacks 20', 0.6))
    dialogue.take_events(1.0)
    assert '[############--------] wiimote_1 lacks 20' in screen.render(dialogue.guide, 1.0)
    node.events.put(('answer', 'capture', False,
                     'corner 1 was not captured: the request was cancelled'))
    dialogue.take_events(2.0)
    assert (screen.render(dialogue.guide, 2.0)[21]
            == 'corner 1 was not captured: the request was cancelled')
    dialogue.command('s')
    dialogue.command('x')  # the service cancels solving
    assert [r.name for r in node.sent] == ['capture_corner', 'solve', 'cancel']


def test_space_waits_for_what_the_latest_answer_has_led_to():
    node = FakeNode()
    dialogue = dialogue_with(node, status(CalibrationStatus.SOLVED))
    node.events.put(('answer', 'solve', True, 'good'))
    dialogue.take_events(1.0)
    dialogue.next()  # of a status from before the answer nobody knows what comes next
    assert not node.sent and dialogue.is_busy()
    node.events.put(('status', status(CalibrationStatus.SAVED)))
    dialogue.take_events(2.0)
    assert not node.sent and not dialogue.is_busy()
    assert dialogue.guide.answer == 'Do this. c checks it.'
    node.events.put(('status', CAPTURE))
    dialogue.take_events(3.0)
    dialogue.next()
    assert [r.name for r in node.sent] == ['capture_corner']


def test_space_takes_no_proposal_that_came_after_it():
    node = FakeNode()
    dialogue = dialogue_with(node, status(CalibrationStatus.SOLVED, 'save'))
    proposal = status(CalibrationStatus.SAVED, 'continuous/apply', 'use it')
    node.events.put(('answer', 'solve', True, 'good'))
    dialogue.take_events(1.0)
    dialogue.next()
    node.events.put(('status', proposal))
    dialogue.take_events(2.0)
    assert not node.sent and 'has just changed' in dialogue.guide.answer
    dialogue.next()
    assert [r.name for r in node.sent] == ['continuous/apply']


def test_what_is_typed_wrongly_reaches_no_node():
    node = FakeNode()
    dialogue = dialogue_with(node, status(CalibrationStatus.READY))
    dialogue.command('check', ['here'])
    assert 'three numbers' in dialogue.guide.answer
    dialogue.command('?!')
    assert 'there is no' in dialogue.guide.answer
    assert not node.sent


def test_the_verdict_says_what_to_measure_next_and_a_length_is_solved_at_once():
    node = FakeNode({'length': (True, 'corner 1 to corner 3 is 3.5395 m by tape'),
                     'undo': (True, '')})
    dialogue = dialogue_with(node, status(CalibrationStatus.COMPLETE))
    dialogue.command('d', ['1', '3', '3.5395'])
    dialogue.take_events(1.0)
    assert [r.name for r in node.sent] == ['measure_length']  # nothing was solved before
    dialogue.command('s')
    dialogue.take_events(2.0)
    node.events.put(('verdict', CalibrationVerdict(
        text='good', expected_error=0.0087,
        next_measurement='measure from corner 2 to corner 4 by tape: 8.7 -> 6.1 mm')))
    dialogue.command('length', ['2', '4', '3.5'])
    dialogue.take_events(3.0)
    assert [r.name for r in node.sent][1:] == ['solve', 'measure_length', 'solve']
    lines = screen.render(dialogue.guide, 3.0, 'verdict')
    assert lines[4:8] == [
        'good', 'corner 1 to corner 3 is 3.5395 m by tape',
        'Expected error at the corners and above them: 8.7 mm (RMS).',
        'Next (keys d, a): measure from corner 2 to corner 4 by tape: 8.7 -> 6.1 mm']
