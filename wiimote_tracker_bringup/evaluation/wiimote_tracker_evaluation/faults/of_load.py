"""A computer that has too much to do."""

import multiprocessing
import os

from wiimote_tracker_evaluation.faults.row import fault

LAST = 8.0  # [s]


def loop_forever():
    while True:
        pass


@fault()
def busy_loops(room):
    """Two busy loops for each core, for 8 s."""
    fork = multiprocessing.get_context('fork')
    loops = [fork.Process(target=loop_forever, daemon=True)
             for _ in range(2 * len(os.sched_getaffinity(0)))]
    for loop in loops:
        loop.start()
    yield LAST
    for loop in loops:
        loop.kill()


@fault(room={'cameras': 32, 'one_manager': True})
def many_cameras(room):
    """32 cameras, drivers and tracker in one process."""
    yield LAST
