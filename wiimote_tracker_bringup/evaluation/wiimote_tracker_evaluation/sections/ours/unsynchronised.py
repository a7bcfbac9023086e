"""Unsynchronised cameras, and the benefit of estimated exposure times."""

import numpy as np

from wiimote_tracker_bringup import charts, statistics
from wiimote_tracker_evaluation.sessions import per_session

PROGRAM = 'evaluate_unsynchronised'
QUICK, FULL = 3, 40  # sessions
CAPTION = 'Errors of an LED on a circle.'
METHODS = (('exact', 'tracks', 'exact times (nobody has them)', charts.SOFT),
           ('estimated', 'tracks', 'estimated exposures (ours)', charts.BLUE),
           ('arrival', 'tracks', 'arrivals instead', charts.ORANGE),
           ('exact', 'latest', 'latest spots, no time at all', charts.RED))
SPEED = 2.0  # of the figures [m/s]


def tell(run, table):
    run.say(
        '### Cameras that are not synchronised\n\n'
        'An LED moves on a circle of 75 cm. The cameras are exactly known and have their own '
        'clocks (period about 10 ms, random phases); reports are delayed as in the rig\'s '
        'description. *Latest spots*: at each report, the rays of all cameras\' latest spots are '
        'intersected (mean of the closest points), without use of times; the point is compared '
        'with the LED at the mean exposure time, the best possible choice. A common lateness of '
        'all stamps (about 9.5 ms here) cannot be estimated from arrivals. It shifts the times of '
        'points and is removed from these errors. Synchronised cameras (dashed) are no better: '
        'their images arrive in groups, with gaps between them.')
    speeds = sorted(set(table['speed_m_per_s']))
    figure, axes = charts.figure()
    for stamps, method, label, color in METHODS:
        for clocks, style in (('own', 'o-'), ('synchronised', 'x--')):
            rms = [statistics.rms(np.concatenate(units_of(table, speed, clocks, stamps, method)))
                   for speed in speeds]
            axes.plot(speeds, rms, style, color=color, markersize=4,
                      label=label if clocks == 'own' else None)
    axes.set(xlabel='speed of the LED [m/s]', ylabel='RMS error [mm]', xlim=(0.0, None),
             ylim=(0.0, None))
    charts.key(axes, 'upper left', (('-', 'cameras on their own clocks'),
                                    ('--', 'all expose at once')))
    run.plot('unsynchronised', figure, 'RMS error by the LED\'s speed.')
    values = {}
    for stamps, method, label, _ in METHODS:
        values[stamps, method], _ = run.estimate(
            f'unsynchronised_{method}_{stamps}', units_of(table, SPEED, 'own', stamps, method),
            statistics.rms, 'mm', f'RMS error at {SPEED:g} m/s, own clocks, {label}')
    run.summary('**Cameras that are not synchronised**, simulated: at %g m/s %.1f mm RMS with '
                'estimated exposures (%.1f mm were they exact), %.1f mm with arrivals, %.1f mm '
                'when the latest spots are intersected.' % (
                    SPEED, values['estimated', 'tracks'], values['exact', 'tracks'],
                    values['arrival', 'tracks'], values['exact', 'latest']))


def units_of(table, speed, clocks, stamps, method):
    return per_session(table, 'rms_mm', speed_m_per_s=speed, clocks=clocks, stamps=stamps,
                       method=method)
