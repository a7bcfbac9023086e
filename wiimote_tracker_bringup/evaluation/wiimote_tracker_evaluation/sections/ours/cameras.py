"""Two to eight cameras."""

import numpy as np

from wiimote_tracker_bringup import charts, statistics
from wiimote_tracker_evaluation.sessions import per_session

PROGRAM = 'evaluate_cameras'
QUICK, FULL = 6, 80  # sessions
CAPTION = 'Errors with two to eight cameras.'
METHODS = (('most_likely', 'single points, most likely', charts.BLUE),
           ('mean_closest', 'single points, mean of closest points (paper)', charts.RED),
           ('tracks_1_m_per_s', 'an LED at 1 m/s, followed', charts.GREEN))


def tell(run, table):
    counts = np.unique(table['cameras']).astype(int).tolist()
    run.say(
        '### Two to eight cameras\n\n'
        'The cameras are exactly known and stand on a ring around the cube; two are at a right '
        'angle. Single points: one image per camera, anywhere in the cube, pixels rounded. '
        '*Stated*: by the covariance of the most likely points. The paper\'s mean weights all '
        'pairs of rays equally. Rays of opposite cameras are nearly collinear and do not determine '
        'the position along them, which increases the error for four and six cameras.')
    stated = [statistics.rms(np.concatenate(per_session(
        table, 'predicted_mm', cameras=count, method=METHODS[0][0]))) for count in counts]
    figure, axes = charts.figure()
    for method, label, color in METHODS:
        rms = [statistics.rms(np.concatenate(per_session(
            table, 'error_mm', cameras=count, method=method))) for count in counts]
        axes.plot(counts, rms, 'o-', markersize=4, color=color, label=label)
    axes.plot(counts, stated, '--', color=charts.SOFT, label='stated, most likely')
    axes.set(xlabel='cameras', ylabel='RMS error [mm]', ylim=(0.0, None), xticks=counts)
    charts.key(axes, 'upper right')
    run.plot('cameras', figure, 'RMS error by the number of exactly known cameras.')
    for count in (2, 4, 8):
        for method, label, _ in METHODS:
            run.estimate(f'{method}_{count}_cameras', per_session(
                table, 'error_mm', cameras=count, method=method), statistics.rms, 'mm',
                f'RMS error with {count} cameras, {label}')
        run.figure('stated_%d_cameras' % count, stated[counts.index(count)], 'mm', 1,
                   note='Stated error of single points, most likely, with %d cameras' % count)
