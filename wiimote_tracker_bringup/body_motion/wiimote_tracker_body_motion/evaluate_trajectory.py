"""evaluate_trajectory: an odometry or SLAM topic against the tracker's."""

import argparse

from wiimote_tracker_body_motion import comparison, mount, poses
from wiimote_tracker_bringup import alignment, files, interruption, ranges


def table(figures):
    """Lines of text."""
    names = [name for name, _ in comparison.STATISTICS]
    yield ' ' * 18 + ''.join(f'{name:>10}' for name in names)
    for name, values in figures.items():
        if isinstance(values, dict):
            yield f'{name:18}' + ''.join(f'{values[each]:10.4f}' for each in names)
    yield f'{figures["poses"]} poses, scale {figures["scale"]:.4f}'
    if figures['left_out']:
        yield figures['left_out']


def draw(compared, file):
    """Both paths from above, and the errors over time."""
    from wiimote_tracker_bringup import charts  # matplotlib may be absent
    figure, (path, errors) = charts.figure(1, 2, height=3.6)
    for each, color, name in ((compared.truth, charts.INK, 'truth'),
                              (compared.estimate, charts.ORANGE, 'estimate')):
        path.plot(each.positions[:, 0], each.positions[:, 1], color=color, label=name)
    path.set(xlabel='x [m]', ylabel='y [m]', aspect='equal')
    charts.key(path)
    start = compared.truth.times[0]
    for name, color in zip([n for n in compared.errors if '[m]' in n], charts.COLORS):
        times = compared.rpe_times if 'RPE' in name else compared.truth.times
        errors.plot(times - start, compared.errors[name], color=color, label=name)
    errors.set(xlabel='time [s]', ylabel='error [m]')
    charts.key(errors)
    charts.save(figure, file)


def run(arguments):
    files.check_distinct([arguments.json, arguments.plot], [arguments.bag, arguments.mount])
    truth = poses.read(arguments.bag, arguments.truth)
    estimate = poses.read(arguments.bag, arguments.estimate)
    offset = arguments.offset
    if arguments.mount:
        mounted = mount.read(arguments.mount)
        truth = truth.of_mounted(mounted.rotation, mounted.translation)
        offset = mounted.offset if offset is None else offset
    compared = comparison.compare(estimate.shifted(offset or 0.0), truth, arguments.alignment,
                                  arguments.interval, arguments.gap)
    figures = compared.figures()
    print('\n'.join(table(figures)))
    files.write_json(arguments.json, figures)
    if arguments.plot:
        draw(compared, arguments.plot)


def main(argv=None):
    parser = argparse.ArgumentParser(
        prog='evaluate_trajectory', description='Absolute and relative errors (ATE, RPE) of a '
        'topic with poses against another, of nav_msgs/Odometry, PoseStamped or '
        'PoseWithCovarianceStamped.')
    parser.add_argument('bag', help='recording of both topics')
    parser.add_argument('--estimate', required=True, metavar='TOPIC', help='to be judged')
    parser.add_argument('--truth', required=True, metavar='TOPIC', help='/<body>/odometry')
    parser.add_argument('--alignment', choices=alignment.KINDS, default='rigid',
                        help='fitted to the positions; absolute: none, rigid: without scale, '
                        'similarity: with scale (default: rigid)')
    parser.add_argument('--mount', metavar='FILE', help='result of body_to_base: where the '
                        'estimated frame is on the body, and its clock offset')
    parser.add_argument('--offset', type=ranges.within(-1e10, 1e10), metavar='S',
                        help='added to the times of the estimate [s] (default: of the mount, or 0)')
    parser.add_argument('--interval', type=ranges.within(0.001, 1e6), default=1.0,
                        metavar='S', help='of the relative error [s] (default: 1)')
    parser.add_argument('--gap', type=ranges.within(0.001, 1e6), default=0.05,
                        metavar='S', help='longest time between two true poses to interpolate [s] '
                        '(default: 0.05)')
    parser.add_argument('--json', metavar='FILE', help='write the figures')
    parser.add_argument('--plot', metavar='FILE', help='write a picture (.png, .svg, .pdf)')
    with interruption.answered('evaluate_trajectory'):
        run(parser.parse_args(argv))
