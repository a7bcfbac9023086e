"""Two to eight cameras."""

import numpy as np

from wiimote_tracker_bringup import bound, charts, scene, statistics
from wiimote_tracker_evaluation.sessions import per_session, where

PROGRAM = 'evaluate_cameras'
QUICK, FULL = 6, 80  # sessions
CAPTION = 'Errors with two to eight cameras.'
METHODS = (('most_likely', 'single points, most likely', charts.BLUE),
           ('mean_closest', 'single points, mean of closest points (paper)', charts.RED),
           ('tracks_1_m_per_s', 'an LED at 1 m/s, followed', charts.GREEN))
MIDDLE = np.array([1.25, 1.25, 1.0])  # target of the ring of evaluate_cameras [m]


def tell(run, table):
    counts = np.unique(table['cameras']).astype(int).tolist()
    run.say(
        '### Two to eight cameras\n\n'
        'The cameras are exactly known and stand on a ring around the cube; two are at a right '
        'angle. Single points: one image per camera, anywhere in the cube, pixels rounded. The '
        'Cramér-Rao bound is computed by a camera model that shares no code with the tracker. The '
        'paper\'s mean weights all pairs of rays equally. Rays of opposite cameras are nearly '
        'collinear and do not determine the position along them, which increases the error for '
        'four and six cameras.')
    bounds = ring_bounds(run.rig, table, counts)
    figure, axes = charts.figure()
    for method, label, color in METHODS:
        rms = [statistics.rms(np.concatenate(per_session(
            table, 'error_mm', cameras=count, method=method))) for count in counts]
        axes.plot(counts, rms, 'o-', markersize=4, color=color, label=label)
    axes.plot(counts, bounds, '--', color=charts.SOFT, label='bound of single points')
    axes.set(xlabel='cameras', ylabel='RMS error [mm]', ylim=(0.0, None), xticks=counts)
    charts.key(axes, 'upper right')
    run.plot('cameras', figure, 'RMS error by the number of exactly known cameras.')
    for count in (2, 4, 8):
        for method, label, _ in METHODS:
            run.estimate(f'{method}_{count}_cameras', per_session(
                table, 'error_mm', cameras=count, method=method), statistics.rms, 'mm',
                f'RMS error with {count} cameras, {label}')
        run.figure('bound_%d_cameras' % count, bounds[counts.index(count)], 'mm', 1,
                   note='Cramér-Rao bound of single points with %d cameras' % count)


def ring_bounds(rig, table, counts):
    """RMS of the bounds of the measured points [mm], for each number of cameras."""
    described = scene.read_scene(rig)
    bounds = []
    for count in counts:
        chosen = where(table, cameras=count, method='most_likely')
        points = np.stack([table[name][chosen] for name in ('x_m', 'y_m', 'z_m')], axis=1)
        points = points[np.isfinite(table['error_mm'][chosen])]
        bounds.append(1e3 * point_bound(ring(described, count), described.effective_noise(),
                                        points))
    return bounds


def ring(described, count):
    """The cameras of evaluate_cameras around the cube."""
    first = described.cameras[0].position - MIDDLE
    step = np.pi / 2.0 if count == 2 else 2.0 * np.pi / count
    cameras = []
    for i in range(count):
        like = described.cameras[i % len(described.cameras)]
        c, s = np.cos(step * i), np.sin(step * i)
        position = MIDDLE + np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]) @ first
        cameras.append(scene.Camera('', like.parameters, scene.look_at(position, MIDDLE), position,
                                    like.size))
    return cameras


def point_bound(cameras, noise, points):
    """RMS over the points of the least standard deviation of a position [m]."""
    information = np.zeros((len(points), 3, 3))
    for camera in cameras:
        jacobian = bound.derivatives(lambda move: camera.project(points + move), [1e-5] * 3)
        seen = camera.sees(points)
        information[seen] += np.einsum('nij,nik->njk', jacobian[seen], jacobian[seen]) / noise ** 2
    return float(np.sqrt(np.mean(np.trace(np.linalg.inv(information), axis1=1, axis2=2))))
