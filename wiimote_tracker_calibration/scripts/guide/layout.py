"""Text that fits: wrapping, bars, numbers. ASCII only, so that it works in every terminal."""

import math
import textwrap


def wrapped(text, width, lines):
    """The text in at most so many lines; what does not fit ends in '...'."""
    # A message may come with line breaks of its own.
    rows = []
    for part in text.splitlines():
        rows += textwrap.wrap(part, width) or ['']
    if len(rows) > lines:
        rows = rows[:lines]
        rows[-1] = rows[-1][:width - 3].rstrip() + '...'
    return rows


def bar(share, width):
    """[####------] of a share 0..1."""
    if not share >= 0.0:  # NaN as well
        share = 0.0
    filled = int(min(share, 1.0) * width + 1e-9)
    return '[' + '#' * filled + '-' * (width - filled) + ']'


def figure(value, text, unknown='-'):
    """A number in a format, or a dash when it is not known."""
    return text % value if math.isfinite(value) else unknown


def duration(seconds):
    seconds = int(seconds)
    return '%d:%02d' % (seconds // 60, seconds % 60)


def fitted(line, width):
    """Printable ASCII of at most this width: a device's name may hold anything."""
    return ''.join(c if ' ' <= c <= '~' else '?' for c in line)[:width].rstrip()
