"""Makes a document's results table from figures.json, and compares it with a fresh run."""

import argparse
import json
import sys
import types
from typing import Dict, List, Optional, Tuple

import numpy as np

from wiimote_tracker_bringup import statistics
from wiimote_tracker_bringup.errors import ExperimentError, sentence_of
from wiimote_tracker_evaluation.report import words

Measurement = Tuple[float, Tuple[float, float]]  # value, its 95 % interval
ROUNDING = 0.005  # relative, of the table's three digits
BEGIN, END = '<!-- results: begin -->', '<!-- results: end -->'


def cells(entry: Dict) -> List[str]:
    description, value, interval, _, kind = words.cells(types.SimpleNamespace(**entry))
    return [description.replace('|', '/'), value, interval or '–', kind]


def headlines(content: Dict) -> List[Dict]:
    entries = [entry for entry in content['figures'] if entry['headline']]
    if not entries:
        raise ExperimentError('figures.json has no headline; run evaluate with all sections')
    return entries


def origin(content: Dict) -> str:
    if not any(entry['simulated'] for entry in headlines(content)):
        return 'By `rosrun wiimote_tracker_bringup evaluate --sections recordings --recordings DIR`.'
    return 'By `rosrun wiimote_tracker_bringup evaluate%s --seed %d`, rig `%s`.' % (
        ' --quick' if content['quick'] else '', content['seed'], content['rig']) + (
        ' *Full stack* runs in real time: these numbers depend on the machine and on what else it '
        'does, and their intervals are of that run alone.')


def lines(content: Dict) -> List[str]:
    return (['||value|95 % interval|how|', '|---|---|---|---|'] + [
        '|' + '|'.join(cells(entry)) + '|' for entry in headlines(content)] + [
        '', origin(content)])


def split(text: str) -> Tuple[str, str, str]:
    """Text before, between and after the marks."""
    if text.count(BEGIN) != 1 or text.count(END) != 1 or text.index(BEGIN) > text.index(END):
        raise ExperimentError(f'the document needs the lines "{BEGIN}" and "{END}", once each')
    before, rest = text.split(BEGIN)
    between, after = rest.split(END)
    return before, between, after


def written(text: str, content: Dict) -> str:
    """The document's text with the table between its marks."""
    before, _, after = split(text)
    return before + BEGIN + '\n' + '\n'.join(lines(content)) + '\n' + END + after


def numbers_of(row: List[str]) -> Measurement:
    """Value and interval stated by a row of the table; without an interval the value twice."""
    value = float(row[1].split()[0])
    if row[2] == '–':
        return value, (value, value)
    low, _, high = row[2].split()
    return value, (float(low), float(high))


def rows_of(text: str) -> Dict[str, Measurement]:
    """Value and interval by the first cell of the table's rows."""
    stated = {}
    for line in split(text)[1].splitlines():
        row = [cell.strip() for cell in line.strip().strip('|').split('|')]
        if len(row) == 4 and row[0] and not set(row[0]) <= set('-'):
            stated[row[0]] = numbers_of(row)
    return stated


def too_far_apart(stated: Measurement, fresh: Measurement, allowed: float) -> bool:
    """Whether two measurements, each (value, (low, high)), differ by more than `allowed` times
    their combined half widths on the sides that face each other."""
    (low, (_, above)), (high, (below, _)) = sorted([stated, fresh])
    slack = ROUNDING * max(abs(low), abs(high))
    return high - low > allowed * np.hypot(above - low, high - below) + slack


def disagreements(text: str, content: Dict) -> Tuple[List[str], List[str]]:
    """Sentences about figures of a run that differ significantly from the table: of results in
    process, and of the full stack, which depend on the machine."""
    stated, entries = rows_of(text), headlines(content)
    allowed = statistics.agreement(len(entries))
    in_process, full_stack = [], []
    for entry in entries:
        name = cells(entry)[0]
        if name not in stated:
            in_process.append(f'{name}: not in the table')
            continue
        value, (low, high) = stated[name]
        fresh = entry['value'], tuple(entry['interval'] or (entry['value'], entry['value']))
        if too_far_apart((value, (low, high)), fresh, allowed):
            (full_stack if entry['end_to_end'] else in_process).append(
                '%s: the table says %s (%s … %s), this run %s (%s … %s) %s' % (
                    (name,) + tuple(words.number(v) for v in (
                        value, low, high, fresh[0]) + fresh[1]) + (entry['unit'],)))
    return in_process, full_stack


def read(path: str) -> Dict:
    """What an evaluation wrote."""
    with open(path, encoding='utf-8') as file:
        try:
            content = json.load(file)
        except ValueError:
            content = None
    if not isinstance(content, dict) or 'figures' not in content:
        raise ExperimentError(f'{path} is no figures.json: name one that evaluate wrote')
    return content


def main(arguments: Optional[List[str]] = None) -> int:
    parser = argparse.ArgumentParser(prog='results_table', description=__doc__)
    parser.add_argument('figures', help='figures.json of an evaluation')
    parser.add_argument('document', help='Markdown file with the two marks')
    parser.add_argument('--check', action='store_true',
                        help='write nothing; list the significant differences between the table '
                             'and the figures of a fresh run')
    options = parser.parse_args(arguments)
    try:
        content = read(options.figures)
        with open(options.document, encoding='utf-8') as file:
            text = file.read()
        if options.check:
            in_process, full_stack = disagreements(text, content)
            if full_stack:
                print('\n'.join(['Different, but of the full stack in real time, which depends on the '
                                 'machine:'] + full_stack))
            print('\n'.join(in_process) or (
                'All others agree.' if full_stack else 'The table agrees with these figures.'))
            return 1 if in_process else 0
        text = written(text, content)  # before the document is emptied: it may refuse
        with open(options.document, 'w', encoding='utf-8') as file:
            file.write(text)
    except (OSError, ValueError, ExperimentError) as error:
        print(sentence_of(error), file=sys.stderr)
        return 1
    return 0
