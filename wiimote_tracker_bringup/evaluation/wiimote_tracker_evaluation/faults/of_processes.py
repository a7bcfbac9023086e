"""Processes are killed, or stopped for a while."""

from wiimote_tracker_evaluation.faults.row import fault

DRIVER, TRACKER, MANAGER = '/wiimote_4/driver', '/triangulation', '/manager'
CALIBRATION, GESTURES, WATCH = '/calibration', '/gestures', '/master_watch'
STOPPED = 5.0  # [s]


@fault(quick=True, ends=(DRIVER,))
def kill_driver(room):
    """kill -9 of a driver."""
    room.kill(DRIVER)
    yield 0.0


@fault()
def stop_driver(room):
    """SIGSTOP of a driver for 5 s."""
    with room.stopped(DRIVER):
        yield STOPPED


@fault(quick=True, ends=(TRACKER,))
def kill_tracker(room):
    """kill -9 of the tracker."""
    room.kill(TRACKER)
    yield 0.0


# The tracker then says that time jumped back, and tracks begin anew. Each LED waves nearer to its
# former place than to another's, so names stay, but after 5 s they are doubtful.
@fault(quick=True, named='labels were given again')
def stop_tracker(room):
    """SIGSTOP of the tracker for 5 s."""
    with room.stopped(TRACKER):
        yield STOPPED


@fault(ends=(CALIBRATION,))
def kill_calibration(room):
    """kill -9 of the calibration node."""
    room.kill(CALIBRATION)
    yield 0.0


@fault()
def stop_calibration(room):
    """SIGSTOP of the calibration node for 5 s."""
    with room.stopped(CALIBRATION):
        yield STOPPED


@fault(ends=(GESTURES,))
def kill_gestures(room):
    """kill -9 of the gestures node."""
    room.kill(GESTURES)
    yield 3.0


@fault()
def stop_gestures(room):
    """SIGSTOP of the gestures node for 5 s."""
    with room.stopped(GESTURES):
        yield STOPPED


@fault(ends=(WATCH,))
def kill_master_watch(room):
    """kill -9 of the node that watches the master."""
    room.kill(WATCH)
    yield 3.0


@fault()
def stop_master_watch(room):
    """SIGSTOP of the node that watches the master for 5 s."""
    with room.stopped(WATCH):
        yield STOPPED


IN_ONE = {'one_manager': True}
ALL_IN_ONE = (MANAGER, TRACKER) + tuple(f'/wiimote_{number}/driver' for number in (1, 2, 3, 4))


@fault(room=IN_ONE, ends=ALL_IN_ONE, names_may_change=True)
def kill_manager(room):
    """kill -9 of the nodelet manager with tracker and drivers."""
    room.kill(MANAGER)
    yield 0.0


@fault(room=IN_ONE, ends=ALL_IN_ONE, names_may_change=True)
def stop_manager(room):
    """SIGSTOP of the nodelet manager with tracker and drivers for 5 s."""
    with room.stopped(MANAGER):
        yield STOPPED
