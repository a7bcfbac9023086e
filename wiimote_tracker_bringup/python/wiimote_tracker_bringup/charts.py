"""Style of the report's plots: small and plain, text as text."""

import numpy as np

from wiimote_tracker_bringup.errors import Refusal
from wiimote_tracker_bringup.needs import require

require('matplotlib')
import matplotlib  # noqa: E402
matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402
import matplotlib.ticker  # noqa: E402

INK, SOFT = '#1c2430', '#8a94a3'
BLUE, ORANGE, GREEN, RED, PURPLE = '#1f5fa8', '#d97a1e', '#3a8a4d', '#b8323a', '#7653a6'
COLORS = (BLUE, ORANGE, GREEN, RED, PURPLE, SOFT)
WIDTH = 9.0  # of the page [inch]

# What axes keep from when they are made; titles, legends and lines follow the style of later.
STYLE = {
    'font.size': 9.0, 'axes.spines.top': False, 'axes.spines.right': False, 'axes.edgecolor': SOFT,
    'axes.labelcolor': INK, 'text.color': INK, 'xtick.color': INK, 'ytick.color': INK,
    'axes.grid': True, 'grid.color': '#e6e9ee', 'grid.linewidth': 0.7, 'axes.axisbelow': True}


def figure(rows=1, columns=1, height=3.4, width=WIDTH, **more):
    """A matplotlib figure and its axes, as from plt.subplots."""
    with matplotlib.rc_context(STYLE):
        return plt.subplots(rows, columns, figsize=(width, height), constrained_layout=True, **more)


def save(figure, path):
    """Throws Refusal if matplotlib does not know the ending."""
    try:
        figure.savefig(path)
    except ValueError as error:
        raise Refusal(f'{path}: {error}') from error


def cumulative(axes, values, color, label=None, **style):
    """Empirical cumulative distribution, as steps."""
    values = np.sort(np.asarray(values, dtype=float))
    if len(values) > 2000:  # resolution of the page
        values = np.quantile(values, np.linspace(0.0, 1.0, 500))
    share = np.arange(1, len(values) + 1) / len(values)
    axes.step(np.concatenate([values[:1], values]), np.concatenate([[0.0], share]), where='post',
              color=color, label=label, **style)
    axes.set_ylim(0.0, 1.0)


def plain_numbers():
    """Tick labels of a logarithmic axis: 0.1, 1, 10."""
    return matplotlib.ticker.StrMethodFormatter('{x:g}')


def log_axis(axes, which, ticks, minor=False):
    """Makes an axis, 'x' or 'y', logarithmic, with these ticks. minor: with others between them."""
    getattr(axes, f'set_{which}scale')('log')
    axis = getattr(axes, which + 'axis')
    axis.set_ticks(ticks)
    if not minor:
        axis.set_ticks([], minor=True)
    axis.set_ticklabels([f'{tick:g}' for tick in ticks])


def key(axes, loc='best', extra=()):
    """The legend; extra: (line style, text) common to several curves."""
    handles, labels = axes.get_legend_handles_labels()
    for style, text in extra:
        handles.append(plt.Line2D([], [], color=INK, linestyle=style))
        labels.append(text)
    axes.legend(handles, labels, loc=loc, frameon=False, fontsize=8.5)
