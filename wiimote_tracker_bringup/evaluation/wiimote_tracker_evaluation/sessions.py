"""Programs that simulate sessions, and the long tables that they write, by column."""

import glob
import os

import numpy as np

from wiimote_tracker_bringup import programs

UNITS = {'_mm': 'mm', '_m': 'm', '_m_per_s': 'm/s', '_ms': 'ms', '_s': 's'}


def parts_of(sessions, parts):
    """Divides sessions between programs that take --first and --sessions: (first, number) each."""
    edges = [sessions * part // parts for part in range(parts + 1)]
    return [(first, end - first) for first, end in zip(edges[:-1], edges[1:]) if end > first]


def shared(run, program, sessions, parts):
    """Commands that share the sessions of a program between processes; see read_shared."""
    return [[program, '--rig', run.rig, '--output', run.file(f'{program}_{first}.csv'), '--seed',
             run.seed, '--sessions', number, '--first', first]
            for first, number in parts_of(sessions, parts)]


def read_shared(run, program):
    """Their tables joined in order, by column."""
    paths = sorted(glob.glob(glob.escape(run.file(program)) + '_*.csv'),
                   key=lambda path: (len(path), path))
    tables = [programs.read_csv(path) for path in paths]
    for path in paths:  # repeated in a table of the section
        os.remove(path)
    return joined(tables)


def joined(tables):
    """Tables of the same columns, one below the other."""
    return {name: np.concatenate([table[name] for table in tables]) for name in tables[0]}


def simulate(run, program, sessions, parts, what):
    """Runs a program. Returns the table of its sessions. what: what it simulates, for the log."""
    run.compute(shared(run, program, sessions, parts), what, 0.0, 0.9)
    return read_shared(run, program)


def keep(run, name, columns, caption):
    """Adds a table of a program to the report's files."""
    run.table(name, [name_and_unit(column) for column in columns], programs.table_rows(columns),
              caption, shown=False)


def name_and_unit(name):
    """('speed', 'm/s') of speed_m_per_s; or the unit of a column that does not name it."""
    fits = [ending for ending in UNITS if name.endswith(ending)]
    if fits:
        ending = max(fits, key=len)
        return name[:-len(ending)], UNITS[ending]
    if name.startswith('var_'):
        return name, 'm^2'
    if name[-2:] in ('_u', '_v'):
        return name, 'px'
    if name[-2:] in ('_x', '_y', '_z') or name.endswith('_error'):
        return name, 'm'
    return name, {'speed': 'm/s', 'time': 's'}.get(name, '')


def where(columns, **values):
    """Mask of the rows with these values."""
    chosen = np.ones(len(next(iter(columns.values()))), dtype=bool)
    for name, value in values.items():
        chosen &= columns[name] == value
    return chosen


def by_session(columns, values):
    """A value of each row, one array per session: the independent units."""
    return [values[columns['session'] == session] for session in np.unique(columns['session'])]


def per_session(columns, name, chosen=True, **values):
    """Finite values of a column in the chosen rows with these values, by session that has any."""
    chosen = chosen & where(columns, **values) & np.isfinite(columns[name])
    return by_session({'session': columns['session'][chosen]}, columns[name][chosen])
