"""Text that fits: wrapping, bars, numbers. ASCII only, so that it works in every terminal."""

import math
import re
import textwrap
from typing import List, Sequence


def wrapped(text: str, width: int, lines: int, cut: str = '...') -> List[str]:
    """The text in at most so many lines; what does not fit ends in `cut`."""
    rows = []
    for part in text.splitlines():  # a message may have line breaks
        rows += textwrap.wrap(part, width) or ['']
    if len(rows) > lines:
        rows = rows[:lines]
        rows[-1] = shortened(rows[-1], width - len(cut)) + cut
    return rows


def shortened(line: str, width: int) -> str:
    """Whole words, if there is more than one, that fit; the last one is not a number, whose unit
    would be missing."""
    if len(line) > width:
        line = line[:width + 1].rpartition(' ')[0] or line[:width]
    return re.sub(r'( [-+(]?[\d.]+)+$', '', line).rstrip()


def bar(share: float, width: int) -> str:
    """[####------] of a share 0..1."""
    if not share >= 0.0:  # NaN as well
        share = 0.0
    filled = int(min(share, 1.0) * width + 1e-9)
    return f'[{"#" * filled:-<{width}}]'


def figure(value: float, decimals: int, width: int = 0) -> str:
    """A number, never -0, or a dash when it is not known."""
    text = f'{round(value, decimals) + 0.0:.{decimals}f}' if math.isfinite(value) else '-'
    return text.rjust(width)


def duration(seconds: float) -> str:
    return f'{int(seconds) // 60}:{int(seconds) % 60:02d}'


def fitted(line: str, width: int) -> str:
    """Printable ASCII of at most this width: a device's name may hold anything."""
    return ''.join(c if ' ' <= c <= '~' else '?' for c in line)[:width].rstrip()


def in_columns(texts: Sequence[str], count: int) -> List[str]:
    """So many columns, each as wide as its widest text and filled from top to bottom."""
    rows = -(-len(texts) // count)
    widths = [max(map(len, texts[first:first + rows])) for first in range(0, len(texts), rows)]
    return [' '.join(text.ljust(width) for text, width in zip(texts[row::rows], widths)).rstrip()
            for row in range(rows)]


def padded(lines: List[str], count: int) -> List[str]:
    """Exactly so many lines."""
    return (list(lines) + [''] * count)[:max(count, 0)]
