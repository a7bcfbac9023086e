"""Programs and files of packages: finding and running programs, and reading their tables."""

import collections
import os
import signal
import subprocess
import time
from typing import Dict

import numpy as np

from wiimote_tracker_bringup.errors import Refusal
from wiimote_tracker_bringup.processes import spawn

AT_ONCE = 2


def package_file(path: str) -> str:
    """A file of this package, in the source, devel or install space."""
    import rospkg
    return os.path.join(rospkg.RosPack().get_path('wiimote_tracker_bringup'), path)


def version() -> str:
    import rospkg
    return rospkg.RosPack().get_manifest('wiimote_tracker_bringup').version


def find_program(name: str) -> str:
    """Path of 'program', of this package, or of 'package/program'."""
    import roslib.packages
    package, _, program = name.rpartition('/')
    package = package or 'wiimote_tracker_bringup'
    found = roslib.packages.find_node(package, program)
    if not found:
        raise Refusal(f'the program {program} of {package} is not there; build and source '
                      'the workspace')
    return found[0]


def run(program, *arguments):
    """Runs a program, named as for find_program. @raise Refusal with its own words."""
    done = subprocess.run([find_program(program)] + [str(word) for word in arguments],
                          capture_output=True, text=True)
    if done.returncode != 0:
        raise Refusal(done.stderr.strip() or f'{program} failed')


def run_programs(commands, log, progress=lambda done, of: None):
    """Runs all commands (lists of words, the first as for find_program) and waits for them.

    log: file for their output. progress: called with the number of finished ones.
    @raise Refusal: one has failed; the others are ended.
    """
    waiting = collections.deque([find_program(command[0])] + [str(word) for word in command[1:]]
                                for command in commands)
    of, running = len(waiting), []
    try:
        while waiting or running:
            while waiting and len(running) < AT_ONCE:
                running.append(spawn(waiting.popleft(), log))
            time.sleep(0.02)
            for process in [each for each in running if each.poll() is not None]:
                running.remove(process)
                if process.returncode != 0:
                    raise Refusal(f'{os.path.basename(process.args[0])} failed (status '
                                  f'{process.returncode}): {last_line(log)}')
                progress(of - len(waiting) - len(running), of)
    finally:
        for process in running:
            process.send_signal(signal.SIGKILL)
            process.wait()


def last_line(path: str) -> str:
    with open(path, errors='replace') as file:
        lines = [line.strip() for line in file if line.strip()]
    return lines[-1] if lines else 'it said nothing'


def read_csv(path: str) -> Dict[str, np.ndarray]:
    """A table with names in its first line, as arrays by name: numbers if all are, else strings."""
    import csv
    with open(path, newline='') as file:
        rows = list(csv.reader(file))
    if not rows:
        raise Refusal(f'{path} is empty')
    columns = {}
    for name, texts in zip(rows[0], zip(*rows[1:]) if len(rows) > 1 else [()] * len(rows[0])):
        try:
            columns[name] = np.array(texts, dtype=float)
        except ValueError:
            columns[name] = np.array(texts)
    return columns


def table_rows(columns):
    """Rows for Run.table(): None for a missing number, integers in columns of integers."""
    cells = []
    for values in columns.values():
        if values.dtype.kind == 'f' and np.array_equal(values, np.round(values)):
            values = values.astype(int)
        cells.append([None if value != value else value for value in values.tolist()])
    return list(zip(*cells))
