"""Runs the sections of the evaluation and writes the report."""

import argparse
import os
import time
import traceback
from typing import List, Optional

from wiimote_tracker_bringup import descriptions, ranges, stack
from wiimote_tracker_bringup.errors import Refusal
from wiimote_tracker_bringup.files import existing_file, prepare
from wiimote_tracker_bringup.interruption import answered, raise_when_interrupted
from wiimote_tracker_bringup.programs import package_file
from wiimote_tracker_evaluation import sections
from wiimote_tracker_evaluation.progress import Progress
from wiimote_tracker_evaluation.report import write_report
from wiimote_tracker_evaluation.section import Run


def parse(arguments: Optional[List[str]]) -> argparse.Namespace:
    modules = {name: sections.load(name) for name in sections.NAMES}
    own = {name: module.OPTION for name, module in modules.items() if hasattr(module, 'OPTION')}
    parser = argparse.ArgumentParser(
        prog='evaluate',
        description="The paper's evaluation, on the simulated rig or, with --live, on a real one; "
        'writes report.html, report.md, figures.json, tables and plots.')
    for section, option in own.items():
        parser.add_argument('--' + option.name, metavar=option.metavar, type=option.kind,
                            help=f'{option.explanation}, for the section {section}')
    parser.add_argument('--rig', metavar='FILE', type=existing_file,
                        help="description of the rig (default: that of the paper's Fig. 1)")
    parser.add_argument('--sections', metavar='A,B',
                        help=f"only these of: {', '.join(modules)}")
    parser.add_argument('--quick', action='store_true',
                        help='fewer repetitions; takes three minutes, not half an hour')
    parser.add_argument('--live', action='store_true',
                        help='measure a running tracker, with prompts for a person')
    parser.add_argument('--output', metavar='DIR', default='wiimote_tracker_evaluation',
                        help='folder for the results (default: ./wiimote_tracker_evaluation)')
    parser.add_argument('--seed', type=ranges.within(0, 2 ** 31 - 1, int), default=1,
                        help='of all random numbers (default: 1)')
    options = parser.parse_args(arguments)
    options.rig = options.rig or package_file('simulation/paper_rig.yaml')
    choose_sections(parser, options, modules, own)
    check_files(parser, options, [options.rig] + [getattr(options, option.name)
                                                  for option in own.values()])
    return options


def choose_sections(parser, options, modules, own) -> None:
    """Replaces options.sections by a list. modules: by section. own: the Option of a section."""
    given = {section: getattr(options, option.name) for section, option in own.items()}
    lacking = [section for section, option in own.items()
               if option.is_needed and not given[section]]
    chosen = options.sections.split(',') if options.sections is not None else [
        name for name in modules if name not in lacking]
    for name in chosen:
        if name not in modules:
            parser.error(f"there is no section {name!r}; choose from {', '.join(modules)}")
        if name in lacking:
            parser.error(f'the section {name} needs --{own[name].name}')
    for section, value in given.items():
        if value and section not in chosen:
            parser.error(f'--{own[section].name} is for the section {section}, which is not '
                         'chosen: leave it out, or choose that section, too')
    options.sections = [name for name in modules if name in chosen]
    if options.live:
        measured = [name for name, module in modules.items() if hasattr(module, 'live')]
        options.sections = [name for name in measured if name in chosen]
        if not options.sections:
            parser.error('%s cannot be measured live; choose from %s'
                         % (', '.join(chosen), ', '.join(measured)))


def check_files(parser: argparse.ArgumentParser, options: argparse.Namespace, to_read) -> None:
    """Refuses what cannot be used; makes the paths of rig and output absolute."""
    if not options.live and not descriptions.is_description(options.rig):
        parser.error(f'{options.rig} describes no simulated rig, as simulation/paper_rig.yaml '
                     'does: a calibrated rig.yaml cannot be simulated')
    options.rig, options.output = os.path.abspath(options.rig), os.path.abspath(options.output)
    for path in filter(None, to_read):
        if is_replaced(path, options):
            parser.error(f'the results in {options.output} would replace {path}; choose another '
                         'folder with --output')


def is_replaced(path: str, options: argparse.Namespace) -> bool:
    """Whether a file or folder of the user is where a section's results go."""
    folders = [os.path.realpath(os.path.join(options.output, name)) for name in options.sections]
    return any(os.path.commonpath([folder, os.path.realpath(path)]) == folder for folder in folders)


def carry_out(module, run, live):
    """Runs a section and records its failure; empty: none."""
    try:
        (module.live if live else module.run)(run)
        run.failure = ''
    except Exception as error:  # other sections continue
        kind = '' if isinstance(error, Refusal) else f'{type(error).__name__}: '
        run.failure = f'{kind}{error}{stack.complaint(run.folder)}'
        with open(run.file('failure.txt'), 'w') as file:
            traceback.print_exc(file=file)
    finally:
        stack.stop()


def evaluate(options: argparse.Namespace) -> int:
    """Runs the sections. Returns 0 if all succeeded. After an interruption the report has the
    results so far."""
    modules = {name: sections.load(name) for name in options.sections}
    prepare(options.output, ['report.html', 'report.md', *options.sections], 'figures.json')
    progress = Progress([module.SECONDS[not options.quick] for module in modules.values()])
    begin, runs = time.time(), []
    try:
        for name, module in modules.items():
            run = Run(name, module.TITLE, os.path.join(options.output, name), options,
                      progress.within)
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
    finally:
        stack.stop_all()
        progress.line(os.path.join(options.output, 'report.html'))
    failed = [run.name for run in runs if run.failure]
    if failed:
        progress.line(f"Failed: {', '.join(failed)}; the report says why.")
    return 1 if failed else 0


def main(arguments: Optional[List[str]] = None) -> int:
    options = parse(arguments)
    raise_when_interrupted()
    with answered('evaluate'):
        return evaluate(options)
