"""Reprojection errors of points; shares no code with the tracker."""

import numpy as np

# Largest reprojection error of an inlier [px].
INLIER_PX = 5.0


def errors(cameras, points, pixels):
    """{camera: {instant: px}} over all observations of instants that have a point.

    points: {instant: (x, y, z)}; pixels: {instant: {camera: (u, v)}}. A point behind a camera that
    saw it has an infinite error.
    """
    found = {}
    for camera in cameras:
        instants = [each for each in sorted(points) if camera.name in pixels.get(each, {})]
        away = (camera.project(np.reshape([points[each] for each in instants], (-1, 3)))
                - np.reshape([pixels[each][camera.name] for each in instants], (-1, 2)))
        distances = np.linalg.norm(away, axis=1)
        distances[np.isnan(distances)] = np.inf
        found[camera.name] = dict(zip(instants, distances.tolist()))
    return found


def figures(distances, inlier_px=INLIER_PX):
    """Statistics of reprojection errors [px]. RMS: sqrt(mean(du^2 + dv^2))."""
    if not distances:
        return {'observations': 0, 'inliers': 0, 'rms': None, 'median': None, 'mean': None,
                'p95': None}
    d = np.asarray(distances, dtype=float)
    return {'observations': len(d), 'inliers': int((d <= inlier_px).sum()),
            'rms': float(np.sqrt((d ** 2).mean())), 'median': float(np.median(d)),
            'mean': float(d.mean()), 'p95': float(np.percentile(d, 95))}


def per_camera(found, inlier_px=INLIER_PX):
    """figures() of errors() by camera, and of all cameras as 'all'."""
    result = {name: figures(list(own.values()), inlier_px) for name, own in found.items()}
    result['all'] = figures([each for own in found.values() for each in own.values()], inlier_px)
    return result


def sentence(figures, inlier_px=INLIER_PX):
    if not figures['observations']:
        return 'no observation'
    return ('median {median:.3f}, mean {mean:.3f}, RMS {rms:.3f}, p95 {p95:.3f} px, {inliers} of '
            '{observations} within {inlier_px:g} px'.format(inlier_px=inlier_px, **figures))
