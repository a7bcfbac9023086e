"""Whether there is a ROS master: rospy would wait for one for ever, even where none can be."""

import os
import sys


def master_problem(advice: str) -> str:
    """Why no ROS master can be used, and what to do; empty if one answers. advice: without one."""
    import rosgraph  # evaluate --help must do without
    address = rosgraph.get_master_uri()
    try:
        is_online = rosgraph.is_master_online()
    except (OSError, ValueError):  # OSError: neither http nor https
        return (f'ROS_MASTER_URI is {address or "empty"}, but must be such as http://HOST:11311: '
                'correct it')
    return '' if is_online else f'there is no ROS master at {address}: {advice}'


def require_master() -> None:
    """Ends the program with what to do if there is no ROS master."""
    problem = master_problem('start roscore or use roslaunch')
    if problem:
        sys.exit(f'{os.path.basename(sys.argv[0])}: {problem}')
