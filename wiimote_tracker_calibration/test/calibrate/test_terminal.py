"""What keys do, without a terminal."""

import curses

import pytest
from wiimote_tracker_msgs.msg import CalibrationStatus

from fakes import FakeNode, dialogue_with, status
from guide.terminal import Terminal

ENTER, ESCAPE, BACKSPACE = '\n', '\x1b', '\x7f'
NONE = '\0'  # no key within the period


class Window:
    """Of 24 x 80; gives these keys, then q."""

    def __init__(self, keys):
        self._keys = list(keys + 'q')

    def get_wch(self):
        key = self._keys.pop(0)
        if key == NONE:
            raise curses.error('no input')
        return key

    def getmaxyx(self):
        return 24, 80

    def addnstr(self, row, column, text, count, style):
        # curses raises an error when the cursor leaves the window.
        assert column + min(len(text), count) <= 80 - (row == 23)

    def timeout(self, milliseconds):
        pass

    erase = refresh = lambda self: None


@pytest.fixture(autouse=True)
def no_curses(monkeypatch):
    monkeypatch.setattr(curses, 'curs_set', lambda visible: None)
    monkeypatch.setattr(curses, 'beep', lambda: None)


def pressed(keys, *statuses):
    """Requests that the keys have sent, and (view, page, prompt) of each drawing."""
    node = FakeNode({})
    drawn = []

    def draw(now, view, page, rows, columns, prompt):
        drawn.append((view, page, prompt))
        return ['x' * columns] * rows

    terminal = Terminal(dialogue_with(node, *statuses), draw, {'i': 'verdict', '?': 'keys'})
    terminal._loop(Window(keys))
    return [(request.name, request.fields) for request in node.sent], drawn


def test_all_is_dropped_only_after_a_question():
    ready = status(CalibrationStatus.READY, corners_captured=3)
    assert pressed('x' + ESCAPE, ready)[0] == []
    sent, drawn = pressed('x' + ENTER, ready)
    assert sent == [('cancel', {})]
    assert drawn[1][2] == ('Drop all that was captured? Enter: yes, Escape: no', '')
    # What goes on is stopped at once.
    assert pressed('x', status(CalibrationStatus.CAPTURING))[0] == [('cancel', {})]


def test_the_rig_before_is_used_again_only_after_a_question():
    saved = status(CalibrationStatus.SAVED)
    assert pressed('b' + ESCAPE, saved)[0] == []
    assert pressed('b' + ENTER, saved)[0] == [('continuous/revert', {})]


class Proposes(Window):
    """Here a correction is proposed, or withdrawn, just before the second key."""

    def __init__(self, keys, node, newer):
        super().__init__(keys)
        self._node, self._newer = node, newer

    def get_wch(self):
        self._node.events.put(('status', self._newer))
        return super().get_wch()


def test_space_does_not_do_what_was_not_read_yet(monkeypatch):
    save = status(CalibrationStatus.SOLVED, 'save', 'save')
    apply = status(CalibrationStatus.SOLVED, 'continuous/apply', 'correct it')
    for before, newer, late in ((save, apply, 'continuous/apply'), (apply, save, 'save')):
        node = FakeNode({})
        dialogue = dialogue_with(node, before)
        terminal = Terminal(dialogue, lambda *_: [''] * 24, {})
        now = [100.0]
        monkeypatch.setattr('guide.terminal.time.monotonic', lambda: now[0])
        terminal._loop(Window(''))
        now[0] += 10.0
        terminal._loop(Proposes('  ', node, newer))
        # The first SPACE was for what was next before.
        assert node.sent[0].name == before.next_request
        assert len(node.sent) == 1 and 'has just changed' in dialogue.guide.answer
        now[0] += 1.0
        terminal._loop(Window(' '))
        assert node.sent[1].name == late


@pytest.mark.parametrize('step', [CalibrationStatus.IDLE, CalibrationStatus.SAVED,
                                  CalibrationStatus.SOLVED])  # a loaded rig that was changed
def test_a_wave_that_will_be_refused_asks_for_no_length(step):
    sent, drawn = pressed('w', status(step))
    assert [name for name, _ in sent] == ['start_wave'] and drawn[-1][2] is None
    started = status(step, square_sides=[2.5, 2.5])  # saved, and its wave is recorded again
    assert pressed('w' + ESCAPE, started)[1][1][2] is not None


def test_what_is_typed_is_sent_with_enter():
    complete = status(CalibrationStatus.COMPLETE, square_sides=[2.5, 2.5])
    sent, drawn = pressed('w0.56' + BACKSPACE + ENTER, complete)
    assert sent == [('start_wave', {'wand_length': 0.5, 'wand_stddev': 0.0})]
    assert drawn[5][2][1] == '0.56' and drawn[6][2][1] == '0.5' and drawn[7][2] is None
    assert pressed('n2.5 1q' + ESCAPE, complete)[0] == []  # q is a letter here
    # The same key ends a wave.
    assert pressed('w', status(CalibrationStatus.WAVING))[0] == [('stop_wave', {})]
    path = '/home/jörg/räume/зал.yaml'
    sent, drawn = pressed('l' + NONE + path + ENTER, complete)
    assert sent == [('load', {'path': path})]
    assert drawn[-2][2][1] == path


def test_keys_show_views_and_pages_and_space_does_what_is_next():
    capture = status(CalibrationStatus.READY, 'capture_corner', 'capture')
    sent, drawn = pressed('i\tii?' + ESCAPE + ' ', capture)
    assert [(view, page) for view, page, _ in drawn[:7]] == [
        (None, 0), ('verdict', 0), ('verdict', 1), (None, 0), ('verdict', 0), ('keys', 0),
        (None, 0)]
    assert sent == [('capture_corner', {})]


def test_a_key_without_a_command_is_said():
    dialogue = dialogue_with(FakeNode({}), status(CalibrationStatus.READY))
    Terminal(dialogue, lambda *_: [''] * 24, {})._loop(Window('?'))  # no views, as with --board
    assert 'the last lines list the keys' in dialogue.guide.answer


def test_a_key_that_the_screen_cannot_show_is_not_named():
    dialogue = dialogue_with(FakeNode({}), status(CalibrationStatus.READY))
    Terminal(dialogue, lambda *_: [''] * 24, {})._loop(Window('\xe4'))
    assert dialogue.guide.answer.startswith('there is no such key; ')
