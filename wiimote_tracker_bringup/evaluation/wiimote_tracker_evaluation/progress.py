"""Progress of the evaluation and its remaining time."""

import time

from wiimote_tracker_evaluation.terminal import Terminal

QUIET_PERIOD = 15.0  # interval of lines without a terminal [s]


class Progress(Terminal):
    """One line per section, with a status below."""

    def __init__(self, expected, output=None, now=time.monotonic):
        """expected: approximate duration of every section [s]."""
        super().__init__(output)
        self._expected = list(expected)
        self._now = now
        self._number = -1
        self._begin = self._said = now()
        self._share = 0.0

    def begin(self, title: str) -> None:
        self._number += 1
        self._share = 0.0
        self._begin = self._said = self._now()
        self.line('[%d/%d] %s' % (self._number + 1, len(self._expected), title))
        self.within(0, 1)

    def within(self, done: float, of: float, what: str = '') -> None:
        """The present section has finished `done` of `of` parts."""
        self._share = min(max(float(done) / of, 0.0), 1.0) if of else 0.0
        text = f'{100.0 * self._share:3.0f} %  {remaining_text(self.remaining()):<12} {what}'
        self.passing(text)
        if not self.live and self._now() - self._said >= QUIET_PERIOD:
            self._said = self._now()
            self.line('      ' + text)

    def end(self, text: str) -> None:
        self.line(f'      {text} after {self._now() - self._begin:.0f} s')

    def remaining(self) -> float:
        """Of all sections [s]: at first as expected, increasingly as observed."""
        elapsed = self._now() - self._begin
        total = max(self._expected[max(self._number, 0)], elapsed)
        if self._share > 0.0:
            total = (1.0 - self._share) * total + self._share * (elapsed / self._share)
        here = max(total * (1.0 - self._share), 0.0)
        return here + sum(self._expected[self._number + 1:])


def remaining_text(seconds: float) -> str:
    if seconds < 55:
        return '%d s left' % (5 * round(seconds / 5.0 + 0.5))
    return '%d min left' % round(seconds / 60.0 + 0.4)
