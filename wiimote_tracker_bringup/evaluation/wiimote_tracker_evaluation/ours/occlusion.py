"""Occluded LEDs."""

import numpy as np

from wiimote_tracker_evaluation import charts, statistics
from wiimote_tracker_evaluation.ours.columns import keep, per_session, read_shared, shared, where

PROGRAM = 'evaluate_occlusion'
METHODS = (('tracks', 'tracks, predicted points too', charts.BLUE),
           ('tracked', 'tracks, tracked points only', charts.GREEN),
           ('instants', 'instant by instant', charts.ORANGE))
HIDDEN = 0.3  # hidden share shown as figures


def commands(run):
    return shared(run, PROGRAM, 4 if run.quick else 60)


def tell(run):
    table = read_shared(run, PROGRAM)
    counts = [int(count) for count in sorted(set(table['cameras']))]
    shares = sorted(set(table['hidden_share']))
    run.say(
        '### Occlusion\n\n'
        'An LED goes round at 1 m/s; each camera for itself loses sight of it at random, for a '
        'quarter of a second on average. Covered is the time in which its newest published point is '
        'younger than 25 ms and less than 5 cm off. Instant by instant, rays are intersected as in '
        'the paper; that ends where fewer than two cameras see the LED (the dashed line). Tracks go '
        'on for a second with one camera, which does not see how far away the LED is, and for half a '
        'second with none: their points are then said to be predicted, and have no topic of their '
        'own. With two cameras they are tracked.')
    figure, axes = charts.figure(1, 2)
    for plot, count in zip(axes, (counts[0], counts[-1])):
        for method, label, color in METHODS:
            mean = [100.0 * np.mean(np.concatenate(per_session(table, 'covered_share', where(
                table, cameras=count, hidden_share=share, method=method)))) for share in shares]
            plot.plot(100.0 * np.array(shares), mean, 'o-', markersize=3, color=color, label=label)
        two = [100.0 * np.mean(table['two_views_share'][where(table, cameras=count,
                                                              hidden_share=share)])
               for share in shares]
        plot.plot(100.0 * np.array(shares), two, '--', color=charts.SOFT, label='two cameras see it')
        plot.set_title('%d cameras' % count)
        plot.set_xlabel('time that each camera does not see it [%]')
        plot.set_ylim(0.0, 104.0)
    axes[0].set_ylabel('covered time [%]')
    charts.key(axes[0], 'lower left')
    run.plot('occlusion', figure, 'For how much of the time the LED\'s place is known.')
    for count in (counts[0], counts[-1]):
        for method, label, _ in METHODS:
            chosen = where(table, cameras=count, hidden_share=HIDDEN, method=method)
            for column, name, unit, factor, note in (
                    ('covered_share', 'covered', '%', 100.0, 'Covered time'),
                    ('rms_mm', 'rms', 'mm', 1.0, 'RMS error of the points less than 5 cm off'),
                    ('astray_share', 'astray', '%', 100.0, 'Points more than 5 cm off'),
                    ('inside_share', 'inside', '%', 100.0, 'Points in their 95 % ellipsoid')):
                units = [factor * values for values in per_session(table, column, chosen)]
                statistic = statistics.rms if column == 'rms_mm' else np.mean
                run.figure('occlusion_%s_%s_%d_cameras' % (name, method, count),
                           statistic(np.concatenate(units)), unit, len(units),
                           statistics.bootstrap(units, statistic, run.seed),
                           '%s, each of %d cameras blind %d %% of the time, %s' % (
                               note, count, 100 * HIDDEN, label))
    keep(run, PROGRAM, table, 'An LED that is hidden now and then.')
