"""Confusion of gestures, of simulated people or of the user's recordings."""

import argparse
import os

import numpy as np

from wiimote_tracker_bringup import charts, programs
from wiimote_tracker_bringup.files import read_json
from wiimote_tracker_evaluation.sections.ours import people

EXAMPLES = 2
QUICK, FULL = 10, 40  # simulated people


def folder_of_people(path):
    if not os.path.isdir(path) or sum(entry.is_dir() for entry in os.scandir(path)) < 2:
        raise argparse.ArgumentTypeError(f'{path} needs folders of at least two people: each '
                                         "person is recognised by the others' drawings")
    return path


def tell(run):
    result = recognised(run)
    names, confusion = result['gestures'], np.array(result['confusion'])
    tested, right = int(confusion.sum()), int(np.trace(confusion))
    if run.options.gestures:
        run.say(
            '### Gestures\n\n'
            'Your own recordings (`--gestures`), measured, not simulated: %d drawings of %d '
            'gestures, each recognised by the drawings of the other people (at most %d examples of '
            'all gestures together).' % (tested, len(names), result['examples']))
        note = 'Gestures of your own recordings recognised, by examples of other people'
    else:
        run.say(
            '### Gestures\n\n'
            'Twelve gestures, drawn with an LED by simulated people of different size, slant, '
            'roundness and pace, located to %.0f mm, and recognised by %d examples of other '
            'people. **The people are simulated**; `--gestures DIR` uses recordings of real ones.'
            % (1e3 * people.NOISE, EXAMPLES))
        note = 'Gestures of made-up people recognised, %d examples each by others' % EXAMPLES
    draw(run, names, confusion)
    run.table('confusion', [('drawn', '')] + [('as_%d' % (i + 1), '') for i in range(len(names))],
              [[name] + row.tolist() for name, row in zip(names, confusion)],
              'Rows: drawn. Columns: recognised, in the same order.', shown=False)
    for name, count, words in (
            ('right', right, note),
            ('rejected', result['rejected'],
             'Of the same drawings, rejected as no gesture at all')):
        run.share('gestures_' + name, count, tested, words, simulated=not run.options.gestures)


def recognised(run):
    """Result of gesture_tool: each person is recognised by the others' examples."""
    folder = run.options.gestures
    if not folder:
        folder = run.file('drawings')
        people.write(folder, QUICK if run.quick else FULL, run.seed)
    programs.run_programs([['wiimote_tracker_triangulation/gesture_tool', 'evaluate', '--train',
                            folder, '--test', folder, '--json', run.file('gestures.json')]
                           + ([] if run.options.gestures else ['--examples', EXAMPLES])],
                          run.file('programs.log'))
    return read_json(run.file('gestures.json'))


def draw(run, names, confusion):
    size = 1.4 + 0.27 * len(names)
    figure, axes = charts.figure(height=size, width=size + 1.6)
    share = confusion / np.maximum(confusion.sum(axis=1, keepdims=True), 1)
    axes.imshow(share, cmap='Blues', vmin=0.0, vmax=1.0)
    for row, column in zip(*np.nonzero(confusion)):
        axes.text(column, row, '%d' % confusion[row, column], ha='center', va='center', fontsize=8,
                  color='white' if share[row, column] > 0.5 else charts.INK)
    axes.set_xticks(range(len(names)))
    axes.set_xticklabels(names, rotation=45, ha='right')
    axes.set(yticks=range(len(names)), yticklabels=names)
    axes.set(xlabel='recognised', ylabel='drawn')
    axes.grid(False)
    run.plot('gestures', figure, 'Confusion matrix (numbers of drawings).')
