"""Input and output of a section of the evaluation.

A section is a module or folder in sections/ with TITLE, SECONDS (which it takes about on two cores:
quick, full), and run(run), which adds its results to a Run. A section for a person on a real rig
also has live(run); one that reads a file or folder of the user's has an OPTION.
"""

import dataclasses
import io
import math
import os
import re
from typing import Callable, Iterable, List, Optional, Sequence, Tuple

import numpy as np

from wiimote_tracker_bringup import programs, statistics


@dataclasses.dataclass(frozen=True)
class Option:
    """An option of the command line that one section has. kind: the type that argparse converts
    its value to. is_needed: the section does not run without it."""

    name: str
    metavar: str
    kind: Callable[[str], str]
    explanation: str
    is_needed: bool = False


@dataclasses.dataclass(eq=False)
class Figure:
    name: str
    value: float
    unit: str
    samples: int
    interval: Optional[Tuple[float, float]]
    note: str
    end_to_end: bool
    headline: bool
    simulated: bool


@dataclasses.dataclass(eq=False)
class Table:
    name: str
    columns: List[Tuple[str, str]]
    rows: List[list]
    caption: str
    shown: bool


@dataclasses.dataclass(eq=False)
class Plot:
    name: str
    svg: str
    caption: str


@dataclasses.dataclass(eq=False)
class Text:
    markdown: str


class Run:
    """One section in execution.

    options: all of the command line. quick: shorter. seed: of all random numbers. rig: path of the
    rig's description. folder: for own files, and those of table() and plot(). simulated: False if a
    person uses a real rig.
    """

    SHOWN_ROWS = 40  # longer tables are linked in the report

    def __init__(self, name, title, folder, options, on_progress=lambda done, of, what: None):
        self.name, self.title, self.folder, self.options = name, title, folder, options
        self.quick, self.seed, self.rig = options.quick, options.seed, options.rig
        self.simulated = not options.live
        self.contents = []   # Text, Plot, Table, in order
        self.figures = []
        self.summaries = []  # sentences for the head of the report
        self.failure = ''    # why it did not finish
        self._on_progress = on_progress
        os.makedirs(folder, exist_ok=True)

    # --- While it goes on

    def progress(self, done: float, of: float, what: str = '') -> None:
        """Progress of this section, done of `of` parts, and the present step."""
        self._on_progress(done, of, what)

    def compute(self, commands: List[list], what: str, begin: float, end: float) -> None:
        """Runs programs, two at a time; each is a list of words, the first `program` of this
        package or `package/program`. They take the section from the share `begin` to `end`."""
        self.progress(begin, 1.0, what)
        programs.run_programs(commands, self.file('programs.log'), lambda done, of: self.progress(
            begin + (end - begin) * done / of, 1.0, what))

    def file(self, name: str) -> str:
        return os.path.join(self.folder, name)

    # --- What was found

    def summary(self, sentence: str) -> None:
        """A sentence for the head of the report: the accuracy to expect of the rig."""
        self.summaries.append(sentence)

    def say(self, markdown: str) -> None:
        """A paragraph, a heading (###), or a list. Supports **bold**, *italic*, `code` and
        [links](...)."""
        self.contents.append(Text(markdown))

    def figure(self, name: str, value: float, unit: str, samples: int,
               interval: Optional[Sequence[float]] = None, note: str = '',
               end_to_end: bool = False, headline: bool = False,
               simulated: Optional[bool] = None) -> None:
        """A number. name: under_scored, never changed. samples: number of independent measurements.
        interval: (low, high), 95 %. note: description. end_to_end: through the full stack, not in
        process. headline: also in the table of doc/results.md. simulated: default as the
        section."""
        check_name(name, [figure.name for figure in self.figures])
        numbers = [value] + (list(interval) if interval is not None else [])
        if not all(math.isfinite(number) for number in numbers):
            raise ValueError(f'figure {name} is not a finite number: {numbers}')
        self.figures.append(Figure(
            name, float(value), unit, int(samples),
            None if interval is None else (float(interval[0]), float(interval[1])),
            note, bool(end_to_end), bool(headline),
            self.simulated if simulated is None else bool(simulated)))

    def estimate(self, name: str, units, statistic: Callable, unit: str, note: str = '',
                 **more) -> Tuple[float, Tuple[float, float]]:
        """A figure with its interval: statistic(all values of the units), as statistics.bootstrap()
        takes them. Returns both. more: as of figure(); samples: default the number of units."""
        value = statistic(np.concatenate([np.atleast_1d(values) for values in units]))
        interval = statistics.bootstrap(units, statistic, self.seed)
        self.figure(name, value, unit, more.pop('samples', len(units)), interval, note, **more)
        return float(value), interval

    def share(self, name: str, successes: int, trials: int, note: str = '',
              **more) -> Tuple[float, Tuple[float, float]]:
        """A figure with its interval: the probability of a success [%]. Returns both. more: as of
        figure()."""
        value = 100.0 * successes / trials
        low, high = statistics.wilson(successes, trials)
        interval = 100.0 * low, 100.0 * high
        self.figure(name, value, '%', trials, interval, note, **more)
        return value, interval

    def table(self, name: str, columns: Sequence[Tuple[str, str]], rows: Iterable,
              caption: str = '', shown: Optional[bool] = None) -> None:
        """A table, also as a CSV file and a struct in the section's .mat. columns: (name, unit)
        each, under_scored; rows: numbers or strings, None if missing. shown: whether the report
        contains it or a link; default: if it is short."""
        check_name(name, [each.name for each in self.contents if isinstance(each, Table)])
        taken = []
        for column, _ in columns:
            check_name(column, taken)
            taken.append(column)
        rows = [list(row) for row in rows]
        if any(len(row) != len(columns) for row in rows):
            raise ValueError(f'table {name}: every row needs {len(columns)} cells')
        self.contents.append(Table(name, list(columns), rows, caption,
                                   len(rows) <= self.SHOWN_ROWS if shown is None else shown))

    def plot(self, name: str, figure, caption: str) -> None:
        """A matplotlib figure, also as an SVG file. It is closed."""
        check_name(name, [each.name for each in self.contents if isinstance(each, Plot)])
        import matplotlib
        import matplotlib.pyplot as plt
        text = io.StringIO()
        # Text stays text; equal figures give equal files.
        with matplotlib.rc_context({'svg.fonttype': 'none', 'svg.hashsalt': self.name + name}):
            figure.savefig(text, format='svg', bbox_inches='tight', metadata={'Date': None})
        plt.close(figure)
        self.contents.append(Plot(name, text.getvalue(), caption))


def check_name(name: str, taken: List[str]) -> None:
    if not re.match(r'[A-Za-z][A-Za-z0-9_]*$', name):
        raise ValueError(f'{name!r} must be letters, digits and _, a letter first')
    if name in taken:
        raise ValueError(f'{name} is there twice')
