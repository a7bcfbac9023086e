"""body_to_base: where a tracked body sits on a robot, and how their clocks differ."""

import argparse
import sys

import numpy as np

from wiimote_tracker_body_motion import hand_eye, inertial, mount, poses
from wiimote_tracker_bringup import files, interruption, ranges
from wiimote_tracker_bringup.errors import Refusal


def describe(found):
    """Lines of text."""
    stddev = found.stddev()
    values = [('translation', found.translation, stddev[3:6], 1e3, 'mm'),
              ('roll, pitch, yaw', found.rotation.as_euler('xyz'), stddev[:3], 180.0 / np.pi,
               'deg'),
              ('clock offset', [found.offset], stddev[6:], 1e3, 'ms')]
    for name, numbers, errors, factor, unit in values:
        text = ', '.join(f'{factor * number:.2f}' for number in numbers)
        yield f'{name:17} {text} {unit}, +- ' + ', '.join(f'{factor * e:.2f}' for e in errors)
    yield f'rosrun tf2_ros static_transform_publisher {found.transform()}'


def report(sentence):
    print(f'body_to_base: {sentence}', file=sys.stderr, flush=True)


def main(argv=None):
    parser = argparse.ArgumentParser(
        prog='body_to_base', description='Finds where the base of a robot, or an IMU, sits on a '
        'tracked body, and what to add to its stamps, from a bag of a minute in which it turns '
        'about two axes or more.')
    parser.add_argument('bag', help='recording of both topics')
    parser.add_argument('--body', required=True, metavar='TOPIC', help='/<body>/odometry')
    topics = parser.add_mutually_exclusive_group(required=True)
    topics.add_argument('--odom', metavar='TOPIC', help='poses of the base')
    topics.add_argument('--imu', metavar='TOPIC', help='sensor_msgs/Imu; z of the world points up')
    parser.add_argument('--largest-offset', type=ranges.within(0.01, 1e10), default=2.0,
                        metavar='S', help='of the clocks [s] (default: 2)')
    parser.add_argument('--output', metavar='FILE', default='mount.yaml',
                        help='default: mount.yaml; a file that is there is kept as FILE.bak')
    arguments = parser.parse_args(argv)
    with interruption.answered('body_to_base'):
        files.check_distinct([arguments.output], [arguments.bag])
        solver, source, topic = ((hand_eye, poses, arguments.odom) if arguments.odom else
                                 (inertial, inertial, arguments.imu))
        report(f'reads {arguments.bag}')
        body = poses.read(arguments.bag, arguments.body)
        base = source.read(arguments.bag, topic)
        try:
            found = solver.solve(body, base, arguments.largest_offset, report)
        except (ValueError, RuntimeError, np.linalg.LinAlgError) as error:
            raise Refusal(f'no solution was found ({error}); record a minute with turns '
                          'about two axes') from error
        print('\n'.join(describe(found)))
        mount.write(found, arguments.output)
