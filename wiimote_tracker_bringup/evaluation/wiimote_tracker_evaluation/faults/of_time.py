"""Recorded images are played to a second tracker, in a loop, at several speeds."""

import dataclasses
import time

import numpy as np

from wiimote_tracker_evaluation.faults.fault import fault
from wiimote_tracker_evaluation.faults.figures import MOST_ERROR, figures
from wiimote_tracker_evaluation.faults.listener import STAMP, Listener
from wiimote_tracker_evaluation.faults.room import LABELS, LEDS

RECORDED = 3       # [s]
LAST = 8.0         # of the replay [s]
PATIENCE = 30.0    # for the recorder [s]
LEAST_POINTS = 50  # of each LED


def replayed(room, speed):
    """A bag in a loop at a speed, on simulated time, for a tracker of its own."""
    import rosgraph
    begin = time.time()
    bag = room.file('images.bag')
    topics = [f'/{name}/ir_blobs' for name in room.cameras] + ['/calibration/rig']
    room.start(['rosbag/record', '--quiet', f'--duration={RECORDED}', '--output-name=' + bag]
               + topics).wait(PATIENCE)
    truth = room.window(begin, time.time()).truth
    master = rosgraph.Master('/fault_matrix')
    listener = Listener(list(LEDS), 'replayed/points')
    started = []
    try:
        master.setParam('/use_sim_time', True)
        master.setParam('/replayed/triangulation/labels', list(LABELS))
        started = [room.start(command) for command in (
            ['wiimote_tracker_triangulation/triangulation_node', '__ns:=/replayed'],
            ['rosbag/play', '--quiet', '--clock', '--hz=200', '--loop', f'--rate={speed}',
             '--delay=1', '--prefix=/replayed', bag])]
        yield LAST
    finally:
        for process in started:
            room.end(process)
        master.setParam('/use_sim_time', False)
        seen = dataclasses.replace(listener.window(begin, time.time()), truth=truth)
        listener.stop()
    return problems_of(seen, loops=LAST * speed > 2 * RECORDED)


def problems_of(seen, loops):
    problems = []
    result = figures(seen, LAST)
    if len(result.names) < len(LEDS) or result.number < LEAST_POINTS * len(LEDS):
        problems.append(f'only {result.number} points of {len(result.names)} LEDs in the replay')
    elif result.wrong or result.error > MOST_ERROR:
        problems.append(f'{result.wrong} points of the replay were wrong, by up to '
                        f'{1e3 * result.worst:.0f} mm; error {1e3 * result.error:.1f} mm')
    stamps = seen.points[:, STAMP]
    if loops and not (np.diff(stamps) < -0.5 * RECORDED).any():
        problems.append('no points after the first round')
    return problems


@fault(named='time jumped back')
def bag_in_a_loop(room):
    """A bag in a loop for a second tracker."""
    return (yield from replayed(room, 1.0))


@fault()
def time_at_a_tenth(room):
    """A bag at a tenth of its speed, on simulated time, for a second tracker."""
    return (yield from replayed(room, 0.1))


@fault(named='time jumped back')
def time_tenfold(room):
    """A bag at ten times its speed, on simulated time, for a second tracker."""
    return (yield from replayed(room, 10.0))
