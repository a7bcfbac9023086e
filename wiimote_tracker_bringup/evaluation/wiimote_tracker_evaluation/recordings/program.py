"""evaluate_recording: accuracy on recordings that others made."""

import argparse
import html
import io
import json
import os
import sys

from wiimote_tracker_bringup import files, interruption, ranges
from wiimote_tracker_bringup.errors import ExperimentError, sentence_of
from wiimote_tracker_evaluation.recordings import formats


def drawing(outcome):
    """The errors one by one and as a distribution."""
    from wiimote_tracker_bringup import charts  # the Debian package does without matplotlib
    figure, (left, right) = charts.figure(1, 2, height=2.8)
    left.plot(outcome.places, outcome.errors, '.', markersize=2.0, color=charts.BLUE)
    left.set(xlabel=outcome.axis, ylabel=f'error [{outcome.unit}]')
    charts.cumulative(right, outcome.errors, charts.BLUE)
    right.set(xlabel=f'error [{outcome.unit}]', ylabel='share of points')
    return figure


def write_report(title, outcome, folder):
    """report.html: the figures and a drawing()."""
    svg = io.StringIO()
    drawing(outcome).savefig(svg, format='svg')
    rows = ''.join(f'<tr><td>{html.escape(name)}</td><td>{html.escape(value)}</td></tr>'
                   for name, value in outcome.rows)
    os.makedirs(folder, exist_ok=True)
    with open(os.path.join(folder, 'report.html'), 'w', encoding='utf-8') as file:
        file.write(f'<!DOCTYPE html><meta charset="utf-8"><title>{html.escape(title)}</title>'
                   f'<h1>{html.escape(title)}</h1>'
                   f'<p>A real recording. {html.escape(outcome.method)}.</p><table>{rows}</table>'
                   f'{svg.getvalue()[svg.getvalue().index("<svg"):]}\n')


def main():
    parser = argparse.ArgumentParser(
        prog='evaluate_recording', description='Calibrates the cameras of a recording that others '
        'made from what they saw alone, and measures the accuracy: lighthouse: of the path, against '
        'motion capture; cameras: of the path, with rates, offsets and read-out times of '
        'unsynchronised cameras; multicamselfcal: of predicted pixels, and of cameras that were '
        'disturbed and corrected by continuous calibration; bag: of the points that the tracker '
        'makes of a bag of import_multicamselfcal, by their pixels.')
    parser.add_argument('format', choices=sorted(formats.FORMATS), help='of the recording')
    parser.add_argument('recording', help='a folder; for bag, a bag')
    parser.add_argument('--json', metavar='FILE', help='write the figures')
    parser.add_argument('--report', metavar='DIR', help='write a page with plots')
    parser.add_argument('--inlier-px', metavar='PX', type=ranges.within(1e-6, 1e6),
                        help='bag: an observation within this of its projected point is an inlier '
                        '(default: 5)')
    arguments = parser.parse_args()
    if arguments.inlier_px and arguments.format != 'bag':
        parser.error('--inlier-px is for bag only')
    options = {'inlier_px': arguments.inlier_px} if arguments.inlier_px else {}
    try:
        files.check_distinct([arguments.json], [arguments.recording])
        outcome = formats.measure(arguments.format, arguments.recording, **options)
        for name, value in outcome.rows:
            print(f'{name:35} {value}')
        if arguments.json:
            with open(arguments.json, 'w') as file:
                json.dump(outcome.result, file, indent=1)
        if arguments.report:
            title = f'{arguments.format} {os.path.basename(os.path.abspath(arguments.recording))}'
            write_report(title, outcome, arguments.report)
    except KeyboardInterrupt:
        interruption.end('evaluate_recording')
    except ImportError as error:
        sys.exit(f'evaluate_recording: {error}; a report needs matplotlib: apt install '
                 'python3-matplotlib')
    except (ExperimentError, OSError) as error:
        sys.exit(f'evaluate_recording: {sentence_of(error)}')
