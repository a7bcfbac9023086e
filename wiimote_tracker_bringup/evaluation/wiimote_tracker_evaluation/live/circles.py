"""Circles: a person moves the LED on a circle."""

import time

import numpy as np

from wiimote_tracker_bringup import alignment, charts, statistics
from wiimote_tracker_evaluation.live.running_tracker import with_tracker

DURATION, QUICK = 15.0, 3.0  # of the measurement [s]
BLOCKS = 10                  # independent parts of the measurement


@with_tracker
def live(run, tracker, dialogue):
    tracker.wait_for_points()
    dialogue.line('Move one LED on a horizontal circle at constant speed: on a turntable, or an '
                  'arm of a motor.')
    radius = dialogue.ask_number('Its radius in metres, when it moves (Enter: skip this):',
                                 0.05, 10.0)
    if radius is None:
        run.say('The circle was skipped.')
        return
    duration = QUICK if run.quick else DURATION
    begin = tracker.now()
    while tracker.now() < begin + duration:
        dialogue.passing('measuring, %.0f s left' % (begin + duration - tracker.now()))
        time.sleep(0.05)
    tell(run, radius, path_of(tracker.since(begin)))


def path_of(seen):
    """Stamps [s] and positions [m] of instants with exactly one LED."""
    single = [each for each in seen if len(each.leds) == 1]
    return (np.array([each.stamp for each in single]),
            np.array([each.leds[0].position for each in single]).reshape(-1, 3))


def errors_of(positions, radius):
    """Centre and tilt of a circle of this radius; radial and height error of each point [m]."""
    middle = positions.mean(axis=0)
    _, _, axes = np.linalg.svd(positions - middle, full_matrices=False)
    plane = (positions - middle) @ axes[:2].T
    centre, _ = alignment.fit_circle(plane)
    radial = np.linalg.norm(plane - centre, axis=1) - radius
    return middle + centre @ axes[:2], radial, (positions - middle) @ axes[2]


def tell(run, radius, path):
    stamps, positions = path
    if len(positions) < 10 * BLOCKS:
        run.say(f'Only {len(positions)} points with one LED came: there are no figures.')
        return
    centre, radial, height = errors_of(positions, radius)
    way = np.linalg.norm(np.diff(positions[::10], axis=0), axis=1).sum()
    speed = way / (stamps[::10][-1] - stamps[0])
    run.say('An LED on a circle of %.3f m around (%.3f, %.3f, %.3f) m, %.2f m/s. Centre and plane '
            'of the circle are fitted to the points, the radius is given.'
            % ((radius,) + tuple(centre) + (speed,)))
    for name, values, note in (('radial', radial, 'Radial error, RMS'),
                               ('height', height, 'Error across the circle\'s plane, RMS')):
        run.estimate('live_' + name, statistics.blocks(1e3 * values, BLOCKS), statistics.rms, 'mm',
                     note, samples=len(values), end_to_end=True)
    run.figure('live_speed', speed, 'm/s', len(positions), note='Speed on the circle',
               end_to_end=True)
    run.table('points', [('stamp', 's'), ('x', 'm'), ('y', 'm'), ('z', 'm'), ('radial_error', 'mm'),
                         ('height_error', 'mm')],
              np.column_stack([stamps - stamps[0], positions, 1e3 * radial, 1e3 * height]).tolist(),
              'Every point.', shown=False)
    figure, axes = charts.figure()
    charts.cumulative(axes, 1e3 * np.abs(radial), charts.BLUE, 'radial')
    charts.cumulative(axes, 1e3 * np.abs(height), charts.ORANGE, 'height')
    axes.set(xlim=(0.0, None), xlabel='error [mm]', ylabel='share of the points')
    charts.key(axes, 'lower right')
    run.plot('circle', figure, 'Cumulative distributions of the errors on the circle.')
    run.summary('On a circle of %.2f m at %.2f m/s: RMS error %.1f mm radially, %.1f mm in height.'
                % (radius, speed, 1e3 * statistics.rms(radial), 1e3 * statistics.rms(height)))
