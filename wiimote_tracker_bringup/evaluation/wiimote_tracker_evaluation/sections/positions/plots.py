"""Plots of the ten points: cumulative errors (Fig. 7 and 9), cubes (Fig. 8), convergence of the
correction (Fig. 2)."""

import matplotlib.patches
import numpy as np

from wiimote_tracker_bringup import charts
from wiimote_tracker_bringup.experiment import NOMINAL_LENS
from wiimote_tracker_evaluation.sections.positions.results import CASES, FOUR, OURS, TWO

CASE_COLORS = dict(zip(CASES, (charts.RED, charts.ORANGE, charts.BLUE, charts.GREEN,
                               charts.PURPLE)))
OUR_STYLES = {'square': (charts.BLUE, 'square alone'),
              'wave': (charts.GREEN, 'square and waved LED'),
              'wand': (charts.ORANGE, 'square and wand')}
LIMITS = (0.1, 100.0)  # of the errors [cm]
DRAWS_PER_POINT = 100

TITLE_SIZE = 9.5

# Errors stated in the paper [cm]: number, share of the points that are not larger, label and its
# placement.
PAPER_MARKS = {
    TWO: ((15.0, 0.0, 'paper: C1,\nC2 from 15', 'left', 6), (50.0, 1.0, 'to 50', 'left', -7),
          (7.0, 1.0, 'C3 to C5\nto 7', 'left', -7)),
    FOUR: ((2.8, 1.0, 'paper: C3 to 2.8', 'right', -4), (4.8, 1.0, 'C5 below 4.8', 'right', -15),
           (8.5, 1.0, 'C4 to 8.5', 'left', -4))}


CENTER = np.array([512.0, 384.0])  # of the image [px]
BY_BOARD = CENTER + [(30.0, 25.0), (-38.0, 12.0), (14.0, -30.0), (-25.0, -20.0)]  # an example


def paper_cases():
    """Drawing that defines the paper's cases by the principal points that they use."""
    common, center = NOMINAL_LENS[None, 2:4], CENTER[None]
    figure, axes = charts.figure(1, 5, height=2.0, width=11.0)
    for axis, case, words, points, corrected in zip(
            axes, CASES, ('one matrix, K (2)', 'one per camera, by board', 'C1, corrected',
                          'C2, corrected', 'C4 from the centre'),
            (common, BY_BOARD, common, BY_BOARD, center), (False, False, True, True, True)):
        axis.set_title(f'{case}: {words}', fontsize=TITLE_SIZE)
        axis.plot(*CENTER, '+', color=charts.SOFT, markersize=12)
        axis.plot(*points.T, 'o', color=CASE_COLORS[case], markersize=5)
        if corrected:
            axis.add_patch(matplotlib.patches.Circle(CENTER, 55.0, fill=False, linestyle=':',
                                                     color=CASE_COLORS[case]))
        axis.set(xlim=(392, 632), ylim=(464, 304), aspect='equal', xticks=[412, 512, 612],
                 yticks=[334, 384, 434])
    return figure


def cumulative_errors(results, cameras, protocol):
    """protocol: sessions of a case to draw separately; the paper had two per case."""
    figure, axes = charts.figure(1, 3, height=4.2, width=11.0, sharex=True, sharey=True)
    for axis, model, title in ((axes[0], 'image_center', "the paper's, rays from the image centre"),
                               (axes[1], 'calibrated', "the paper's, rays as calibrated")):
        for case in CASES:
            errors = 100.0 * results.group(cameras, case, model).from_nominal()
            charts.cumulative(axis, errors.ravel(), CASE_COLORS[case], case)
            if len(errors) >= max(protocol(case)) + 1:
                charts.cumulative(axis, errors[list(protocol(case))].ravel(), CASE_COLORS[case],
                                  linewidth=0.7, linestyle=':')
        axis.set_title(title, fontsize=TITLE_SIZE)
        mark_paper(axis, cameras)
    charts.key(axes[0], loc='center left')
    ours(axes[2], results, cameras)
    for axis in axes:
        charts.log_axis(axis, 'x', [0.1, 1.0, 10.0, 100.0], minor=True)
        axis.set(xlim=LIMITS, xlabel='error [cm]')
    axes[0].set_ylabel('share of the points')
    return figure


def mark_paper(axis, cameras):
    for number, share, words, side, height in PAPER_MARKS[cameras]:
        axis.plot([number], [share], 'D', color=charts.INK, markersize=5, clip_on=False, zorder=5)
        axis.annotate(words, (number, share), xytext=(6 if side == 'left' else -6, height),
                      textcoords='offset points', ha=side, va='top' if height < 0 else 'bottom',
                      fontsize=7.5, color=charts.INK, zorder=6,
                      bbox={'facecolor': 'white', 'edgecolor': 'none', 'alpha': 0.75, 'pad': 0.5})


def ours(axis, results, cameras):
    best = 100.0 * results.group(cameras, 'C5', 'calibrated').from_truth()
    charts.cumulative(axis, best.ravel(), charts.PURPLE, "the paper's C5",
                      linewidth=1.0)
    remapped = 100.0 * results.group(cameras, 'C1_remapped', 'image_center').from_truth()
    charts.cumulative(axis, remapped.ravel(), charts.RED, 'C1, corrected volume',
                      linewidth=1.0)
    for method in OURS:
        color, words = OUR_STYLES[method]
        charts.cumulative(axis, 100.0 * results.group(cameras, method).from_truth().ravel(), color,
                          words)
    for method in OURS:
        color, words = OUR_STYLES[method]
        charts.cumulative(axis, 100.0 * bound_sample(results, cameras, method), color,
                          linewidth=0.9, linestyle='--')
    axis.set_title('ours, from where the LED was', fontsize=TITLE_SIZE)
    charts.key(axis, loc='lower right', extra=[('--', 'bound of that colour')])


def bound_sample(results, cameras, method):
    """Errors distributed as at the Cramér-Rao bound [m]."""
    covariance = results.group(cameras, 'bound_' + method).covariance.reshape(-1, 3, 3)
    covariance = covariance[np.isfinite(covariance).all(axis=(1, 2))]
    root = np.linalg.cholesky(covariance)
    normal = np.random.RandomState(1).randn(len(root), 3, DRAWS_PER_POINT)
    return np.linalg.norm(root @ normal, axis=1).ravel()


def cubes(results, session):
    """The ideal cube and those of C2 and C4, of one session with two cameras, from above and from
    the side: the measured corners, with rays from the image centre."""
    figure, axes = charts.figure(1, 2, height=4.4, width=9.0)
    for axis, (across, up), names in ((axes[0], (0, 1), 'xy'), (axes[1], (0, 2), 'xz')):
        for case, color, style, words in (
                (None, charts.RED, '--', 'ideal'),
                ('C2', charts.GREEN, '-', 'C2, not corrected'),
                ('C4', charts.BLUE, '-', 'C4, corrected in 14 rounds')):
            group = results.group(TWO, case or 'C2', 'image_center')
            corners = (group.nominal if case is None else group.measured)[session, :8]
            for number, (a, b) in enumerate(EDGES):
                axis.plot(corners[[a, b], across], corners[[a, b], up], style, color=color,
                          linewidth=1.2, label=words if number == 0 else None)
        axis.set(aspect='equal', xlabel=f'{names[0]} [m]', ylabel=f'{names[1]} [m]')
    axes[0].set_title('from above', fontsize=TITLE_SIZE)
    axes[1].set_title('from the side', fontsize=TITLE_SIZE)
    charts.key(axes[1], loc='center')
    return figure


EDGES = ([(i, (i + 1) % 4) for i in range(4)] + [(4 + i, 4 + (i + 1) % 4) for i in range(4)]
         + [(i, i + 4) for i in range(4)])


def correction(results, session):
    """C3 of one session with two cameras by rounds, for both ray models."""
    figure, (way, error) = charts.figure(1, 2, height=3.6, width=9.0)
    for model, style, words in (('image_center', '-', 'rays from the image centre'),
                                ('calibrated', '--', 'rays as calibrated')):
        cameras = results.trace(TWO, 'C3', model, session)
        for camera, color in zip(cameras, (charts.BLUE, charts.ORANGE)):
            if model == 'image_center':
                way.plot(camera['difference_u'], camera['difference_v'], 'o-', color=color,
                         markersize=3, label='camera %d' % camera['camera'][0])
                way.annotate('before', (camera['difference_u'][0], camera['difference_v'][0]),
                             xytext=(8, -9), textcoords='offset points', fontsize=8, color=color)
        error.plot(cameras[0]['round'], 1e3 * cameras[0]['origin_error'], style + 'o',
                   color=charts.INK, markersize=3, label=words)
    way.plot([0.0], [0.0], '+', color=charts.INK, markersize=9)
    way.set(xlabel='difference u [px]', ylabel='difference v [px]')
    way.set_title('ideal less measured origin, rays from the image centre', fontsize=TITLE_SIZE)
    charts.key(way)
    charts.log_axis(error, 'y', [1, 10, 100], minor=True)
    error.set(xlabel='round', ylabel='error of the origin [mm]')
    error.set_title('measured origin from the ideal one', fontsize=TITLE_SIZE)
    charts.key(error)
    return figure
