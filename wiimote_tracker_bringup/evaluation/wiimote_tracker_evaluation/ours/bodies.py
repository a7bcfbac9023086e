"""Poses of rigid bodies."""

import numpy as np

from wiimote_tracker_evaluation import charts, statistics
from wiimote_tracker_evaluation.ours.columns import per_session, read_shared, shared, where

PROGRAM = 'evaluate_bodies'
SMALL, LARGE = 1.5, 3.0
WRONG = 10.0  # a rotation further off is that of another assignment [degrees]


def commands(run):
    return shared(run, PROGRAM, 4 if run.quick else 60)


def tell(run):
    table = read_shared(run, PROGRAM, 'A body with four LEDs, swung and turned.')
    counts = [int(count) for count in sorted(set(table['cameras']))]
    speeds = sorted(set(table['speed_m_per_s']))
    run.say(
        '### Body poses\n\n'
        'Four LEDs on a frame about 40 cm wide, all distances between them different, is swung round '
        'and turned (2 rad/s for each m/s); the pose is followed directly in the pixels. The errors are '
        'those of sessions without a wrong pose; a pose is called wrong when the rotation\'s RMS error '
        'exceeds %.0f°. LEDs whose spots touch are one spot to the sensor: with small spots (size '
        '%.1f, of which two touch within %.0f px) that is rare at 6 m, with large ones (size %.0f, %.0f '
        'px) not.' % (WRONG, SMALL, 8 * SMALL, LARGE, 8 * LARGE))
    right = table['rotation_rms_deg'] < WRONG
    figure, axes = charts.figure(1, 2)
    for count, color in zip(counts, charts.COLORS):
        for plot, column in zip(axes, ('position_rms_mm', 'rotation_rms_deg')):
            for name, style, label in ((column, 'o-', '%d cameras' % count),
                                       ('predicted_' + column.replace('_rms', ''), 'x--', None)):
                plot.plot(speeds, [rms_of(per_session(table, name, right & where(
                    table, cameras=count, led_size=SMALL, speed_m_per_s=speed)))
                    for speed in speeds], style, markersize=4, color=color, label=label)
    for plot, name in zip(axes, ('position [mm]', 'rotation [°]')):
        plot.set_xlabel('speed [m/s]')
        plot.set_ylabel('RMS error of the ' + name)
        plot.set_ylim(0.0, None)
    charts.key(axes[0], 'upper left', (('-', 'measured'), ('--', 'stated')))
    run.plot('bodies', figure, 'RMS errors of a body\'s pose over its speed, small spots.')
    for count in counts:
        chosen = right & where(table, cameras=count, led_size=SMALL, speed_m_per_s=1.0)
        for column, name, unit in (('position_rms_mm', 'position', 'mm'),
                                   ('rotation_rms_deg', 'rotation', 'deg')):
            units = per_session(table, column, chosen)
            if len(units) < 2:
                continue
            run.figure('body_%s_%d_cameras' % (name, count), rms_of(units), unit, len(units),
                       statistics.bootstrap(units, statistics.rms, run.seed),
                       'RMS error of a body\'s %s at 1 m/s and 2 rad/s, %d cameras' % (name, count))
        for size, word in ((SMALL, 'small'), (LARGE, 'large')):
            chosen = where(table, cameras=count, led_size=size)
            wrong = int((chosen & ~right).sum())
            low, high = statistics.wilson(wrong, int(chosen.sum()))
            run.figure('body_wrong_%s_spots_%d_cameras' % (word, count), 100.0 * wrong / chosen.sum(),
                       '%', int(chosen.sum()), (100.0 * low, 100.0 * high),
                       'Sessions with a wrong pose, %s spots, %d cameras' % (word, count))


def rms_of(units):
    """Root mean square over all; not a number without any."""
    return statistics.rms(np.concatenate(units)) if units else float('nan')
