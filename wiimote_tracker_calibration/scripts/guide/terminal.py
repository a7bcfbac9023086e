"""The screen, drawn with curses: reads keys and draws lines."""

import curses
import os
import time
from typing import Callable, Dict, List, Union

from .commands import Command, find
from .dialogue import CHANGED, PROPOSED, Dialogue

PERIOD = 0.1         # [s] Between two drawings.
BETWEEN_RINGS = 0.3  # [s] So that two are heard.
READ_WITHIN = 0.5    # [s] Whoever presses SPACE sooner means what was next before.
# Keys of which terminals have several for one.
ESCAPE = ('\x1b',)
BACKSPACE = ('\b', '\x7f', curses.KEY_BACKSPACE)
ENTER = ('\n', '\r', curses.KEY_ENTER)


def terminal_problem() -> str:
    """Why this terminal can show no screen, and what to do; empty if it can."""
    try:
        curses.setupterm()
    except curses.error:
        return (f'this computer does not know the terminal "{os.environ.get("TERM", "")}", which '
                'TERM names: set  TERM=xterm , or use --plain')
    return ''


class Terminal:
    def __init__(self, dialogue: Dialogue, draw: Callable[..., List[str]],
                 views: Dict[str, str]):
        """draw: lines of text from (now, view, page, rows, columns, prompt). views: key -> name of
        the view that it shows; the same key again, or Escape, shows the first view."""
        self._dialogue = dialogue
        self._draw = draw
        self._views = views
        self._view = None
        self._page = 0
        self._asking = None  # the command whose arguments are being typed
        self._typed = ''
        self._next = None          # the command that SPACE stands for
        self._proposed_at = -1e9   # when PROPOSED became that, or ceased to be [s]

    def run(self) -> None:
        """Until q or Ctrl-C."""
        try:
            curses.wrapper(self._loop)
        except KeyboardInterrupt:
            pass

    def _loop(self, window) -> None:
        try:
            curses.curs_set(0)
        except curses.error:
            pass  # some terminals cannot hide the cursor
        window.timeout(int(1000 * PERIOD))
        while True:
            for ring in range(self._dialogue.take_events(time.monotonic())):
                if ring > 0:
                    time.sleep(BETWEEN_RINGS)
                curses.beep()
            self._show(window)
            try:
                key = window.get_wch()
            except curses.error:
                continue  # none was pressed
            if not self._press(key):
                return

    def _show(self, window) -> None:
        word = self._dialogue.advice().word
        if word != self._next and PROPOSED in (word, self._next):
            self._proposed_at = time.monotonic()
        self._next = word
        rows, columns = window.getmaxyx()
        prompt = (self._asking.ask, self._typed) if self._asking else None
        lines = self._draw(time.monotonic(), self._view, self._page, rows, columns, prompt)
        window.erase()
        for row, line in enumerate(lines):
            style = curses.A_REVERSE if row == 0 else curses.A_BOLD if row < 3 else 0
            # The last character of the last line cannot be written: the cursor would leave.
            window.addnstr(row, 0, line.ljust(columns) if row == 0 else line,
                           columns - (1 if row == rows - 1 else 0), style)
        window.refresh()

    def _press(self, key: Union[str, int]) -> bool:
        """key: a character, or the code of another key. Returns False to end."""
        if self._asking:
            self._type(key)
            return True
        sign = key if isinstance(key, str) else ''
        command = find(self._dialogue.command_list, sign)
        if sign == 'q':
            return False
        if sign == ' ' and time.monotonic() < self._proposed_at + READ_WITHIN:
            self._dialogue.guide.say(CHANGED)
        elif sign == ' ':
            self._dialogue.next()
        elif sign == '\t':
            self._page += 1
        elif key in ESCAPE or sign in self._views:
            view = self._views.get(sign)
            self._view = None if view == self._view else view
            self._page = 0
        elif command is not None and command.ask and not self._is_direct(command):
            self._asking, self._typed = command, ''
        elif command is not None:
            self._dialogue.command(sign)
        elif sign.isprintable() and sign:
            name = f'key "{sign}"' if sign.isascii() else 'such key'
            self._dialogue.guide.say(f'there is no {name}; the last lines list the keys')
        return True

    def _is_direct(self, command: Command) -> bool:
        """Whether it is sent without a question: it ends a wave, stops what goes on, or will be
        refused."""
        guide = self._dialogue.guide
        if command.word == 'wave':
            return guide.is_waving() or not guide.is_started()
        return command.word == 'cancel' and bool(guide.running or guide.is_busy())

    def _type(self, key: Union[str, int]) -> None:
        if key in ESCAPE:
            self._asking = None
        elif key in ENTER:
            command, self._asking = self._asking, None
            self._dialogue.command(command.word, self._typed.split())
        elif key in BACKSPACE:
            self._typed = self._typed[:-1]
        elif isinstance(key, str) and key.isprintable():
            self._typed += key
