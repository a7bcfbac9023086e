"""A computer that has too much to do."""

import multiprocessing
import os

from wiimote_tracker_evaluation.faults.fault import fault
from wiimote_tracker_evaluation.faults.helper import Helper
from wiimote_tracker_evaluation.faults.of_processes import in_one_manager
from wiimote_tracker_evaluation.faults.room import DARK

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


busy_loops_in_one_manager = in_one_manager(busy_loops, 'busy_loops_in_one_manager')


def answer_lights(pipe):
    """Switches all dark LEDs on or off, as each question says."""
    import rospy
    from wiimote_tracker_msgs.srv import SetLed
    rospy.wait_for_service('simulation/set_led', 30.0)
    set_led = rospy.ServiceProxy('simulation/set_led', SetLed)
    while True:
        on = pipe.recv()
        pipe.send([set_led(led=led, on=on).success for led in DARK])


# A camera shows four of them, so that an LED may be lost to the cameras.
@fault(room={'dark': True}, names_may_change=True)
def sixteen_leds(room):
    """13 more LEDs for 8 s; a camera shows the four brightest."""
    with Helper(answer_lights) as helper:
        problems = [] if all(helper.ask(True)) else ['not all LEDs shone']
        yield LAST
        helper.ask(False)
    return problems


@fault(room={'cameras': 32, 'one_manager': True})
def many_cameras(room):
    """32 cameras, drivers and tracker in one process."""
    yield LAST


@fault(room={'cameras': 64, 'one_manager': True})
def very_many_cameras(room):
    """64 cameras, drivers and tracker in one process."""
    yield LAST
