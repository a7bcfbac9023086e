"""Time maps of unsynchronised cameras: offset, rate, and the time to read an image out.

    exposure = offset + (1 + drift) * (time - middle) + middle + read_out * line

by the clock of the first camera; line goes from -0.5 (top) to 0.5. The first estimate is the one
for which pairs of cameras come nearest to one epipolar geometry (C. Rao, A. Gritai, M. Shah and
T. Syeda-Mahmood, ICCV 2003). Then the ordinary solver finds the clock offset of each part of a
recording, as if it were a camera of its own: the halves of the image, and the halves of the time.
The offsets of these parts tell what the map lacks.
"""

import dataclasses

import numpy as np

from wiimote_tracker_evaluation.recordings import pipeline

STEP = 0.02  # of the search for an offset [s]
# Of its refinement: offsets [s] and drifts [1] about the best.
NEAR, DRIFTS = np.arange(-0.02, 0.021, 0.002), np.arange(-0.002, 0.0021, 0.00025)
LEAST_COMMON = 0.5  # share of a recording that two cameras must have seen together
ROUNDS = 3  # of the solver
# Mean and standard deviation of what maps have: clocks are good, images are read out within a
# frame.
PRIOR = {'drift': (0.0, 0.001), 'read_out': (0.015, 0.01)}  # [1], [s]
PART = 0.0003  # of the offset of a part [s]


@dataclasses.dataclass
class TimeMap:
    """offset, read_out, middle [s]; drift [1]."""

    middle: float
    offset: float = 0.0
    drift: float = 0.0
    read_out: float = 0.0

    def times(self, camera):
        """Of a camera's images, n [s]."""
        lines = 0.0 if camera.lines is None else camera.lines
        return (camera.times + self.offset + self.drift * (camera.times - self.middle)
                + self.read_out * lines)


def solve(views, folder):
    first = views.cameras[0]
    maps = [TimeMap(0.5 * (camera.times[0] + camera.times[-1])) for camera in views.cameras]
    for camera, each in zip(views.cameras[1:], maps[1:]):
        start(first, camera, each)
    for _ in range(ROUNDS):
        improve(views, maps, 'read_out', folder)
        improve(views, maps, 'drift', folder)
    return maps


def mapped(views, maps):
    """The views by one clock; images in the order of their times."""
    cameras = []
    for camera, each in zip(views.cameras, maps):
        times = each.times(camera)
        order = np.argsort(times)
        cameras.append(part_of(dataclasses.replace(camera, times=times), order))
    return dataclasses.replace(views, cameras=cameras)


def part_of(camera, chosen):
    lines = None if camera.lines is None else camera.lines[chosen]
    return dataclasses.replace(camera, times=camera.times[chosen], pixels=camera.pixels[chosen],
                               lines=lines)


def start(first, camera, each):
    """Offset and drift of a camera against the first."""
    whole = camera.times[-1] - camera.times[0]
    least = LEAST_COMMON * min(whole, first.times[-1] - first.times[0])

    def misfit(offset, drift):
        moved = TimeMap(each.middle, offset, drift).times(camera)
        if min(moved[-1], first.times[-1]) - max(moved[0], first.times[0]) < least:
            return np.inf
        return epipolar_misfit(first, camera, moved)
    offsets = np.arange(first.times[0] - camera.times[-1], first.times[-1] - camera.times[0], STEP)
    about = min(offsets, key=lambda offset: misfit(offset, 0.0))
    _, each.offset, each.drift = min((misfit(about + shift, drift), about + shift, drift)
                                     for shift in NEAR for drift in DRIFTS)


def epipolar_misfit(first, camera, times):
    """How far the pairs of rays depart from one epipolar geometry: the ratio of the squares
    of the two least singular values of the equations of the fundamental matrix."""
    pixels = first.pixels_at(times)[:, 0]
    common = np.isfinite(pixels[:, 0])
    if common.sum() < 20:
        return np.inf
    one, other = homogeneous(pixels[common]), homogeneous(camera.centers[common])
    equations = (one[:, :, None] * other[:, None, :]).reshape(-1, 9)
    values = np.linalg.eigvalsh(equations.T @ equations)
    return values[0] / values[1]


def homogeneous(pixels):
    """Normalised as R. Hartley does (PAMI 19, 1997), n x 3."""
    about = pixels - pixels.mean(axis=0)
    return np.column_stack([about / about.std(), np.ones(len(about))])


def improve(views, maps, attribute, folder):
    """One round of the solver; changes an attribute of the maps, drift or read_out, and offset."""
    together = mapped(views, maps)
    cameras, parts, design = len(maps), [], []
    for number, (camera, each) in enumerate(zip(together.cameras, maps)):
        values = camera.times - each.middle if attribute == 'drift' else camera.lines
        for greater, half in enumerate(halves(values, len(camera.times))):
            part = part_of(camera, half)
            parts.append((number, dataclasses.replace(part, name=f'camera_{len(parts)}')))
            row = np.zeros(2 * cameras + 2)  # of offsets, the attribute, and clocks of the solver
            row[number] = 1.0
            row[cameras + number] = values[half].mean() if values is not None else 0.0
            # Two halves of the time share no instant, and each has a clock of its own.
            row[2 * cameras + (greater if attribute == 'drift' else 0)] = 1.0
            design.append(row)
    design = np.array(design)
    # The clock of the first camera is the common one.
    design[:, 0] = 0.0
    if attribute == 'drift':
        design[:, cameras] = 0.0
    offsets = pipeline.calibrate(together, folder, parts).offsets
    # What the parts do not tell comes from the prior of the attribute.
    mean, stddev = PRIOR[attribute]
    known = np.zeros((cameras, 2 * cameras + 2))
    known[:, cameras:2 * cameras] = np.eye(cameras) * PART / stddev
    missing = [(mean - getattr(each, attribute)) * PART / stddev for each in maps]
    found = np.linalg.lstsq(np.concatenate([design, known]), np.append(offsets, missing),
                            rcond=1e-9)[0]
    for number, (camera, each) in enumerate(zip(views.cameras, maps)):
        each.offset += found[number]
        if number > 0 if attribute == 'drift' else camera.lines is not None:
            setattr(each, attribute, getattr(each, attribute) + found[cameras + number])


def halves(values, number):
    """Masks of the images with lesser and greater values; of all images without values."""
    if values is None:
        return [np.ones(number, dtype=bool)]
    lesser = values < np.median(values)
    return [lesser, ~lesser]
