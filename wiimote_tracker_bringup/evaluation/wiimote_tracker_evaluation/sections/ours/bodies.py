"""Poses of rigid bodies."""

import numpy as np

from wiimote_tracker_bringup import charts, statistics
from wiimote_tracker_evaluation.sessions import per_session, where

PROGRAM = 'evaluate_bodies'
QUICK, FULL = 4, 60  # sessions
CAPTION = 'A moving body with four LEDs.'
SMALL, LARGE = 1.5, 3.0
WRONG = 10.0  # greater rotation errors are wrong assignments [degrees]


def tell(run, table):
    counts, speeds = np.unique(table['cameras']).astype(int), np.unique(table['speed_m_per_s'])
    run.say(
        '### Body poses\n\n'
        'Four LEDs on a frame about 40 cm wide, with six different distances, move and turn (2 '
        'rad/s per m/s); the pose is tracked directly by the pixels. The errors are those of '
        'sessions without a wrong pose, one whose RMS rotation error exceeds %.0f°. Touching spots '
        'merge in the sensor: rarely at 6 m for small spots (size %.1f, merging within %.0f px), '
        'often for large ones (size %.0f, %.0f px).' % (WRONG, SMALL, 8 * SMALL, LARGE, 8 * LARGE))
    right = table['rotation_rms_deg'] < WRONG
    figure, axes = charts.figure(1, 2)
    for count, color in zip(counts, charts.COLORS):
        for plot, column in zip(axes, ('position_rms_mm', 'rotation_rms_deg')):
            for name, style, label in ((column, 'o-', '%d cameras' % count),
                                       ('predicted_' + column.replace('_rms', ''), 'x--', None)):
                low, middle, high = np.array([quantiles(per_session(
                    table, name, right, cameras=count, led_size=SMALL, speed_m_per_s=speed))
                    for speed in speeds]).T
                plot.plot(speeds, middle, style, markersize=4, color=color, label=label)
                if label:
                    plot.fill_between(speeds, low, high, color=color, alpha=0.12, linewidth=0)
    for plot, name in zip(axes, ('position [mm]', 'rotation [°]')):
        plot.set(xlabel='speed [m/s]', ylabel='RMS error of the ' + name, ylim=(0.0, None))
    charts.key(axes[0], 'upper left', (('-', 'measured'), ('--', 'stated')))
    run.plot('bodies', figure, 'RMS error of a body\'s pose per session by speed, small spots: '
             'median and 5 to 95 % of the sessions.')
    for count in counts:
        for column, name, unit in (('position_rms_mm', 'position', 'mm'),
                                   ('rotation_rms_deg', 'rotation', 'deg')):
            units = per_session(table, column, right, cameras=count, led_size=SMALL,
                                speed_m_per_s=1.0)
            if len(units) > 1:
                run.estimate(f'body_{name}_{count}_cameras', units, statistics.rms, unit,
                             f'RMS error of a body\'s {name} at 1 m/s and 2 rad/s, {count} cameras')
        for size, word in ((SMALL, 'small'), (LARGE, 'large')):
            chosen = where(table, cameras=count, led_size=size)
            run.share(f'body_wrong_{word}_spots_{count}_cameras', int((chosen & ~right).sum()),
                      int(chosen.sum()),
                      f'Sessions with a wrong pose, {word} spots, {count} cameras')


def quantiles(units):
    """5, 50 and 95 % quantiles of all values; NaN without any."""
    return np.quantile(np.concatenate(units), [0.05, 0.5, 0.95]) if units else [float('nan')] * 3
