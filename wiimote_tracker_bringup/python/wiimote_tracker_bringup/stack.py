"""The full stack on virtual Wii Remotes, for end-to-end sections.

One ROS master and one node of this process serve all of them, since a Python process can be only
one node; each launch ends the previous one.
"""

import os
import re
import shutil
import tempfile

from wiimote_tracker_bringup.files import write_yaml
from wiimote_tracker_bringup.processes import Processes, free_port
from wiimote_tracker_bringup.programs import package_file

_processes = None
_scratch = None
_launched = []


def master(log):
    """Starts the master and makes this process a node, once. log: file for its output."""
    global _processes, _scratch
    if _processes is not None:
        return
    _processes = Processes()
    _scratch = tempfile.mkdtemp(prefix='wiimote_tracker_evaluation_')
    port = free_port()
    os.environ['ROS_MASTER_URI'] = f'http://localhost:{port}'
    os.environ['ROS_HOSTNAME'] = 'localhost'
    os.environ['ROS_HOME'] = _scratch
    _processes.start_master(port, log)
    import rospy  # reads the master's address at import
    rospy.init_node('evaluation', disable_signals=True)


def launch(output, file, **arguments):
    """Starts a launch file of this package (relative path) with its nodes.log in the folder output;
    ends what was launched before. Returns an empty folder for its files."""
    log = os.path.join(output, 'nodes.log')
    master(log)
    stop()
    folder = tempfile.mkdtemp(dir=_scratch)
    path = package_file(file)
    words = ['%s:=%s' % (name, str(value).replace('{folder}', folder))
             for name, value in sorted(arguments.items())]
    _launched.append(_processes.start('roslaunch', ['roslaunch', path] + words, log))
    return folder


def launch_rig(run, name, description, **arguments):
    """Starts the whole system on a rig, with the section's seed. Returns the description's path and
    a Conductor, once all cameras send images."""
    path = run.file(name + '_rig.yaml')
    write_yaml(path, dict(description, seed=run.seed))
    launch(run.folder, 'evaluation/full_stack.launch', description=path, folder='{folder}',
           **arguments)
    # Imported late: rospy reads the master's address at import.
    from wiimote_tracker_bringup.conductor import Conductor
    conductor = Conductor('led', None, check)
    conductor.wait_for_cameras(description['cameras'])
    return path, conductor


def start(output, command):
    """Starts a command beside the launch file, with the same log; end() or the end of the launch
    file stops it."""
    process = _processes.start(command[0], command, os.path.join(output, 'nodes.log'))
    _launched.append(process)
    return process


def record(output, path, *what):
    """Starts rosbag as start() does. what: topics or options that choose them."""
    # Not "rosbag record", a wrapper that can end before the bag is closed.
    return start(output, ['rosrun', 'rosbag', 'record', '--quiet', '--tcpnodelay', '--buffsize=0',
                       '--output-name=' + path, *what])


def end(process):
    """Ends a process of start() in good order."""
    _launched.remove(process)
    _processes.stop(process)


def complaint(output):
    """The last fatal message of a node in nodes.log, to add to a sentence; empty without one."""
    try:
        with open(os.path.join(output, 'nodes.log'), errors='replace') as file:
            said = [line for line in file if 'FATAL' in line]
    except OSError:
        return ''
    return '. A node said: ' + re.sub(r'\x1b\[\d*m|\[FATAL\]|\[[\d.]+\]:', '', said[-1]).strip() \
        if said else ''


def cores():
    return len(os.sched_getaffinity(0))


def check():
    """@raise Refusal: a required process has ended."""
    _processes.check()


def stop():
    """Ends all launched processes except the master."""
    while _launched:
        _processes.stop(_launched.pop())


def stop_all():
    """Ends all processes, including the master."""
    global _processes
    _launched.clear()
    if _processes is not None:
        _processes.stop_all()
        shutil.rmtree(_scratch, ignore_errors=True)
        _processes = None
