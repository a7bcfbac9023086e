"""Prompts and answers on the terminal."""

import select
import sys

from wiimote_tracker_evaluation.terminal import Terminal

SKIP = 's'


class Dialogue(Terminal):
    def __init__(self, source=None, output=None):
        super().__init__(output)
        self._source = source or sys.stdin

    def ask(self, text):
        """The typed line, stripped; empty at the end of the input."""
        self.line('   ?  ' + text + ' ', end='')
        return self._source.readline().strip()

    def ask_number(self, text, lowest, highest):
        """A number, or None for an empty answer; repeats the question if it is not valid."""
        while True:
            answer = self.ask(text)
            if not answer:
                return None
            try:
                value = float(answer)
            except ValueError:
                value = float('nan')
            if lowest <= value <= highest:
                return value
            self.line(f'      Please type a number within {lowest:g} and {highest:g}, or nothing.')

    def typed(self):
        """A line typed in the meantime, or None."""
        if select.select([self._source], [], [], 0.0)[0]:
            return self._source.readline().strip()
        return None
