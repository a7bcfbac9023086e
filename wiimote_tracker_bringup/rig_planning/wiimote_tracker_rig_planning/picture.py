"""A map of the volume, seen from above, at three heights."""

import numpy as np

from wiimote_tracker_rig_planning import prediction

ACROSS = 40  # points along an edge


def draw(chosen, positions, targets, path):
    """Writes it. Grey: seen by fewer than two cameras, or a body that is not located in some
    heading."""
    from wiimote_tracker_bringup import charts  # matplotlib may be absent
    from matplotlib.patches import Rectangle
    low, high = np.array(chosen.volume).reshape(2, 3)
    x, y = (np.linspace(low[axis], high[axis], ACROSS) for axis in (0, 1))
    heights = np.linspace(low[2], high[2], 3)
    errors = [errors_at(chosen, positions, targets, x, y, height) for height in heights]
    figure, maps = charts.figure(1, 3, height=4.5, width=13.0, sharey=True)
    for axes, height, values in zip(maps, heights, errors):
        axes.add_patch(Rectangle(low[:2], *(high - low)[:2], color='0.7'))
        shown = axes.pcolormesh(x, y, values.T, shading='nearest', cmap='viridis_r',
                                vmin=0.0, vmax=np.nanmax([1.0] + [np.nanmax(each) for each in errors
                                                                  if np.isfinite(each).any()]))
        for number, (position, target) in enumerate(zip(positions, targets), 1):
            axes.plot(*position[:2], 'ks')
            axes.annotate(str(number), position[:2], textcoords='offset points', xytext=(5, 5))
            axes.plot(*np.transpose([position, target])[:2], 'k-', linewidth=0.5)
        axes.set(aspect='equal', title=f'z = {height:.2f} m', xlabel='x [m]')
    maps[0].set_ylabel('y [m]')
    figure.colorbar(shown, ax=maps, label='standard deviation [mm]')
    charts.save(figure, path)


def errors_at(chosen, positions, targets, x, y, height):
    """Standard deviations by the pixels alone [mm], by x and y; NaN: seen by fewer than two."""
    points = np.stack(np.meshgrid(x, y, [height], indexing='ij'), axis=-1).reshape(-1, 3)
    each, located = prediction.target_information(chosen, positions, targets, points, None)
    errors = 1e3 * np.sqrt(prediction.variances(each))
    return np.where(located, errors, np.nan).reshape(len(x), len(y), -1).mean(axis=-1)
