"""A flight with a truth: calibrated, tracked and scored."""

import numpy as np
from scipy.spatial.transform import Rotation

from wiimote_tracker_bringup.errors import Refusal
from wiimote_tracker_bringup.timeseries import to_nearest
from wiimote_tracker_evaluation.recordings import accuracy, body, pipeline

METHOD = ('The middle of the lights as one point: poses and clock offsets by self_calibrate and '
          'solve_samples, path by track_bag; aligned on every other tenth of the recording and '
          'scored on the rest, both ways round. Smoothed: by track_bag --smooth, from the first '
          'point of each confirmed track. As a body: three lights or more are told apart, and the '
          'pose of the body is tracked by track_labelled_body; the place of the truth on it is '
          'fitted, too')
# Title, key, factor and unit.
FIGURES = (('mean error', 'mean_mm', 1.0, 'mm'), ('RMS error', 'rms_mm', 1.0, 'mm'),
           ('median error', 'median_mm', 1.0, 'mm'), ('95th percentile', 'p95_mm', 1.0, 'mm'),
           ('largest error', 'largest_mm', 1.0, 'mm'),
           ('in the 95 % ellipsoid', 'coverage_95', 100.0, '%'), ('NEES', 'nees', 1.0, ''))
# Both cameras must have seen the body within this, for it to be in sight [s]: tracked_time of the
# tracker.
SIGHT = 0.05
SAME_TIME = 1e-4  # of an image and its point [s]


def path_of(views, rig, table):
    """The tracked points, or poses, at the body's scale."""
    tracked = table['state'] == 'tracked'
    column = {name.split(' ')[0]: values for name, values in table.items()}

    def columns(*names):
        return np.stack([column[name][tracked].astype(float) for name in names], axis=1)

    times, positions = columns('time')[:, 0], columns('x', 'y', 'z')
    scale = rig.scale(views, times)
    if 'qw' in column:
        rotations = Rotation.from_quat(columns('qx', 'qy', 'qz', 'qw'))
        covariances = columns(*(f'cov_{i}' for i in range(36))).reshape(-1, 6, 6)
        units = np.array([scale, scale, scale, 1.0, 1.0, 1.0])
        return accuracy.Path(times, scale * positions, units[:, None] * units * covariances,
                             rotations)
    upper = columns('cov_xx', 'cov_xy', 'cov_xz', 'cov_yy', 'cov_yz', 'cov_zz')
    covariances = upper[:, [0, 1, 2, 1, 3, 4, 2, 4, 5]].reshape(-1, 3, 3)
    return accuracy.Path(times, scale * positions, scale ** 2 * covariances)


def sight_of(views, rig, tracked):
    """Times of the images while all cameras saw the body, and which of them have a tracked
    point."""
    times = [camera.times + offset for camera, offset in zip(views.cameras, rig.offsets)]
    images = np.sort(np.concatenate(times))
    for own in times:
        last = np.searchsorted(own, images, side='right') - 1
        images = images[(last >= 0) & (images - own[last] <= SIGHT)]
    return images, to_nearest(images, tracked) < SAME_TIME


def gaps_of(times, tracked):
    """Durations of the gaps in sight [s]."""
    gaps = []
    for before, time, good in zip(np.append(-np.inf, times), times, tracked):
        if good:
            start = None
        elif time - before > SIGHT or start is None:
            start = time
            gaps.append(0.0)
        else:
            gaps[-1] = time - start
    return gaps


def score(views, rig, table):
    """Figures of what was tracked; times and errors of the scored points [s, m]."""
    path = path_of(views, rig, table)
    if len(path.times) < 2:
        raise Refusal('the body was never tracked: two cameras must see it together for '
                      'longer')
    images, tracked = sight_of(views, rig, path.times)
    gaps = gaps_of(images, tracked)
    result, times, errors = accuracy.score(path, views.truth, 'similarity')
    result.update(tracked=float(tracked.mean()), gaps=len(gaps),
                  longest_gap_s=max(gaps, default=0.0))
    if len(views.shape) > 1:  # which tells the scale
        result['rigid'] = accuracy.score(path, views.truth, 'rigid')[0]
    return result, times, errors


def evaluate(views, folder):
    """Figures; times and errors of the scored points [s, m] of the middle of the lights."""
    rig = pipeline.calibrate(views, folder)
    result, times, errors = score(views, rig, pipeline.track(views, rig, folder))
    result['smoothed'] = score(views, rig, pipeline.track(views, rig, folder, smooth=True))[0]
    if len(views.shape) > 2:
        result['body'] = score(views, rig, body.track(views, rig, folder))[0]
    names = [camera.name for camera in views.cameras]
    result.update(residual_px=dict(zip(names, rig.residuals.tolist())),
                  clock_offset_ms=dict(zip(names, (1e3 * rig.offsets).tolist())))
    return result, times, errors


def rows_of(result):
    """What is printed and reported: name, value."""
    for way, figures in (('', result), ('smoothed, ', result['smoothed']),
                         ('as a body, ', result.get('body'))):
        if not figures:
            continue
        yield from ((f'{way}{kind}: {name}', f'{own[key] * factor:.2f} {unit}'.strip())
                    for kind, own in (('similarity', figures), ('rigid motion',
                                                                figures.get('rigid')))
                    if own for name, key, factor, unit in FIGURES)
        yield f'{way}scored points', str(figures['points'])
        yield f'{way}scale of the similarity', f'{figures["scale"]:.4f}'
        yield f'{way}tracked while in sight', f'{100.0 * figures["tracked"]:.1f} %'
        yield (f'{way}gaps in sight', f'{figures["gaps"]}, longest '
               f'{figures["longest_gap_s"]:.2f} s')
    for name, residual in result['residual_px'].items():
        yield name, (f'residual {residual:.3f} px, clock offset '
                     f'{result["clock_offset_ms"][name]:.2f} ms')
