"""Predicted and measured accuracy in the whole cube after a calibration."""

import numpy as np

from wiimote_tracker_bringup import charts, statistics
from wiimote_tracker_evaluation.sessions import per_session, where

PROGRAM = 'evaluate_map'
QUICK, FULL = 6, 60  # sessions
CAPTION = 'Errors at 27 places after a calibration.'
METHODS = (('square', 'the square alone'), ('wave', 'square and waved LED'))


def tell(run, table):
    run.say(
        '### Accuracy over the volume\n\n'
        'Each session has other lenses and other placement errors of the corners, is calibrated, '
        'and measures a still LED at 27 positions. *Measured*: RMS error over the sessions. '
        '*Predicted*: by the calibration itself. Its covariance is right if the normalised squared '
        'error is 1 on average.')
    heights = sorted(set(table['z_m']))
    places = sorted(set(table['x_m']))
    figure, axes = charts.figure(2, 2 * len(heights), height=4.4)
    largest = max(rms_grid(table, method, column, height, places).max()
                  for method, _ in METHODS for column in ('error_mm', 'predicted_mm')
                  for height in heights)
    for row, (method, label) in zip(axes, METHODS):
        for i, height in enumerate(heights):
            for j, (column, word) in enumerate((('error_mm', 'measured'),
                                                ('predicted_mm', 'predicted'))):
                plot = row[2 * i + j]
                grid = rms_grid(table, method, column, height, places)
                plot.imshow(grid, origin='lower', cmap='YlOrRd', vmin=0.0, vmax=largest)
                for (v, h), value in np.ndenumerate(grid):
                    plot.text(h, v, f'{value:.0f}', ha='center', va='center', fontsize=8,
                              color='white' if value > 0.6 * largest else charts.INK)
                plot.set(xticks=range(len(places)), yticks=range(len(places)))
                plot.set_xticklabels([f'{place:g}' for place in places], fontsize=7)
                plot.set_yticklabels([f'{place:g}' for place in places], fontsize=7)
                plot.grid(False)
                plot.set_title(f'{word}\nz = {height:g} m', fontsize=8)
        row[0].set_ylabel(f'{label}\ny [m]')
    for plot in axes[1]:
        plot.set_xlabel('x [m]')
    run.plot('volume', figure, 'RMS errors in the cube [mm], measured and predicted, at three '
                               'heights.')
    for method, label in METHODS:
        for column, word in (('error_mm', 'measured'), ('predicted_mm', 'predicted')):
            run.estimate(f'volume_{method}_{word}', per_session(table, column, method=method),
                         statistics.rms, 'mm', f'RMS error over the cube, {label}, {word}')
        run.estimate(f'volume_{method}_consistency',
                     per_session(table, 'normalised_squared_error', method=method), np.mean, '',
                     f'Normalised squared error (1: the prediction is true), {label}')


def rms_grid(table, method, column, height, places):
    """RMS by y (rows) and x (columns) [mm]."""
    return np.array([[statistics.rms(table[column][where(table, method=method, x_m=x, y_m=y,
                                                         z_m=height)]) for x in places]
                     for y in places])
