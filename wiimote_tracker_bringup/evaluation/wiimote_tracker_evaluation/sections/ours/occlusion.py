"""Occluded LEDs."""

import numpy as np

from wiimote_tracker_bringup import charts, statistics
from wiimote_tracker_evaluation.sessions import per_session, where

PROGRAM = 'evaluate_occlusion'
QUICK, FULL = 4, 60  # sessions
CAPTION = 'An LED with random occlusions.'
METHODS = (('tracks', 'tracks, predicted points too', charts.BLUE),
           ('tracked', 'tracks, tracked points only', charts.GREEN),
           ('instants', 'instant by instant', charts.ORANGE))
HIDDEN = 0.3  # hidden share shown as figures


def tell(run, table):
    counts = np.unique(table['cameras']).astype(int)[[0, -1]]
    shares = np.unique(table['hidden_share'])
    run.say(
        '### Occlusion\n\n'
        'An LED circles at 1 m/s. Each camera independently loses sight of it at random, for 0.25 '
        's on average. The covered time is that with a newest published point younger than 25 ms '
        'and less than 5 cm off. *Instant by instant* triangulates as in the paper, which requires '
        'two cameras (dashed line). *Tracks* continue for up to 0.7 s with one camera, which does '
        'not measure the distance, and for 0.5 s with none. These points are marked as predicted '
        'and are not on the LED\'s own topic.')
    figure, axes = charts.figure(1, 2)
    for plot, count in zip(axes, counts):
        for method, label, color in METHODS:
            mean = [100.0 * np.mean(np.concatenate(per_session(
                table, 'covered_share', cameras=count, hidden_share=share, method=method)))
                for share in shares]
            plot.plot(100.0 * shares, mean, 'o-', markersize=3, color=color, label=label)
        two = [100.0 * np.mean(table['two_views_share'][where(table, cameras=count,
                                                              hidden_share=share)])
               for share in shares]
        plot.plot(100.0 * shares, two, '--', color=charts.SOFT, label='two cameras see it')
        plot.set(title='%d cameras' % count, ylim=(0.0, 104.0),
                 xlabel='time that each camera does not see it [%]')
    axes[0].set_ylabel('covered time [%]')
    charts.key(axes[0], 'lower left')
    run.plot('occlusion', figure, 'Share of the time with a known position of the LED.')
    for count in counts:
        for method, label, _ in METHODS:
            for column, name, unit, factor, note in (
                    ('covered_share', 'covered', '%', 100.0, 'Covered time'),
                    ('rms_mm', 'rms', 'mm', 1.0, 'RMS error of the points less than 5 cm off'),
                    ('astray_share', 'astray', '%', 100.0, 'Points more than 5 cm off'),
                    ('inside_share', 'inside', '%', 100.0, 'Points in their 95 % ellipsoid')):
                units = [factor * values for values in per_session(
                    table, column, cameras=count, hidden_share=HIDDEN, method=method)]
                statistic = statistics.rms if column == 'rms_mm' else np.mean
                run.estimate(f'occlusion_{name}_{method}_{count}_cameras', units, statistic, unit,
                             '%s, each of %d cameras blind %d %% of the time, %s' % (
                                 note, count, 100 * HIDDEN, label))
