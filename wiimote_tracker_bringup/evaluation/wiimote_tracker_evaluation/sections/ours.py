"""Subjects beyond the paper: clocks, occlusion, more cameras, bodies, gestures, an accuracy map."""

from wiimote_tracker_evaluation.ours import (bodies, cameras, gestures, occlusion, unsynchronised,
                                             volume)

NAME = 'ours'
TITLE = 'Beyond the paper'

PARTS = (unsynchronised, occlusion, cameras, volume, bodies, gestures)


def run(run):
    run.compute([command for part in PARTS for command in part.commands(run)],
                'measuring in simulated time', 0.0, 0.9)
    for number, part in enumerate(PARTS):
        run.progress(0.9 + 0.1 * number / len(PARTS), 1.0, 'drawing')
        part.tell(run)
