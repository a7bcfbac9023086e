"""Runs the sections of the evaluation and writes the report."""

import argparse
import os
import sys
import time
import traceback
from typing import List, Optional

from wiimote_tracker_bringup import ranges, rigs, stack
from wiimote_tracker_bringup.errors import ExperimentError
from wiimote_tracker_bringup.files import prepare
from wiimote_tracker_bringup.interruption import EXIT_STATUS, Interrupted, raise_when_interrupted
from wiimote_tracker_bringup.programs import package_file
from wiimote_tracker_evaluation import sections
from wiimote_tracker_evaluation.progress import Progress
from wiimote_tracker_evaluation.report import write_report
from wiimote_tracker_evaluation.section import Run

USED_BY = {'led': 'distance', 'gestures': 'ours', 'recordings': 'recordings', 'faults': 'faults'}
REPORT_FILES = ('report.html', 'report.md', 'figures.json')


def parse(arguments: Optional[List[str]]) -> argparse.Namespace:
    names = sections.names()
    parser = argparse.ArgumentParser(
        prog='evaluate', description="The paper's evaluation, on the simulated rig or, with --live, "
        'on a real one; writes report.html, report.md, figures.json, tables and plots.')
    parser.add_argument('--rig', metavar='FILE',
                        help="description of the rig (default: that of the paper's Fig. 1)")
    parser.add_argument('--led', metavar='FILE',
                        help='description of your own LED, for the section distance')
    parser.add_argument('--gestures', metavar='DIR',
                        help='recordings of your own gestures, for the section ours: a folder per '
                             'person with a CSV per gesture')
    parser.add_argument('--recordings', metavar='DIR',
                        help='recordings that others made, a folder each, for the section '
                             'recordings')
    parser.add_argument('--faults', metavar='FILE',
                        help='what fault_matrix --json wrote, for the section faults')
    parser.add_argument('--sections', metavar='A,B',
                        help=f"only these of: {', '.join(names)}")
    parser.add_argument('--quick', action='store_true',
                        help='fewer repetitions; takes two minutes, not a quarter of an hour')
    parser.add_argument('--live', action='store_true',
                        help='measure a running tracker, with prompts for a person')
    parser.add_argument('--output', metavar='DIR', default='wiimote_tracker_evaluation',
                        help='folder for the results (default: ./wiimote_tracker_evaluation)')
    parser.add_argument('--seed', type=ranges.within(0, 2 ** 31 - 1, int), default=1,
                        help='of all random numbers (default: 1)')
    options = parser.parse_args(arguments)
    options.rig = options.rig or package_file('simulation/paper_rig.yaml')
    chosen = options.sections.split(',') if options.sections is not None else [
        name for name in names
        if name not in ('recordings', 'faults') or getattr(options, name)]
    for name in chosen:
        if name not in names:
            parser.error(f"there is no section {name!r}; choose from {', '.join(names)}")
    for option, section in USED_BY.items():
        if options.sections is not None and getattr(options, option) and section not in chosen:
            parser.error(f'--{option} is for the section {section}, which is not chosen: leave it '
                         'out, or choose that section, too')
    options.sections = [name for name in names if name in chosen]
    if options.live:
        measured = [name for name in names if hasattr(sections.load(name), 'live')]
        options.sections = [name for name in measured if name in chosen]
        if not options.sections:
            parser.error('%s cannot be measured live; choose from %s'
                         % (', '.join(chosen), ', '.join(measured)))
    check_files(parser, options)
    return options


def check_files(parser: argparse.ArgumentParser, options: argparse.Namespace) -> None:
    """Refuses what cannot be used; makes the paths of rig and output absolute."""
    if not os.path.isfile(options.rig):
        parser.error(f'there is no rig description {options.rig}')
    if not options.live and not rigs.is_description(options.rig):
        parser.error(f'{options.rig} describes no simulated rig, as simulation/paper_rig.yaml does: a '
                     'calibrated rig.yaml cannot be simulated')
    if options.led and not os.path.isfile(options.led):
        parser.error(f'there is no description of an LED {options.led}')
    if options.gestures and len(folders_in(options.gestures)) < 2:
        parser.error(f'{options.gestures} needs folders of at least two people: each person is '
                     "recognised by the others' drawings")
    if 'recordings' in options.sections and not options.recordings:
        parser.error('the section recordings needs --recordings DIR')
    if 'faults' in options.sections and not options.faults:
        parser.error('the section faults needs --faults FILE')
    if options.recordings and not os.path.isdir(options.recordings):
        parser.error(f'there is no folder {options.recordings}')
    options.rig, options.output = os.path.abspath(options.rig), os.path.abspath(options.output)
    for given in (options.rig, options.led, options.gestures, options.recordings, options.faults):
        if given and is_replaced(given, options):
            parser.error(f'the results in {options.output} would replace {given}; choose another '
                         'folder with --output')


def is_replaced(path: str, options: argparse.Namespace) -> bool:
    """Whether a file or folder of the user is where a section's results go."""
    folders = [os.path.realpath(os.path.join(options.output, name)) for name in options.sections]
    return any(os.path.commonpath([folder, os.path.realpath(path)]) == folder for folder in folders)


def folders_in(folder: str) -> List[str]:
    return [entry for entry in os.scandir(folder) if entry.is_dir()] if os.path.isdir(folder) else []


def carry_out(module, run, live):
    """Runs a section and records its failure; empty: none."""
    try:
        (module.live if live else module.run)(run)
        run.failure = ''
    except Exception as error:  # other sections continue
        kind = '' if isinstance(error, ExperimentError) else f'{type(error).__name__}: '
        run.failure = f'{kind}{error}{stack.complaint(run)}'
        with open(run.file('failure.txt'), 'w') as file:
            traceback.print_exc(file=file)
    finally:
        stack.stop()


def evaluate(options: argparse.Namespace) -> int:
    """Runs the sections. Returns 0 if all succeeded."""
    modules = [sections.load(name) for name in options.sections]
    prepare(options.output, [*REPORT_FILES, *(module.NAME for module in modules)])
    progress = Progress([sections.seconds(module.NAME, options.quick) for module in modules])
    begin, runs = time.time(), []
    try:
        for module in modules:
            run = Run(module.NAME, module.TITLE, options.rig,
                      os.path.join(options.output, module.NAME), options.quick, options.seed,
                      not options.live, progress.within, options.led, options.gestures,
                      options.recordings, options.faults)
            runs.append(run)
            run.failure = 'It was interrupted.'  # unless it comes to an end
            progress.begin(module.TITLE)
            started = time.monotonic()
            try:
                carry_out(module, run, options.live)
            finally:
                run.duration = time.monotonic() - started
                write_report(options, runs, time.time() - begin)
            progress.end('failed: ' + run.failure if run.failure else 'done')
    except Interrupted:
        progress.line('Interrupted; the report contains the results so far.')
        progress.line(os.path.join(options.output, 'report.html'))
        return EXIT_STATUS
    finally:
        stack.stop_all()
    failed = [run.name for run in runs if run.failure]
    progress.line(os.path.join(options.output, 'report.html'))
    if failed:
        progress.line(f"Failed: {', '.join(failed)}; the report says why.")
    return 1 if failed else 0


def main(arguments: Optional[List[str]] = None) -> int:
    options = parse(arguments)
    raise_when_interrupted()
    try:
        return evaluate(options)
    except Interrupted:
        return EXIT_STATUS
    except ExperimentError as error:
        print(error, file=sys.stderr)
        return 1
