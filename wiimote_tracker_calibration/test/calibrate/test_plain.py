"""The words of a script, carried out one after the other."""

import functools
import io
import sys
import time

from wiimote_tracker_msgs.msg import BoardStatus, CalibrationStatus

from fakes import FakeNode, dialogue_with, status
from guide import board_screen, commands
from guide.dialogue import Dialogue
from guide.guide import FOUND_WITHIN, Guide
from guide.plain import Plain


def plain(text, node, *statuses):
    """Exit count of failures and all that was said."""
    said = []
    dialogue = dialogue_with(node, *statuses)
    face = Plain(dialogue, said.append, io.StringIO(text))
    dialogue.guide.on_status(statuses[-1], time.monotonic())
    face.run()
    return face.failures, said


def test_plain_words_are_carried_out_one_after_the_other():
    node = FakeNode({})
    failures, said = plain('undo # a remark\n\nstart 2.5\nquit\nsolve\n', node,
                           status(CalibrationStatus.READY, message='ready'))
    assert [r.name for r in node.sent] == ['undo', 'start']
    assert failures == 0
    assert 'undo done' in said and 'start done' in said
    assert any('ready' in line for line in said)


def test_plain_counts_what_was_refused_and_what_was_not_understood():
    node = FakeNode({'solve': (False, 'only 2 of 4 corners are captured')})
    failures, said = plain('solve\ncheck here\nfoo\nwait 0\n', node,
                           status(CalibrationStatus.READY, missing=['corner 3']))
    assert failures == 4
    assert 'refused: only 2 of 4 corners are captured' in said
    assert 'waited for 0 s; corner 3' in said


def test_plain_waits_for_a_number_of_seconds():
    for text in ('nan', 'soon'):
        failures, said = plain(f'wait {text}\n', FakeNode({}),
                               status(CalibrationStatus.READY, missing=['corner 3']))
        assert failures == 1
        assert f'wait needs a number of seconds, not "{text}"' in said


def test_plain_tells_an_answer_once_though_the_status_has_it_too():
    """The status has it before the answer comes, and afterwards."""
    before, after = status(CalibrationStatus.READY), status(
        CalibrationStatus.READY, message='corner 3 was dropped', progress=0.5)

    class Node(FakeNode):
        def send(self, word, request):
            self.events.put(('status', after))
            super().send(word, request)
            for _ in range(2):
                self.events.put(('status', after))

    for answers in ({'undo': (True, after.message)}, {'undo': (False, after.message)},
                    {'undo': (True, after.message + '\na table')}):
        said = plain('undo\nwait 30\n', Node(answers), before)[1]
        assert sum(after.message in line for line in said) == 1, said
        assert ' 50 %' in said


def test_plain_tells_every_answer_also_when_it_is_the_same_again():
    refusal = 'only 2 of 4 corners are captured'
    node = FakeNode({'solve': (False, refusal)})
    failures, said = plain('solve\nsolve\n', node, status(CalibrationStatus.READY))
    assert failures == 2
    assert said.count(f'refused: {refusal}') == 2


def test_plain_tells_what_is_missing_once_though_the_answer_says_it_too():
    todo = 'put the LED on corner 2 and capture it'
    after = status(CalibrationStatus.READY, message=f'captured; {todo}', missing=[todo])

    class Node(FakeNode):
        def send(self, word, request):
            super().send(word, request)
            self.events.put(('status', after))

    said = plain('undo\nwait 0\n', Node({'undo': (True, after.message)}),
                 status(CalibrationStatus.READY))[1]
    assert sum(todo in line for line in said if not line.startswith('waited')) == 1, said


def test_plain_tells_what_is_missing_again_though_an_older_answer_said_it():
    """Somebody else captures a corner, and drops it."""
    todo = 'put the LED on corner 2 and capture it'
    answer = f'captured; {todo}'
    said, node = [], FakeNode({'undo': (True, answer)})
    # Of those after an answer the first may be older than it.
    later = {answer: 2 * [status(CalibrationStatus.READY, missing=['corner 3'])],
             'missing: corner 3': [status(CalibrationStatus.READY, missing=[todo])],
             f'missing: {todo}': [status(CalibrationStatus.COMPLETE)]}

    def say(text):
        said.append(text)
        for each in later.get(text, []):
            node.events.put(('status', each))

    face = Plain(dialogue_with(node, status(CalibrationStatus.READY)), say,
                 io.StringIO('undo\nwait 30\n'))
    face.run()
    assert face.failures == 0, said


def test_plain_says_what_to_do_without_a_node():
    said, node = [], FakeNode()
    guide = Guide(time.monotonic() + 1e6)

    def input_of_a_user():
        yield from wait_for('Looking for the calibration node.')
        guide.began = -FOUND_WITHIN
        yield from wait_for('No calibration node answers at calibration/status: start it')
        node.events.put(('elsewhere', 'another runs'))
        yield from wait_for('None here, but another runs')
        yield 'quit'

    def wait_for(beginning):
        end = time.monotonic() + 30.0
        while not any(text.startswith(beginning) for text in said):
            if time.monotonic() > end:
                yield 'quit'
            time.sleep(0.01)

    face = Plain(Dialogue(guide, node, commands.RIG, guide.advice), said.append, input_of_a_user())
    face.run()
    assert said[-1] == 'None here, but another runs'


def test_plain_next_without_a_node_fails_and_does_not_hang():
    said = []
    guide = Guide(-10.0)
    face = Plain(Dialogue(guide, FakeNode(), commands.RIG, guide.advice), said.append,
                 io.StringIO('next\n'))
    face.run()
    assert face.failures == 1
    assert 'Waiting for the calibration node.' in said


def test_plain_reads_on_after_bytes_of_another_encoding(monkeypatch):
    script = io.BytesIO('# größe\nundo\n'.encode('latin-1'))
    monkeypatch.setattr(sys, 'stdin', io.TextIOWrapper(script, 'utf-8'))
    face = Plain(dialogue_with(FakeNode()), print)
    lines = [face._lines.get(timeout=10.0) for _ in range(3)]
    assert lines == ['# gr\ufffd\ufffde\n', 'undo\n', None]


def test_plain_waits_for_the_views_of_a_board():
    """What the rig's calibration lacks, and what it says of the cameras, does not count."""
    node, guide, said = FakeNode({}), Guide(time.monotonic()), []
    rig = status(CalibrationStatus.READY, missing=['corner 3'], message='put the LED on corner 3')

    def say(text):
        said.append(text)
        if text == 'missing: tilt it':
            node.events.put(('board', BoardStatus(camera='wiimote_1', views=12, views_needed=12)))

    dialogue = Dialogue(guide, node, commands.board_commands('wiimote_1'),
                        functools.partial(board_screen.advice, guide, 'wiimote_1'))
    for event in (('status', rig), ('status', rig), ('board', BoardStatus(
            camera='wiimote_1', views=5, views_needed=12, missing=['tilt it']))):
        node.events.put(event)
    face = Plain(dialogue, say, io.StringIO('wait 60\n'), 'wiimote_1')
    face.run()
    assert face.failures == 0
    assert said.index('5 of 12 views') < said.index('12 of 12 views')
    assert not any('corner 3' in line for line in said)


def test_plain_says_that_no_board_was_started():
    guide = Guide(time.monotonic())
    guide.on_status(status(CalibrationStatus.READY), time.monotonic())
    said = []
    face = Plain(Dialogue(guide, FakeNode({}), commands.board_commands('wiimote_1'),
                          functools.partial(board_screen.advice, guide, 'wiimote_1')),
                 said.append, io.StringIO('wait 0\n'), 'wiimote_1')
    face.run()
    assert face.failures == 1
    assert 'waited for 0 s; Hold the 16-LED board in front of wiimote_1. SPACE starts.' in said


def test_plain_waits_until_nothing_is_missing():
    node = FakeNode({})
    dialogue = dialogue_with(node, status(CalibrationStatus.WAVING, missing=['3 s']))
    said = []

    def say(text):
        said.append(text)
        if text == 'missing: 1 s':
            node.events.put(('status', status(CalibrationStatus.WAVING, message='enough')))

    # After an answer, one status may be from before it.
    node.events.put(('answer', 'wave', True, 'recording'))
    node.events.put(('status', status(CalibrationStatus.COMPLETE)))
    face = Plain(dialogue, say, io.StringIO('wait 30\nsolve\n'))

    def tell_more(text, say=say):
        say(text)
        if text == 'recording':
            node.events.put(('status', status(CalibrationStatus.WAVING, missing=['1 s'])))
    face._say = tell_more
    face.run()
    assert face.failures == 0
    assert said.index('missing: 1 s') < said.index('  0 %  enough') < said.index('solve done')


def test_plain_fails_when_the_node_was_started_again_amid_a_calibration():
    node = FakeNode({})
    before = status(CalibrationStatus.WAVING, message='recording', missing=['1 s'])
    before.header.seq = 50
    said = []
    face = Plain(dialogue_with(node, before), said.append, io.StringIO('undo\n'))
    node.events.put(('status', status(CalibrationStatus.SAVED, message='the old rig is in use')))
    face.run()
    assert face.failures == 1
    assert sum('is lost. Start again.' in line for line in said) == 1
