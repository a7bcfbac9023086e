"""Line by line: for terminals without a screen, for scripts, for a log."""

import queue
import sys
import threading
import time

from .guide import FOUND_WITHIN
from .layout import figure

PERIOD = 0.05       # [s] Between two looks.
LONGEST_WAIT = 60.0  # [s] Of the word wait, unless it says otherwise.
OWN_WORDS = [('next', 'do what is said to be next'),
             ('wait [SECONDS]', 'until nothing is missing in this step'),
             ('quit', 'end')]
STEP = 0.25         # of the progress, that is told


def steps_of(progress):
    return int(progress / STEP) if progress >= 0.0 else -1  # NaN as well


class Plain(object):
    """Words, one per line, each carried out when the one before was answered."""

    def __init__(self, dialogue, say=print, lines=None):
        self._dialogue = dialogue
        self._say = say
        self._lines = queue.Queue()
        self._told = {}
        self._last = ''
        self.failures = 0
        threading.Thread(target=self._read, args=(lines or sys.stdin,), daemon=True).start()

    def _read(self, lines):
        for line in lines:
            self._lines.put(line)
        self._lines.put(None)

    def run(self):
        """Until the word quit, the end of the input or Ctrl-C."""
        self._tell('Type a word and Enter: next does what is said, help lists all, quit ends.')
        try:
            while self._step():
                pass
        except KeyboardInterrupt:
            pass
        self._look()

    def _step(self):
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

    def _obey(self, word, arguments):
        guide = self._dialogue.guide
        if word in ('quit', 'q'):
            return False
        if word in ('help', '?'):
            for word, label in OWN_WORDS:
                self._tell('%-45s %s' % (word, label))
            for command in self._dialogue.command_list:
                self._tell('%-45s %s' % (command.word + ' ' + command.arguments, command.label))
        elif word == 'wait':
            self._wait(arguments)
        else:
            guide.say('')
            if word == 'next':
                self._dialogue.next()
            else:
                self._dialogue.command(word, arguments)
            if not self._dialogue.is_busy() and guide.answer:  # it made no sense
                self._fail(guide.answer)
        return True

    def _wait(self, arguments):
        """Until nothing is missing in the present step, by a status that is newer than the last
        answer (of two, the first may have been on its way)."""
        guide = self._dialogue.guide
        try:
            longest = float(arguments[0]) if arguments else LONGEST_WAIT
        except ValueError:
            self._fail('wait needs a number of seconds, not "%s"' % arguments[0])
            return
        end = time.monotonic() + longest
        while guide.statuses_since_answer < 2 or guide.status.missing:
            if time.monotonic() > end:
                missing = guide.status.missing if guide.status else ()
                self._fail('waited for %g s; %s' % (
                    longest, missing[0] if missing else 'the calibration node is silent'))
                return
            self._look()
            time.sleep(PERIOD)

    def _fail(self, text):
        self.failures += 1
        self._tell(text)

    # --- Telling what is new

    def _look(self):
        guide = self._dialogue.guide
        answers = len(guide.answers)
        self._dialogue.take_events(time.monotonic())
        for good, text in guide.answers[answers:]:
            self.failures += 0 if good else 1
            self._tell(('' if good else 'refused: ') + text)
        silent = guide.silent(time.monotonic())
        # A sentence that counts seconds is the same one.
        self._tell_new('silent', bool(silent), silent)
        if silent:
            return
        status = guide.status
        self._tell_new('step', (status.step, status.message, steps_of(status.progress)),
                       '%s  %s' % (figure(100.0 * status.progress, '%3.0f %%'), status.message))
        self._tell_new('missing', tuple(status.missing[:1]),
                       'missing: %s' % status.missing[0] if status.missing else '')
        if guide.trace is not None:
            self._tell_new('trace', guide.trace.table, guide.trace.table.rstrip())
        if guide.running:
            return  # what a capture lacks changes all the time; what it lacked in the end is told
        for camera in status.cameras:
            for kind in ('problem', 'health'):
                text = getattr(camera, kind)
                self._tell_new((kind, camera.name), text,
                               '%s: %s' % (camera.name, text) if text else '')
        advice = self._dialogue.advice()
        self._tell_new('advice', advice.sentence,
                       ('next: ' if advice.word else '') + advice.sentence)

    def _tell_new(self, kind, value, text):
        if self._told.get(kind) != value:
            self._told[kind] = value
            if text:
                self._tell(text)

    def _tell(self, text):
        if text != self._last:
            self._last = text
            self._say(text)
