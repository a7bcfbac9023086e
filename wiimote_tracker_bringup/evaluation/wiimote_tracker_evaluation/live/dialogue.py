"""Prompts and answers on the terminal."""

import select
import sys

SKIP = 's'


class Dialogue:
    def __init__(self, source=None, output=None):
        self._source = source or sys.stdin
        self._output = output or sys.stdout

    def tell(self, text, end='\n'):
        self._output.write('\r\033[K' * self._output.isatty() + text + end)
        self._output.flush()

    def passing(self, text):
        """A status text that need not be kept; only on a terminal."""
        if self._output.isatty():
            self._output.write('\r\033[K      ' + text[:90])
            self._output.flush()

    def beep(self):
        """A signal for a person who looks at the LED."""
        if self._output.isatty():
            self._output.write('\a')
            self._output.flush()

    def ask(self, text):
        """The typed line, stripped; empty at the end of the input."""
        self.tell('   ?  ' + text + ' ', end='')
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
            self.tell(f'      Please type a number within {lowest:g} and {highest:g}, or nothing.')

    def typed(self):
        """A line typed in the meantime, or None."""
        if select.select([self._source], [], [], 0.0)[0]:
            return self._source.readline().strip()
        return None
