"""Long tables of measurements, by column."""

import glob
import os

import numpy as np

from wiimote_tracker_evaluation import programs

UNITS = {'_mm': 'mm', '_m': 'm', '_m_per_s': 'm/s', '_rad_per_s': 'rad/s', '_deg': 'deg', '_ms': 'ms',
         '_s': 's'}


def shared(run, program, sessions, *options):
    """Commands that share the sessions of a program between two processes; see read_shared."""
    first = (sessions + 1) // 2
    return [[program, '--rig', run.rig, '--output', part_file(run, program, part), '--seed', run.seed,
             '--sessions', number, '--first', begin] + list(options)
            for part, (begin, number) in enumerate(((0, first), (first, sessions - first))) if number]


def part_file(run, program, part):
    return run.file('%s_%d.csv' % (program, part))


def read_shared(run, program):
    """Their tables joined, by column."""
    paths = sorted(glob.glob(run.file(program + '_*.csv')))
    parts = [programs.read_csv(path) for path in paths]
    columns = {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
    for path in paths:
        os.remove(path)
    return columns


def keep(run, program, columns, caption):
    """Copies the result of read_shared() to the report's folder."""
    run.table(program.replace('evaluate_', ''), [name_and_unit(name) for name in columns],
              programs.table_rows(columns), caption, shown=False)


def name_and_unit(name):
    """('speed', 'm/s') of speed_m_per_s."""
    fits = [ending for ending in UNITS if name.endswith(ending)]
    if not fits:
        return name, ''
    ending = max(fits, key=len)
    return name[:-len(ending)], UNITS[ending]


def where(columns, **values):
    """Mask of the rows with these values."""
    chosen = np.ones(len(next(iter(columns.values()))), dtype=bool)
    for name, value in values.items():
        chosen &= columns[name] == value
    return chosen


def per_session(columns, name, chosen):
    """Finite values of a column, one array per session: the independent units."""
    units = [columns[name][chosen & (columns['session'] == session)]
             for session in np.unique(columns['session'])]
    return [unit[np.isfinite(unit)] for unit in units if np.isfinite(unit).any()]
