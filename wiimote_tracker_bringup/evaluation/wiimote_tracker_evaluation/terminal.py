"""Lines on the terminal, and below them a status that is overwritten."""

import sys

WIDTH = 90  # of a status, in letters


class Terminal:
    """Without a terminal there is no status. output: default the standard output."""

    def __init__(self, output=None):
        self._output = output or sys.stdout
        self.live = self._output.isatty()

    def line(self, text, end='\n'):
        self._write('\r\033[K' * self.live + text + end)

    def passing(self, text):
        """A status that need not be kept."""
        if self.live:
            self._write('\r\033[K      ' + text[:WIDTH])

    def beep(self):
        """A signal for a person who looks elsewhere."""
        if self.live:
            self._write('\a')

    def _write(self, text):
        self._output.write(text)
        self._output.flush()
