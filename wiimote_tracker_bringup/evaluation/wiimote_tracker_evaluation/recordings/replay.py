"""A bag of import_multicamselfcal through the tracker, instant by instant and as tracks: how well
the points explain the pixels, camera by camera, beside the solution that was shipped with it."""

import copy
import itertools
import os
import tempfile

import genpy
import numpy as np
import rosbag
from wiimote_tracker_msgs.msg import TrackedPoint

from wiimote_tracker_bringup.errors import Refusal
from wiimote_tracker_evaluation.recordings import pipeline, reprojection
from wiimote_tracker_evaluation.recordings.solved_rig import camera_of

# The cameras were synchronised, the tracker takes each image by itself: in tracks, what all of an
# instant's images say comes out when their times differ by this much from camera to camera [ns].
BETWEEN_CAMERAS = 1000


def instant_of(stamp):
    """[ns], to 0.1 ms: the tracker's own times are floating-point seconds."""
    return int(round(stamp.to_nsec(), -5))


class Bag:
    """What a bag of import_multicamselfcal holds."""

    def __init__(self, path):
        self.rig, self.reference_rig, self.reference_points = None, None, {}
        blobs = []
        try:
            with rosbag.Bag(path) as bag:
                for topic, message, _ in bag.read_messages():
                    if topic == '/calibration/rig':
                        self.rig = message
                    elif topic == '/reference/rig':
                        self.reference_rig = message
                    elif topic == '/reference/points':
                        self.reference_points.update(positions([message]))
                    elif topic.endswith('/ir_blobs'):
                        blobs.append(message)
        except rosbag.ROSBagException as error:
            raise Refusal(f'{path} cannot be read ({error}); if it was not closed, repair '
                          'it with rosbag reindex') from error
        if self.rig is None or not blobs:
            raise Refusal(f'{path} holds no /calibration/rig or no ir_blobs: make it with '
                          'import_multicamselfcal')
        blobs.sort(key=lambda b: (b.header.stamp, b.camera))
        self.start = blobs[0].header.stamp - genpy.Duration(0, 100000000)
        self.instants = [list(group)
                         for _, group in itertools.groupby(blobs, lambda b: b.header.stamp)]
        self.pixels = {
            instant_of(instant[0].header.stamp): {
                b.camera: (b.blobs[0].x, b.blobs[0].y) for b in instant if len(b.blobs) == 1}
            for instant in self.instants}


def positions(arrays, states=(TrackedPoint.TENTATIVE, TrackedPoint.TRACKED)):
    """{instant_of(stamp): (x, y, z)} of the point that most cameras saw; the last word of each
    instant. Only points in these states that were seen then."""
    found = {}
    for array in arrays:
        seen = [p for p in array.points
                if p.state in states and
                instant_of(p.last_observed) == instant_of(array.header.stamp)]
        if seen:
            point = max(seen, key=lambda p: p.rays_used)
            found[instant_of(array.header.stamp)] = (point.position.x, point.position.y,
                                                     point.position.z)
    return found


def track(recorded, mode):
    """What track_bag makes of a Bag: TrackedPointArrays."""
    with tempfile.TemporaryDirectory() as folder:
        source = os.path.join(folder, 'in.bag')
        with rosbag.Bag(source, 'w') as bag:
            bag.write('/calibration/rig', recorded.rig, recorded.start)
            for instant in recorded.instants:
                for number, blobs in enumerate(instant):
                    image = copy.copy(blobs)
                    image.header = copy.copy(blobs.header)
                    if mode == 'tracks':
                        image.header.stamp += genpy.Duration(0, number * BETWEEN_CAMERAS)
                        image.arrival = image.header.stamp
                    bag.write(f'/{image.camera}/ir_blobs', image, image.arrival)
        with rosbag.Bag(pipeline.track_light(source, folder, mode)) as bag:
            return [message for _, message, _ in bag.read_messages(topics='/points')]


def evaluate(path, inlier_px=reprojection.INLIER_PX):
    """Figures, and the published points."""
    recorded = Bag(path)
    arrays, tracked = (track(recorded, mode) for mode in ('instant', 'tracks'))
    if not arrays:
        raise Refusal(f'{path} is too short: it ends before the tracker has heard all cameras of '
                      'the rig, or waited for them')
    points, in_tracks = positions(arrays), positions(tracked, [TrackedPoint.TRACKED])

    def errors(rig, located):
        return reprojection.errors([camera_of(camera) for camera in rig.cameras], located,
                                   recorded.pixels)
    of_tracks = errors(recorded.rig, in_tracks)
    result = {
        'instants': len(recorded.instants),
        'instants_seen_by_two': sum(len(seen) >= 2 for seen in recorded.pixels.values()),
        'points': len(points),
        'method': arrays[0].method,
        'inlier_px': inlier_px,
        'points_in_tracks': len(in_tracks),
        'tracks_confirmed': len({p.id for array in tracked for p in array.points
                                 if p.state == TrackedPoint.TRACKED}),
        'published_points': [{'time': 1e-9 * instant, 'position': list(points[instant])}
                             for instant in sorted(points)],
        'published': reprojection.per_camera(errors(recorded.rig, points), inlier_px),
        'tracks': reprojection.per_camera(of_tracks, inlier_px),
        'tracked_instants_with_an_outlier': len({
            instant for own in of_tracks.values() for instant, error in own.items()
            if error > inlier_px})}
    if recorded.reference_rig is not None:
        shipped = recorded.reference_points
        result['shipped_method'] = recorded.reference_rig.method
        result['shipped'] = reprojection.per_camera(errors(recorded.reference_rig, shipped),
                                                    inlier_px)
        apart = [1e3 * np.linalg.norm(np.subtract(points[t], shipped[t]))
                 for t in points if t in shipped]
        result['published_to_shipped_mm'] = {
            'median': float(np.median(apart)), 'p95': float(np.percentile(apart, 95))
        } if apart else None
    return result


def remark(result):
    """Why the figures say little of a bag that others made, and what to do; else empty."""
    if result['points'] == 0:
        return ('no instant has a point: check that the rig of the bag is that of its images, and '
                'in metres')
    if result['published']['all']['observations'] == 0:
        return ('nothing can be compared: only images with exactly one spot are; for several LEDs '
                'or a body, see the residuals in the table of track_bag --csv')
    if result['instants_seen_by_two'] == 0:
        return ('the cameras are not synchronised, as those of import_multicamselfcal are: each '
                'point is compared with one camera at a time; track_bag --csv gives residuals over '
                'all')
    return ''


def rows_of(result):
    """What is printed and reported: name, value."""
    yield 'instants', ('{instants}, {instants_seen_by_two} seen by two cameras or more'
                       .format(**result))
    yield 'points instant by instant', '{points} ({method})'.format(**result)
    yield 'points in tracks', ('{points_in_tracks} in {tracks_confirmed} tracks, '
                               '{tracked_instants_with_an_outlier} with an outlier'
                               .format(**result))
    if remark(result):
        yield 'note', remark(result)
    for camera in result['published']:
        for solution in ('published', 'tracks', 'shipped'):
            if solution in result:
                yield f'{camera}, {solution}', reprojection.sentence(result[solution][camera],
                                                                     result['inlier_px'])
    if 'shipped' in result:
        yield 'shipped', result['shipped_method']
        if result['published_to_shipped_mm']:
            yield 'published to shipped points', 'median {median:.3f}, p95 {p95:.3f} mm'.format(
                **result['published_to_shipped_mm'])
