"""Recordings that others made: errors against their truth, or of pixels that were held out."""

import os
import re

import numpy as np

from wiimote_tracker_bringup import charts, statistics
from wiimote_tracker_bringup.files import existing_folder
from wiimote_tracker_evaluation.report import words
from wiimote_tracker_evaluation.section import Option

TITLE = 'Recordings by others'
SECONDS = 60, 60
OPTION = Option('recordings', 'DIR', existing_folder,
                'recordings that others made, a folder each', is_needed=True)

PARTS = 10  # of a recording, taken as independent
# Columns of the figures of a path, and of predicted pixels: name, unit, key, factor.
PATHS = (('mean', 'mm', 'mean_mm', 1.0), ('rms', 'mm', 'rms_mm', 1.0), ('p95', 'mm', 'p95_mm', 1.0),
         ('largest', 'mm', 'largest_mm', 1.0), ('coverage', '%', 'coverage_95', 100.0),
         ('nees', '', 'nees', 1.0), ('tracked', '%', 'tracked', 100.0), ('gaps', '', 'gaps', 1.0))
PIXELS = (('median', 'px', 'median', 1.0), ('mean', 'px', 'mean', 1.0), ('rms', 'px', 'rms', 1.0),
          ('p95', 'px', 'p95', 1.0), ('within_5_px', '', 'inliers', 1.0),
          ('observations', '', 'observations', 1.0))


def run(run):
    from wiimote_tracker_evaluation.recordings import formats  # with rospy, see stack.master()
    run.simulated = False
    own = os.path.abspath(run.options.recordings)
    found, outcomes = formats.found_in(own), {}
    for number, (path, name) in enumerate(found.items()):
        title = os.path.relpath(path, own) if path != own else os.path.basename(own)
        run.progress(number, len(found), title)
        outcomes[title] = formats.measure(name, path)
    run.say('Nothing here is simulated. Neither a truth nor shipped poses enter the path: the '
            'cameras are calibrated from what they saw alone.')
    for kind, unit, columns, caption in (
            ('paths', 'mm', PATHS, 'Error of a tracked path after a similarity, fitted on other '
             'parts of the recording. Coverage: of the 95 % ellipsoids; the ideal NEES is 3.'),
            ('pixels', 'px', PIXELS, 'Pixels of frames that took no part in the calibration, '
             'predicted from what the other cameras saw.')):
        chosen = {title: each for title, each in outcomes.items() if each.unit == unit}
        if chosen:
            run.table(kind, [('recording', ''), ('of', '')] + [
                (name, its) for name, its, _, _ in columns], [
                [title, what] + [factor * figures[key] for _, _, key, factor in columns]
                for title, each in chosen.items()
                for what, figures in each.scores.items()], caption)
    for title, outcome in outcomes.items():
        tell(run, title, outcome)
    means = [each.result['mean_mm'] for each in outcomes.values() if each.unit == 'mm']
    if means:
        run.summary(f'**Recordings by others**, real: mean error of {len(means)} paths with a '
                    f'truth {min(means):.1f} to {max(means):.1f} mm.')


def name_of(title):
    """As figures may be named, and short enough for MATLAB with an ending."""
    name = re.sub(r'[^A-Za-z0-9_]+', '_', title)[-45:]
    return name if name[0].isalpha() else 'recording_' + name


def drawing(outcome):
    """The errors one by one and as a distribution."""
    figure, (left, right) = charts.figure(1, 2, height=2.8)
    left.plot(outcome.places, outcome.errors, '.', markersize=2.0, color=charts.BLUE)
    left.set(xlabel=outcome.axis, ylabel=f'error [{outcome.unit}]')
    charts.cumulative(right, outcome.errors, charts.BLUE)
    right.set(xlabel=f'error [{outcome.unit}]', ylabel='share of points')
    return figure


def tell(run, title, outcome):
    name = name_of(title)
    heading = words.escaped(title)
    run.say(f'### {heading}\n\n{outcome.method}.\n\n' + '\n'.join(
        f'- {row}: {value}' for row, value in outcome.rows))
    run.plot('errors_of_' + name, drawing(outcome), f'Errors of {heading}.')
    statistic, word = (np.mean, 'mean') if outcome.unit == 'mm' else (np.median, 'median')
    in_order = outcome.errors[np.argsort(outcome.places, kind='stable')]
    run.estimate(f'{name}_{word}', statistics.blocks(in_order, PARTS), statistic, outcome.unit,
                 f'{word} error of {"the path" if outcome.unit == "mm" else "predicted pixels"}, '
                 f'{title}', samples=len(in_order), headline=True)
    if 'tracked' in outcome.result:
        run.figure(f'{name}_tracked', 100.0 * outcome.result['tracked'], '%', len(in_order),
                   note=f'tracked while in sight, {title}')
