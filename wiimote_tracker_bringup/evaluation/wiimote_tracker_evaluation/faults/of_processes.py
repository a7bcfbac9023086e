"""Processes are killed, or stopped for a while."""

import dataclasses

from wiimote_tracker_evaluation.faults.fault import Fault

DRIVER, TRACKER, MANAGER = '/wiimote_4/driver', '/triangulation', '/manager'
CALIBRATION, GESTURES, WATCH = '/calibration', '/gestures', '/master_watch'
STOPPED = 5.0  # [s]
IN_ONE = {'one_manager': True}


def killed(name, what, node, last=0.0, **how):
    """kill -9 of a node. last: until its end is judged [s]; how: other fields of the Fault."""
    def cause(room):
        room.kill(node)
        yield last
    return Fault('kill_' + name, f'kill -9 of {what}', cause, ends=(node,), **how)


def halted(name, what, node, **how):
    """SIGSTOP of a node."""
    def cause(room):
        with room.stopped(node):
            yield STOPPED
    return Fault('stop_' + name, f'SIGSTOP of {what} for {STOPPED:.0f} s', cause, **how)


def in_one_manager(other, name):
    """Another fault where drivers and tracker are in one process."""
    return dataclasses.replace(other, name=name, room=IN_ONE, quick=False,
                               what='The same, with drivers and tracker in one process')


FAULTS = (
    killed('driver', 'a driver', DRIVER, quick=True),
    halted('driver', 'a driver', DRIVER),
    # The tracker then says that time jumped back, and tracks begin anew. Each LED waves nearer to
    # its former place than to another's, so names stay, but after 5 s they are doubtful. This comes
    # before the tracker (or its manager) is killed, after which they may be doubtful already.
    halted('tracker', 'the tracker', TRACKER, quick=True, named='labels may be wrong'),
    killed('tracker', 'the tracker', TRACKER, quick=True),
    killed('calibration', 'the calibration node', CALIBRATION),
    halted('calibration', 'the calibration node', CALIBRATION),
    killed('gestures', 'the gestures node', GESTURES, 3.0),
    halted('gestures', 'the gestures node', GESTURES),
    killed('master_watch', 'the node that watches the master', WATCH, 3.0),
    halted('master_watch', 'the node that watches the master', WATCH),
    halted('manager', 'the nodelet manager with tracker and drivers', MANAGER, quick=True,
           room=IN_ONE, named='labels may be wrong'),
    killed('manager', 'the nodelet manager with tracker and drivers', MANAGER, quick=True,
           room=IN_ONE))
