"""Gestures: which is taken for which."""

import json

import numpy as np

from wiimote_tracker_evaluation import charts, programs, statistics

PROGRAM, EXAMPLES = 'evaluate_gestures', 2


def commands(run):
    return [[PROGRAM, '--rig', run.rig, '--output', run.file('drawings'), '--seed', run.seed,
             '--sessions', 10 if run.quick else 40]]


def tell(run):
    programs.run_programs([['wiimote_tracker_triangulation/gesture_tool', 'evaluate', '--train',
                            run.file('drawings'), '--test', run.file('drawings'), '--examples',
                            str(EXAMPLES), '--json', run.file('gestures.json')]],
                          run.file('programs.log'))
    with open(run.file('gestures.json')) as file:
        result = json.load(file)
    names, confusion = result['gestures'], np.array(result['confusion'])
    tested, right = int(confusion.sum()), int(np.trace(confusion))
    run.say(
        '### Gestures\n\n'
        'Twelve gestures, drawn with an LED by made-up people of different size, slant, roundness and '
        'pace, tracked, and recognised from %d examples by other people. **The people are made up**; '
        'with recordings of real ones `gesture_tool evaluate` does the same '
        '(`wiimote_tracker_triangulation/doc/gestures.md`).' % EXAMPLES)
    figure, axes = charts.figure(height=4.6, width=6.2)
    share = confusion / np.maximum(confusion.sum(axis=1, keepdims=True), 1)
    axes.imshow(share, cmap='Blues', vmin=0.0, vmax=1.0)
    for row, column in zip(*np.nonzero(confusion)):
        axes.text(column, row, '%d' % confusion[row, column], ha='center', va='center', fontsize=8,
                  color='white' if share[row, column] > 0.5 else charts.INK)
    axes.set_xticks(range(len(names)))
    axes.set_xticklabels(names, rotation=45, ha='right')
    axes.set_yticks(range(len(names)))
    axes.set_yticklabels(names)
    axes.set_xlabel('recognised')
    axes.set_ylabel('drawn')
    axes.grid(False)
    run.plot('gestures', figure, 'Which gesture was taken for which.')
    run.table('confusion', [('drawn', '')] + [(name, '') for name in names],
              [[name] + row.tolist() for name, row in zip(names, confusion)], 'Rows: drawn.', shown=False)
    low, high = statistics.wilson(right, tested)
    run.figure('gestures_right', 100.0 * right / tested, '%', tested, (100.0 * low, 100.0 * high),
               'Gestures of made-up people recognised, %d examples each by others' % EXAMPLES)
