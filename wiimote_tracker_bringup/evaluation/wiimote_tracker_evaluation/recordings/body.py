"""The lights of a recording as a body: they are told apart, and its pose is tracked."""

import os

import numpy as np

from wiimote_tracker_bringup import programs
from wiimote_tracker_evaluation.recordings import pipeline
from wiimote_tracker_evaluation.recordings.views import LONGEST_GAP

MEDIAN_SQUARE = 0.4549  # of a normal distribution of variance 1


def track(views, rig, folder):
    """What the body tracker makes of the lights: as pipeline.track()."""
    images, table = (os.path.join(folder, name) for name in ('images.txt', 'body.csv'))
    shape = views.shape / rig.scale(views, views.cameras[0].times + rig.offsets[0])
    seen = sorted((time + offset, number, pixels)
                  for number, (camera, offset) in enumerate(zip(views.cameras, rig.offsets))
                  for time, pixels in zip(camera.times.tolist(), camera.pixels.tolist()))
    with open(images, 'w') as file:
        file.write(words(shape.ravel()) + '\n' + ''.join(
            f'{number} {words([time, *np.ravel(pixels)])}\n' for time, number, pixels in seen))
    programs.run('track_labelled_body', pipeline.lenses_of(views, rig, folder), images, table,
                 '--pixel-stddev', np.hypot(rig.pixel_stddev(), own_noise(views)))
    return programs.read_csv(table)


def words(numbers):
    return ' '.join(repr(float(number)) for number in numbers)


def own_noise(views):
    """Of a coordinate of a light about the middle of all [px], by the bends of its path."""
    squares = []
    for camera in views.cameras:
        about = camera.pixels - camera.centers[:, None]
        near = camera.times[2:] - camera.times[:-2] < 2.0 * LONGEST_GAP
        squares.append((about[:-2] - 2.0 * about[1:-1] + about[2:])[near].ravel() ** 2)
    return float(np.sqrt(np.median(np.concatenate(squares)) / MEDIAN_SQUARE / 6.0))
