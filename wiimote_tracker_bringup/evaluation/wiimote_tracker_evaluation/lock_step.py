"""Sends synchronised blobs through the real tracker, an instant at a time, and collects its points.

An instant is sent only when the one before has come out, so that nothing can be lost in a queue and
the result does not depend on the speed of the machine.
"""

import contextlib
import os
import queue
import signal
import socket
import sys
import time

import roslaunch
import rospkg
import rospy
from wiimote_tracker_msgs.msg import IrBlobArray, RigCalibration, TrackedPointArray

# Longest wait for something that takes milliseconds when all is well [s].
DEADLINE = 30.0


class ReplayError(Exception):
    """The replay cannot go on; the text says why, and what to do."""


def free_port():
    with socket.socket() as probe:
        probe.bind(('localhost', 0))
        return probe.getsockname()[1]


@contextlib.contextmanager
def output_to_stderr():
    """What this process and its children write to the standard output goes to the error output."""
    sys.stdout.flush()
    kept = os.dup(1)
    os.dup2(2, 1)
    try:
        yield
    finally:
        sys.stdout.flush()
        os.dup2(kept, 1)
        os.close(kept)


def interrupt(_number, _frame):
    raise KeyboardInterrupt


@contextlib.contextmanager
def private_tracker():
    """Starts a ROS master of its own and the triangulation nodelet; ends both at the end.

    Raises ReplayError when they cannot be started.
    """
    port = free_port()
    os.environ['ROS_MASTER_URI'] = 'http://localhost:%d/' % port
    for variable in ('ROS_IP', 'ROS_HOSTNAME', 'ROS_NAMESPACE'):
        os.environ.pop(variable, None)
    launch_file = os.path.join(rospkg.RosPack().get_path('wiimote_tracker_bringup'), 'launch',
                               'triangulation.launch')
    parent = roslaunch.parent.ROSLaunchParent(
        roslaunch.rlutil.get_or_generate_uuid(None, False), [launch_file], is_core=True, port=port,
        verbose=False, show_summary=False)
    with output_to_stderr():
        try:
            parent.start()
            # roslaunch's own handlers end its processes, but let this one wait for them for ever.
            for number in (signal.SIGINT, signal.SIGTERM):
                signal.signal(number, interrupt)
            if parent.pm.is_shutdown:
                raise KeyboardInterrupt
            rospy.init_node('replay_report', disable_signals=True, disable_rosout=True)
            yield
        except roslaunch.RLException as error:
            raise ReplayError('the tracker cannot be started: %s' % error)
        finally:
            rospy.signal_shutdown('done')
            parent.shutdown()


def wait_for(condition, what):
    """Returns when the condition holds. Raises ReplayError naming `what` after DEADLINE."""
    end = time.monotonic() + DEADLINE
    while not condition():
        if time.monotonic() > end:
            raise ReplayError('%s within %g s; see the output of the nodelet' % (what, DEADLINE))
        time.sleep(0.005)


def replay(rig, instants):
    """Points the tracker at the current master publishes: one TrackedPointArray per instant.

    rig: RigCalibration. instants: lists of IrBlobArray, each with one array per camera of the rig,
    all with the same stamp; in the order of their stamps. Raises ReplayError when the tracker does
    not listen or leaves an instant out.
    """
    names = [camera.name for camera in rig.cameras]
    for blobs in instants:
        if (sorted(b.camera for b in blobs) != sorted(names) or
                len({b.header.stamp for b in blobs}) != 1):
            raise ReplayError('the bag is not a synchronised recording: at %.6f s it must hold one '
                              'image of each camera of the rig (%s)'
                              % (blobs[0].header.stamp.to_sec(), ', '.join(names)))
    outputs = queue.Queue()
    listener = rospy.Subscriber('points', TrackedPointArray, outputs.put)
    rig_publisher = rospy.Publisher('calibration/rig', RigCalibration, latch=True, queue_size=1)
    publishers = {name: rospy.Publisher(name + '/ir_blobs', IrBlobArray, queue_size=100,
                                        tcp_nodelay=True) for name in names}
    rig_publisher.publish(rig)
    wait_for(lambda: listener.get_num_connections() > 0, 'the tracker did not offer its points')
    for name, publisher in publishers.items():
        wait_for(lambda: publisher.get_num_connections() > 0,
                 'the tracker did not listen to %s/ir_blobs' % name)
    results = []
    for blobs in instants:
        for b in blobs:
            publishers[b.camera].publish(b)
        results.append(output_of(blobs[0].header.stamp, outputs))
    if not outputs.empty():
        raise ReplayError('the tracker published more than one result per instant')
    for connection in [listener, rig_publisher] + list(publishers.values()):
        connection.unregister()
    return results


def output_of(stamp, outputs):
    try:
        points = outputs.get(timeout=DEADLINE)
    except queue.Empty:
        raise ReplayError('the tracker published nothing for the instant %.6f s within %g s'
                          % (stamp.to_sec(), DEADLINE))
    if abs((points.header.stamp - stamp).to_sec()) > 1e-6:
        raise ReplayError('the tracker published the instant %.6f s where %.6f s was due'
                          % (points.header.stamp.to_sec(), stamp.to_sec()))
    return points


