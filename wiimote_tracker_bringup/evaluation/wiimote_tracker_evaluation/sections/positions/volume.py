"""Predicted and measured accuracy in the whole cube, with four cameras."""

import numpy as np

from wiimote_tracker_bringup import charts, statistics
from wiimote_tracker_bringup.experiment import SIDE
from wiimote_tracker_evaluation.sections.positions.results import FOUR, solved

METHODS = (('square', 'the square alone'), ('wave', 'square and waved LED'))
AXIS = SIDE * np.array([0.0, 0.5, 1.0])  # x, y and z of the 27 places [m]


def tell(run, results):
    run.say(
        '### Accuracy over the volume\n\n'
        'A still LED at 27 places in the same sessions with four Wiimotes. *Measured*: RMS error '
        'from the true position over the sessions. *Predicted*: by the calibration itself. Its '
        'covariance is right if the normalised squared error is 1 on average.')
    found = {}  # sessions x places [mm]
    for method, label in METHODS:
        group = results.group(FOUR, method, places=True)
        found[method, 'measured'] = 1e3 * group.from_truth()
        found[method, 'predicted'] = 1e3 * solved(np.sqrt(group.stated()))
        for word in ('measured', 'predicted'):
            run.estimate(f'volume_{method}_{word}', found[method, word], statistics.rms, 'mm',
                         f'RMS error over the cube, {label}, {word}')
        run.estimate(f'volume_{method}_consistency', group.normalised() / 3.0, np.mean, '',
                     f'Normalised squared error (1: the prediction is true), {label}')
    plot(run, {key: np.sqrt((values ** 2).mean(axis=0)).reshape(3, 3, 3)
               for key, values in found.items()})


def plot(run, maps):
    """maps: RMS by z, y and x [mm]."""
    figure, axes = charts.figure(2, 6, height=4.4)
    largest = max(each.max() for each in maps.values())
    ticks = [f'{place:g}' for place in AXIS]
    for row, (method, label) in zip(axes, METHODS):
        for number, (height, word) in enumerate((height, word) for height in range(3)
                                                for word in ('measured', 'predicted')):
            axis, grid = row[number], maps[method, word][height]
            axis.imshow(grid, origin='lower', cmap='YlOrRd', vmin=0.0, vmax=largest)
            for (v, h), value in np.ndenumerate(grid):
                axis.text(h, v, f'{value:.0f}', ha='center', va='center', fontsize=8,
                          color='white' if value > 0.6 * largest else charts.INK)
            axis.set(xticks=range(3), yticks=range(3))
            axis.set_xticklabels(ticks, fontsize=7)
            axis.set_yticklabels(ticks, fontsize=7)
            axis.grid(False)
            axis.set_title(f'{word}\nz = {AXIS[height]:g} m', fontsize=8)
        row[0].set_ylabel(f'{label}\ny [m]')
    for axis in axes[1]:
        axis.set_xlabel('x [m]')
    run.plot('volume', figure, 'RMS errors in the cube [mm], measured and predicted, at three '
             'heights.')
