"""How nodes begin: the ROS master, and their private parameters."""

import argparse
import sys
from typing import Dict, List, Set

from wiimote_tracker_launch.master import master_problem

from wiimote_tracker_bringup.errors import Refusal


def start(name: str, documentation: str, arguments: str = '') -> List[str]:
    """Makes the program a node. Answers --help; ends the program, with what to do, if there is no
    ROS master. Returns its arguments, which are refused where they have no name here."""
    import rospy
    parser = argparse.ArgumentParser(
        prog=name, description=documentation, formatter_class=argparse.RawDescriptionHelpFormatter)
    if arguments:
        parser.add_argument(arguments, nargs='*')
    given = parser.parse_args(rospy.myargv()[1:])
    problem = master_problem('start roscore or use roslaunch')
    if problem:
        sys.exit(f'{name}: {problem}')
    try:
        rospy.init_node(name)
    except rospy.ROSInitException:
        if rospy.is_shutdown():  # Ctrl-C meanwhile
            sys.exit(1)
        raise
    return getattr(given, arguments, [])


def refuse_unknown(given: Dict, known: Set[str]) -> None:
    """Throws Refusal if one of these private parameters is misspelt; the master keeps
    it."""
    import rospy
    for name in sorted(set(given) - known):
        parameter = rospy.resolve_name('~' + name)
        raise Refusal(f'unknown parameter {parameter}: correct its spelling, and remove it '
                      f'from the master by: rosparam delete {parameter}')


def number(parameter: str, default: float, least: float, most: float) -> float:
    """The value of a parameter. Throws Refusal if it is no number within the range."""
    import rospy
    value = rospy.get_param(parameter, default)
    if isinstance(value, (int, float)) and not isinstance(value, bool) and least <= value <= most:
        return value
    raise Refusal(f'{rospy.resolve_name(parameter)} is {value!r}, but must be within '
                  f'{least} and {most}: correct it')
