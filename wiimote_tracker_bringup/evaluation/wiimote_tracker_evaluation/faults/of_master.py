"""The master or the launcher ends, and the same command is given again."""

from wiimote_tracker_evaluation.faults.fault import fault
from wiimote_tracker_evaluation.faults.of_processes import halted

PATIENCE = 60.0  # for nodes to end [s]
GONE = 3.0       # without a master, or a launcher [s]


@fault(ends=('*',), names_may_change=True, named='master', spends_room=True)
def restart_roscore(room):
    """kill -9 of the master; it is started again, and so is roslaunch."""
    room.kill('roscore')
    yield GONE
    room.end(room.master)
    room.start_master()
    room.start_nodes()
    room.listen()


@fault(ends=('*',), names_may_change=True, spends_room=True)
def kill_roslaunch(room):
    """kill -9 of roslaunch; it is started again."""
    room.kill('roslaunch')
    yield GONE
    room.start_nodes()


@fault(ends=('*',), names_may_change=True, spends_room=True)
def kill_drivers(room):
    """kill -9 of the node that starts the drivers, which ends all; roslaunch is started again."""
    room.kill('/drivers')
    room.launch.wait(PATIENCE)
    yield 0.0
    left = sorted(room.nodes())
    room.start_nodes()
    return [f"left behind: {', '.join(left)}"] if left else []


stop_roscore = halted('roscore', 'the master', 'roscore')
stop_roslaunch = halted('roslaunch', 'roslaunch', 'roslaunch')
stop_drivers = halted('drivers', 'the node that starts the drivers', '/drivers')
