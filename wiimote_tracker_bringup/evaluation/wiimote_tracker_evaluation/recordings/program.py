"""evaluate_recording: accuracy on recordings that others made."""

import argparse

from wiimote_tracker_bringup import files, interruption, ranges
from wiimote_tracker_evaluation.recordings import formats, replay, reprojection


def main():
    parser = argparse.ArgumentParser(
        prog='evaluate_recording', description='Calibrates the cameras of a recording that others '
        'made from what they saw alone, and measures the accuracy: lighthouse: of the path, '
        'against motion capture; cameras: of the path, with rates, offsets and read-out times of '
        'unsynchronised cameras; multicamselfcal: of predicted pixels, and of cameras that were '
        'disturbed and corrected by continuous calibration; bag: of the points that the tracker '
        'makes of a bag of import_multicamselfcal, by their pixels.')
    parser.add_argument('format', choices=sorted([*formats.FORMATS, 'bag']),
                        help='of the recording')
    parser.add_argument('recording', help='a folder; for bag, a bag')
    parser.add_argument('--json', metavar='FILE', help='write the figures')
    parser.add_argument('--inlier-px', metavar='PX', type=ranges.within(1e-6, 1e6),
                        default=reprojection.INLIER_PX,
                        help='bag: an observation within this of its projected point is an inlier '
                        '(default: %(default)s)')
    arguments = parser.parse_args()
    with interruption.answered('evaluate_recording'):
        files.check_distinct([arguments.json], [arguments.recording])
        if arguments.format == 'bag':
            result = replay.evaluate(arguments.recording, arguments.inlier_px)
            rows = replay.rows_of(result)
        else:
            outcome = formats.measure(arguments.format, arguments.recording)
            result, rows = outcome.result, outcome.rows
        for name, value in rows:
            print(f'{name:35} {value}')
        files.write_json(arguments.json, result)
