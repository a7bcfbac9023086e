"""The ten points: a person puts the LED there."""

import numpy as np

from wiimote_tracker_bringup import charts, experiment, statistics
from wiimote_tracker_evaluation.live.running_tracker import STILL_TIME, with_tracker

FLOOR, AIR = 0.01, 0.03  # the paper's largest placement errors [m]
PAPER_LIMIT = 3.0         # its accuracy [cm]


def targets(side, up):
    """The paper's ten points in a cube of this side [m]; up: 1 or -1, sign of z."""
    return experiment.TEST_POINTS / experiment.SIDE * side * [1.0, 1.0, up]


@with_tracker
def live(run, tracker, dialogue):
    points = targets(tracker.side(), tracker.up())
    tracker.wait_for_points()
    dialogue.line('Take one LED to ten places, one after the other, and hold it still until the '
                  'next one is named (s and Enter: skip it).')
    rows, before = [], None
    for number, target in enumerate(points):
        dialogue.line('   %2d  Put the LED at x = %.3f m, y = %.3f m, z = %.3f m.'
                      % ((number + 1,) + tuple(target)))
        place = tracker.still(dialogue, before)
        if place is None:
            continue
        before = place.position
        error = float(np.linalg.norm(place.position - target))
        dialogue.line('       measured %.3f, %.3f, %.3f: %.1f cm off'
                      % (tuple(place.position) + (100.0 * error,)))
        rows.append([number + 1] + list(target) + list(1e3 * (place.position - target)) +
                    [1e3 * error, 1e3 * place.scatter, place.points])
    tell(run, rows, len(points))


def tell(run, rows, of):
    run.say('A person has put the LED at %d of the %d points and held it still; the measurement is '
            'the mean over %.1f s. The errors include those of placing the LED, which the paper '
            'states as at most %.0f cm on the floor and %.0f cm above.'
            % (len(rows), of, STILL_TIME, 100 * FLOOR, 100 * AIR))
    run.table('places', [('point', ''), ('x', 'm'), ('y', 'm'), ('z', 'm'), ('error_x', 'mm'),
                         ('error_y', 'mm'), ('error_z', 'mm'), ('error', 'mm'),
                         ('scatter', 'mm'), ('points', '')], rows)
    if len(rows) < 2:
        run.say('Fewer than two places were measured: there are no figures.')
        return
    errors = np.array([row[7] for row in rows])
    run.estimate('live_rms', errors, statistics.rms, 'mm', 'RMS error over the points',
                 end_to_end=True)
    run.figure('live_largest', np.max(errors), 'mm', len(errors),
               note='Largest error over the points', end_to_end=True)
    figure, axes = charts.figure()
    charts.cumulative(axes, errors / 10.0, charts.BLUE)
    axes.axvline(PAPER_LIMIT, color=charts.SOFT, linestyle='--')
    axes.text(1.05 * PAPER_LIMIT, 0.5, f"the paper's\n{PAPER_LIMIT:g} cm")
    axes.set_xlim(min(0.1, 0.1 * errors.min()), max(10.0, 0.2 * errors.max()))
    charts.log_axis(axes, 'x', [tick for tick in (0.01, 0.1, 1.0, 10.0, 100.0)
                                if axes.get_xlim()[0] <= tick <= axes.get_xlim()[1]], minor=True)
    axes.set(xlabel='error [cm]', ylabel='share of the points')
    run.plot('places', figure, 'Cumulative distribution of the errors.')
    run.summary('The ten points by hand: RMS error %.1f mm, largest %.1f mm (%d points).'
                % (statistics.rms(errors), errors.max(), len(errors)))
