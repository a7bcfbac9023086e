"""Reprojection errors of points, from rig and blob messages; shares no code with the tracker."""

import numpy as np

# Largest reprojection error of an inlier [px].
INLIER_PX = 5.0


def rotation_matrix(quaternion):
    """3x3 matrix of a geometry_msgs/Quaternion."""
    x, y, z, w = np.array([quaternion.x, quaternion.y, quaternion.z, quaternion.w]) / np.sqrt(
        quaternion.x ** 2 + quaternion.y ** 2 + quaternion.z ** 2 + quaternion.w ** 2)
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


def project(camera, point):
    """Pixel (u, v) of a world point [m] in a CameraCalibration; None behind the camera."""
    if camera.distortion_model != 'plumb_bob':
        raise ValueError(f'{camera.name}: the distortion model {camera.distortion_model} is not '
                         'supported')
    pose = camera.world_from_camera
    center = np.array([pose.position.x, pose.position.y, pose.position.z])
    x, y, z = rotation_matrix(pose.orientation).T @ (np.asarray(point) - center)
    if z <= 0.0:
        return None
    x, y = x / z, y / z
    k1, k2, p1, p2, k3 = (list(camera.distortion) + 5 * [0.0])[:5]
    r2 = x * x + y * y
    radial = 1 + k1 * r2 + k2 * r2 ** 2 + k3 * r2 ** 3
    return np.array([
        camera.fx * (x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x)) + camera.cx,
        camera.fy * (y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y) + camera.cy])


def errors(rig, points, pixels):
    """{camera name: [px, ...]} over all observations of instants that have a point.

    points: {instant: (x, y, z)}; pixels: {instant: {camera name: (u, v)}}. A point behind a camera
    that saw it has an infinite error.
    """
    found = {camera.name: [] for camera in rig.cameras}
    for instant in sorted(points):
        for camera in rig.cameras:
            pixel = pixels.get(instant, {}).get(camera.name)
            if pixel is None:
                continue
            projected = project(camera, points[instant])
            found[camera.name].append(
                np.inf if projected is None else float(np.hypot(*(projected - pixel))))
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


def instants_with_an_outlier(rig, points, pixels, inlier_px=INLIER_PX):
    """How many instants have an observation farther than inlier_px from its projected point."""
    return sum(any(distance > inlier_px for own in errors(rig, {instant: point}, pixels).values()
                   for distance in own)
               for instant, point in points.items())


def per_camera(rig, points, pixels, inlier_px=INLIER_PX):
    """figures() by camera name, and of all cameras as 'all'."""
    by_camera = errors(rig, points, pixels)
    result = {name: figures(distances, inlier_px) for name, distances in by_camera.items()}
    result['all'] = figures([d for distances in by_camera.values() for d in distances], inlier_px)
    return result
