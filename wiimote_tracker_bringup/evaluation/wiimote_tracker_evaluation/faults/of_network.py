"""A camera on another computer, to which the network fails."""

from wiimote_tracker_evaluation.faults import far_computer
from wiimote_tracker_evaluation.faults.fault import fault

CUT, SLOW = 5.0, 8.0  # for how long [s]
DELAY = 0.2           # [s]
FAR = {'far': ('wiimote_4',)}


@fault(room=FAR, why_not=far_computer.why_not, named='no images')
def network_partition(room):
    """No packet passes between two computers for 5 s; one of them has a camera."""
    room.far.change(cut=True)
    yield CUT
    room.far.change()


@fault(room=FAR, why_not=far_computer.why_not, named='wiimote_4')
def network_delay(room):
    """Each packet between two computers takes 200 ms for 8 s; one of them has a camera."""
    room.far.change(delay=DELAY)
    yield SLOW
    room.far.change()
