"""Line by line: for terminals without a screen, for scripts, for a log."""

import queue
import sys
import threading
import time
from typing import Any, Callable, Iterable, List, Optional, Sequence

from .commands import UsageError, number
from .dialogue import Dialogue
from .guide import FOUND_WITHIN
from .text import figure

PERIOD = 0.05         # [s] Between two checks for input and events.
LONGEST_WAIT = 60.0   # [s] Default of the word wait.
PROGRESS_STEP = 0.25  # The progress is printed once per step.
OWN_WORDS = [('next', 'do what is next'),
             ('wait [SECONDS]', 'until nothing is missing in this step'),
             ('quit', 'end')]


class Plain:
    """Words, one per line, each sent when the one before was answered."""

    def __init__(self, dialogue: Dialogue, say: Callable[[str], Any] = print,
                 lines: Optional[Iterable[str]] = None, board: str = ''):
        """board: the camera whose lens is calibrated; empty: the rig is."""
        self._dialogue = dialogue
        self._say = say
        self._board = board
        self._lines = queue.Queue()
        self._told = {}
        self._last = ''
        self.failures = 0
        if lines is None:
            lines = sys.stdin
            lines.reconfigure(errors='replace')  # a script's remarks may have another encoding
        threading.Thread(target=self._read, args=(lines,), daemon=True).start()

    def _read(self, lines: Iterable[str]) -> None:
        for line in lines:
            self._lines.put(line)
        self._lines.put(None)

    def run(self) -> None:
        """Until the word quit, the end of the input or Ctrl-C."""
        self._tell('Type a word and Enter: next does what is next, help lists all, quit ends.')
        try:
            while self._step():
                pass
        except KeyboardInterrupt:
            pass
        self._look()

    def _step(self) -> bool:
        self._look()
        guide = self._dialogue.guide
        looking = guide.status is None and time.monotonic() - guide.began < FOUND_WITHIN
        if self._dialogue.is_busy() or looking:
            time.sleep(PERIOD)
            return True
        try:
            line = self._lines.get(timeout=PERIOD)
        except queue.Empty:
            return True
        words = line.split('#')[0].split() if line is not None else ['quit']
        return self._obey(words[0], words[1:]) if words else True

    def _obey(self, word: str, arguments: List[str]) -> bool:
        guide = self._dialogue.guide
        if word in ('quit', 'q'):
            return False
        if word in ('help', '?'):
            words = OWN_WORDS + [(f'{command.word} {command.arguments}', command.label)
                                 for command in self._dialogue.command_list]
            for text, label in words:
                self._tell(f'{text:<45} {label}')
        elif word == 'wait':
            self._wait(arguments)
        else:
            guide.say('')
            if word == 'next':
                self._dialogue.next()
            else:
                self._dialogue.command(word, arguments)
            if not self._dialogue.is_busy() and guide.answer:  # it was not understood
                self._fail(guide.answer)
        return True

    def _wait(self, arguments: List[str]) -> None:
        """Until nothing is missing in the present step. Of the statuses after an answer the first
        may be older than it, so the second one counts."""
        guide = self._dialogue.guide
        try:
            longest = number(arguments[0], 'the time') if arguments else LONGEST_WAIT
        except UsageError:
            self._fail(f'wait needs a number of seconds, not "{arguments[0]}"')
            return
        end = time.monotonic() + longest
        while guide.statuses_since_answer < 2 or self._missing():
            if time.monotonic() > end:
                missing = self._missing() if guide.status else ()
                why = missing[0] if missing else 'the calibration node is silent'
                self._fail(f'waited for {longest:g} s; {why}')
                return
            self._look()
            time.sleep(PERIOD)

    def _missing(self) -> Sequence[str]:
        guide = self._dialogue.guide
        if not self._board:
            return guide.status.missing
        board = self._board_status()
        return [self._dialogue.advice().sentence] if board is None else board.missing

    def _board_status(self):
        """None: nothing was started."""
        board = self._dialogue.guide.board
        return board if board is not None and board.camera == self._board else None

    def _fail(self, text: str) -> None:
        self.failures += 1
        self._tell(text)

    # --- Printing what is new

    def _look(self) -> None:
        guide = self._dialogue.guide
        answers = len(guide.answers)
        self._dialogue.take_events(time.monotonic())
        for good, text in guide.answers[answers:]:
            self.failures += 0 if good else 1
            self._tell(('' if good else 'refused: ') + text)
        if guide.lost and not self._told.get('lost'):
            self._fail(guide.lost)
        self._told['lost'] = guide.lost
        silent = guide.silent(time.monotonic())
        # Of a node that was there the sentence is printed once, though it counts the seconds.
        self._tell_new('silent', silent if guide.status is None else bool(silent), silent)
        if silent:
            return
        if self._board:
            self._look_at_board()
        else:
            self._look_at_rig()
        if guide.running:
            return  # the advice changes with the answer
        advice = self._dialogue.advice()
        self._tell_new('advice', advice.sentence,
                       ('next: ' if advice.word else '') + advice.sentence)

    def _look_at_board(self) -> None:
        board = self._board_status()
        if board is None:
            return
        self._tell_new('views', board.views, f'{board.views} of {board.views_needed} views')
        self._tell_new('missing', tuple(board.missing[:1]),
                       f'missing: {board.missing[0]}' if board.missing else '')

    def _look_at_rig(self) -> None:
        guide = self._dialogue.guide
        status = guide.status
        self._look_at_progress(status)
        missing = status.missing[0] if status.missing else ''
        is_told = missing in self._new_answer() or missing in status.message
        self._tell_new('missing', tuple(status.missing[:1]),
                       f'missing: {missing}' if missing and not is_told else '')
        if guide.trace is not None:
            self._tell_new('trace', guide.trace.table, guide.trace.table.rstrip())
        if guide.verdict is not None:
            next_one = guide.verdict.next_measurement
            self._tell_new('measurement', next_one,
                           f'to improve it: {next_one}' if next_one else '')
        if guide.running:
            return  # the problems change all the time; the answer will name the last ones
        for camera in status.cameras:
            for kind in ('problem', 'health'):
                text = getattr(camera, kind)
                self._tell_new((kind, camera.name), text,
                               f'{camera.name}: {text}' if text else '')

    def _look_at_progress(self, status) -> None:
        """The progress, and what the node says: not again what it answers, of which the status
        comes a moment sooner or later."""
        guide = self._dialogue.guide
        if guide.running and (guide.is_waving() or not guide.is_busy()):
            return
        share = int(status.progress / PROGRESS_STEP) if status.progress >= 0.0 else -1  # NaN: -1
        is_old = (self._new_answer().startswith(status.message)
                  or status.message == self._told.get('message'))
        self._told['message'] = status.message
        if not is_old or share != self._told.get('share'):
            self._told['share'] = share
            self._tell(f'{figure(100.0 * status.progress, 0, 3)} %' +
                       ('' if is_old else f'  {status.message}'))

    def _new_answer(self) -> str:
        """Empty when it is older than what the status says (see _wait)."""
        guide = self._dialogue.guide
        is_new = guide.answers and guide.statuses_since_answer <= 2
        return guide.answers[-1][1] if is_new else ''

    def _tell_new(self, kind: Any, value: Any, text: str) -> None:
        if self._told.get(kind) != value:
            self._told[kind] = value
            if text and text != self._last:
                self._tell(text)

    def _tell(self, text: str) -> None:
        self._last = text
        self._say(text)
