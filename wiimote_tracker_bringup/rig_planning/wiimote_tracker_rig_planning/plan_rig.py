"""plan_rig: where to put the cameras of a room, and how well a rig sees it."""

import argparse
import os
import sys
import time

import numpy as np

from wiimote_tracker_bringup import bound, descriptions, files, interruption, ranges, scene
from wiimote_tracker_bringup.errors import Refusal
from wiimote_tracker_bringup.experiment import NOMINAL_LENS
from wiimote_tracker_bringup.programs import package_file
from wiimote_tracker_rig_planning import picture, plan, prediction, search

ACROSS = 7  # points along an edge of the volume, of what is told
TELL_EVERY = {True: 0.5, False: 10.0}  # how far the search is, on a terminal or in a file [s]


def describe_cameras(positions, targets):
    """Lines that tell a person where to stand and aim each camera."""
    lines = ['camera        at x, y, z [m]          aims at x, y, z [m]     pan    tilt [degrees]']
    for number, (position, target) in enumerate(zip(positions, targets), 1):
        x, y, z = target - position
        lines.append(f'wiimote_{number:<3d}' + '%8.2f%7.2f%7.2f  ' % tuple(position)
                     + '%8.2f%7.2f%7.2f' % tuple(target) + '%8.0f%8.0f' % (
                         np.degrees(np.arctan2(y, x)), np.degrees(np.arctan2(z, np.hypot(x, y)))))
    return lines + ['pan: from the x axis towards y; tilt: above the horizon']


def describe_sight(chosen, names, positions, targets):
    """Lines on what the cameras see of the volume, and how accurately."""
    points = chosen.grid(ACROSS)
    if chosen.body:
        return describe_body(chosen, positions, targets, points)
    seen = prediction.look(chosen, positions, targets, points)
    known = seen.sees.sum(axis=0) >= 2
    errors = 1e3 * np.sqrt(prediction.variances(prediction.information(chosen, seen, None))[known])
    lines = ['  seen by two cameras or more: %.1f %%; by three: %.1f %%'
             % (100 * known.mean(), 100 * (seen.sees.sum(axis=0) >= 3).mean())]
    if not known.any():
        return lines + ['  no place is seen by two cameras: check that the plan is in metres, and '
                        'that the stands are near the volume']
    angles = prediction.widest_angles(seen.sees, positions, points)[known]
    return lines + [
        '  angle between rays: %.0f degrees (median), %.0f (smallest)'
        % (np.median(angles), angles.min()),
        '  standard deviation by the pixels alone: %.1f mm (RMS), %.1f mm (largest%s)'
        % (np.sqrt(np.mean(errors ** 2)), errors.max(),
           '; 500 or more: rays that hardly meet' if errors.max() > 400.0 else ''),
        '  ' + with_calibration(chosen, names, positions, targets, points[known])]


def describe_body(chosen, positions, targets, points):
    """The same of a body."""
    each, located = prediction.target_information(chosen, positions, targets, points, None)
    lines = ['  with four sightings or more, of three LEDs or more: %.1f %% of places and headings'
             % (100 * located.mean())]
    if not located.any():
        return lines
    covariance = np.linalg.inv(each.sum(axis=0)[located] + prediction.prior_information(6))
    place, turn = (np.sqrt(np.trace(covariance[:, part, part], axis1=1, axis2=2))
                   for part in (slice(0, 3), slice(3, 6)))
    return lines + [
        '  standard deviation by the pixels alone: %.1f mm and %.2f degrees (RMS), %.1f mm and '
        '%.2f degrees (largest)' % (1e3 * np.sqrt(np.mean(place ** 2)),
                               np.degrees(np.sqrt(np.mean(turn ** 2))), 1e3 * place.max(),
                               np.degrees(turn.max()))]


def with_calibration(chosen, names, positions, targets, points):
    """A line on the errors after a calibration by the square alone, the Cramér-Rao bound."""
    cameras = [scene.Camera(name, NOMINAL_LENS, scene.look_at(position, target), position,
                            prediction.SIZE)
               for name, position, target in zip(names, positions, targets)]
    corners = chosen.corners()
    for camera in cameras:
        if not camera.sees(corners).all():
            return (f'with a calibration: not told, since {camera.name} does not see all corners '
                    f'of the square of {chosen.square:g} m')
    noise = np.sqrt(max(0.0, chosen.pixel_stddev ** 2 - 1.0 / 12.0))  # without rounding
    rig = scene.Scene(cameras, noise)
    covariance = bound.Calibration(rig, corners, prediction.IMAGES, bound.Knowledge()).covariance
    total = 0.0
    for point in points:
        by_cameras, own = bound.point_sensitivity(rig, covariance, point, 1)
        total += np.trace(by_cameras @ covariance @ by_cameras.T + own)
    return ('with a calibration by the square alone: %.1f mm (RMS)'
            % (1e3 * np.sqrt(total / len(points))))


def description(chosen, positions, targets):
    """A rig for simulated_rig."""
    example = files.read_yaml(package_file('simulation/paper_rig.yaml'))
    like = next(iter(example['cameras'].values()))
    focal_x, focal_y, center_x, center_y, k1 = map(float, NOMINAL_LENS)
    lens = {'fx': focal_x, 'fy': focal_y, 'cx': center_x, 'cy': center_y,
            'distortion': [k1, 0.0, 0.0, 0.0, 0.0]}
    cameras = {f'wiimote_{number}': dict(
        like, identity=f'00:1f:32:00:00:{number:02x}', intrinsics=dict(lens),
        clock=dict(like['clock'], phase=round(0.0013 * number % 0.01, 4)))
        for number in range(1, len(positions) + 1)}
    return descriptions.placed(
        descriptions.with_leds(dict(example, cameras=cameras), [chosen.corners().mean(axis=0)]),
        positions, targets)


def read_description(path):
    """A rig description that can be written to another folder."""
    try:
        rig = descriptions.with_absolute_files(files.read_yaml(path), os.path.dirname(path))
        places_of(rig)
        return rig
    except (AttributeError, KeyError, TypeError, ValueError) as error:
        raise Refusal(f'{path} is no rig description with position and look_at of each '
                      'camera, such as simulation/paper_rig.yaml') from error


def places_of(rig):
    """Names, positions and targets of the cameras of a rig description, one or more. Throws
    ValueError if a place has not three numbers."""
    cameras = rig['cameras']
    return (list(cameras),) + tuple(
        np.stack([np.array(camera[key], dtype=float).reshape(3) for camera in cameras.values()])
        for key in ('position', 'look_at'))


class Progress:
    """How far a search is: one line on a terminal, in a file some."""

    def __init__(self):
        self.told = -np.inf  # when [s]

    def __call__(self, share):
        is_terminal = sys.stderr.isatty()
        if share == 1.0 or time.monotonic() > self.told + TELL_EVERY[is_terminal]:
            self.told = time.monotonic()
            print(('\r' if is_terminal else '') + f'searching: {share:4.0%} ',
                  end='' if is_terminal and share < 1.0 else '\n', file=sys.stderr, flush=True)


def check_folder(path):
    """Before a search of minutes, whose result would be lost. The folder of a file that exists,
    such as /dev/stdout, need not be writable."""
    folder = os.path.dirname(path) or '.'
    if not (os.path.exists(path) or os.path.isdir(folder) and os.access(folder, os.W_OK)):
        raise Refusal(f'{path} cannot be written: {folder} is no folder, or not writable; '
                      'create it, or choose another one')


def run(arguments):
    files.check_distinct([arguments.output, arguments.plot], [arguments.plan])
    chosen = plan.read(arguments.plan)
    for path in filter(None, (arguments.output, arguments.plot)):
        check_folder(path)
    if arguments.score:
        rig = read_description(arguments.score)
        print(arguments.score)
    else:
        places = search.search(chosen, arguments.seed, arguments.generations, Progress())
        print('\n'.join(describe_cameras(*places)))
        rig = description(chosen, *places)
    names, positions, targets = places_of(rig)
    print('\n'.join(describe_sight(chosen, names, positions, targets)))
    if arguments.output:
        files.keep_copy(arguments.output)
        files.write_yaml(arguments.output, rig)
    if arguments.plot:
        picture.draw(chosen, positions, targets, arguments.plot)


def main(argv=None):
    parser = argparse.ArgumentParser(
        prog='plan_rig', description='Proposes where to put the cameras of a room and what to aim '
        'them at, and tells how well they see it.')
    parser.add_argument('plan', help='what the room needs and allows; see config/plan.yaml')
    parser.add_argument('--score', metavar='DESCRIPTION', help='rate this rig description instead '
                        'of searching')
    parser.add_argument('--output', metavar='RIG', help='write a rig description for '
                        'simulated_rig.launch; a file that is there is kept as RIG.bak')
    parser.add_argument('--plot', metavar='FILE', help='write a map (.png, .svg, .pdf)')
    parser.add_argument('--generations', type=ranges.within(1, 10 ** 6, int), default=500,
                        metavar='N', help='of the search; more take longer (default: 500)')
    parser.add_argument('--seed', type=ranges.within(0, 2 ** 32 - 1, int), default=1,
                        metavar='N', help='the same gives the same result (default: 1)')
    with interruption.answered('plan_rig'):
        run(parser.parse_args(argv))
