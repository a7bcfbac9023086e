"""Runs the faults and writes the table."""

import argparse
import dataclasses
import subprocess
from typing import List, Optional

from wiimote_tracker_bringup.errors import Refusal
from wiimote_tracker_bringup.files import write_json
from wiimote_tracker_bringup.interruption import answered, raise_when_interrupted
from wiimote_tracker_bringup.processes import Processes
from wiimote_tracker_evaluation.faults import (
    of_files, of_images, of_load, of_master, of_messages, of_network, of_processes, of_time,
    of_types)
from wiimote_tracker_evaluation.faults.fault import Fault, Result, carry_out
from wiimote_tracker_evaluation.faults.room import Room

FAULTS = [each for module in (of_processes, of_messages, of_types, of_files, of_images, of_time,
                              of_load, of_network, of_master)
          for each in [*vars(module).values(), *getattr(module, 'FAULTS', ())]
          if isinstance(each, Fault)]
HEAD = '%-28s %-22s %-22s %-22s %9s  %s' % (
    'fault', 'before: Hz, mm', 'during', 'after', 'recovery', 'problems')


def parse(arguments: Optional[List[str]]) -> argparse.Namespace:
    names = [fault.name for fault in FAULTS]
    parser = argparse.ArgumentParser(
        prog='fault_matrix', description='Causes faults on the simulated rig, and compares what '
        'the tracker publishes before, during and after each with the truth. Takes a quarter of an '
        'hour.')
    parser.add_argument('--quick', action='store_true', help='few faults; takes two minutes')
    parser.add_argument('--json', metavar='FILE', help='writes all figures to this file')
    parser.add_argument('--faults', metavar='A,B', help=f"only these of: {', '.join(names)}")
    parser.add_argument('--log', metavar='FILE', help="appends the nodes' output to this file")
    options = parser.parse_args(arguments)
    chosen = options.faults.split(',') if options.faults else [
        fault.name for fault in FAULTS if fault.quick or not options.quick]
    for name in chosen:
        if name not in names:
            parser.error(f"there is no fault {name!r}; choose from {', '.join(names)}")
    for path in filter(None, (options.json, options.log)):
        try:
            with open(path, 'a'):
                pass
        except OSError as error:  # better now than after some minutes
            parser.error(f'cannot write to {path}: {error.strerror}')
    options.chosen = [fault for fault in FAULTS if fault.name in chosen]
    # Faults of one kind of room run one after the other, and those that spend it last.
    options.chosen.sort(key=lambda fault: (str(fault.room), fault.spends_room))
    return options


class Matrix:
    def __init__(self, log):
        self._processes = Processes()
        self._log = log
        self._room = None
        self._kind = None

    def run(self, fault) -> Result:
        """Carries out a fault, in the room of the one before if that is still good."""
        try:
            if self._room is None or fault.room != self._kind:
                self._close()
                self._kind, self._room = fault.room, Room(self._processes, **fault.room)
            self._room.wait_until_tracked()
            result = carry_out(fault, self._room)
        except (Refusal, OSError, subprocess.SubprocessError, EOFError) as error:
            result = Result(fault.name, fault.what, problems=[str(error) or type(error).__name__])
        if result.problems or fault.spends_room:
            self._close()
        return result

    def _close(self):
        if self._room is None:
            return
        if self._log:
            with open(self._room.log, 'rb') as nodes, open(self._log, 'ab') as log:
                log.write(nodes.read())
        self._room.stop()
        self._room = None

    def stop(self):
        self._close()
        self._processes.stop_all()


def cell(figures) -> str:
    if figures is None:
        return '-'
    if not figures.number:
        return '0'
    return '%.0f, %.1f (95 %%: %.1f)' % (figures.rate, 1e3 * figures.error, 1e3 * figures.error_95)


def line(result: Result) -> str:
    recovery = '-' if result.recovery is None else f'{result.recovery:.1f} s'
    return '%-28s %-22s %-22s %-22s %9s  %s' % (
        result.name, cell(result.before), cell(result.during), cell(result.after), recovery,
        '; '.join(result.problems) or 'none')


def main(arguments: Optional[List[str]] = None) -> int:
    options = parse(arguments)
    raise_when_interrupted()
    results = []
    with answered('fault_matrix'):
        matrix = Matrix(options.log)
        try:
            print(HEAD)
            for fault in options.chosen:
                why_not = fault.why_not()
                if why_not:
                    print(f'{fault.name:28} left out: {why_not}')
                    continue
                results.append(matrix.run(fault))
                print(line(results[-1]), flush=True)
        finally:
            matrix.stop()
            write_json(options.json, list(map(dataclasses.asdict, results)))
    failed = [result.name for result in results if result.problems]
    print(f'{len(results) - len(failed)} of {len(results)} faults were survived'
          + (f"; not: {', '.join(failed)}" if failed else ''))
    return 1 if failed else 0
