"""The bodies that are published at the ROS master."""

from typing import List

import rosgraph

PATIENCE = 20.0  # [s] A tracker that is started at the same time needs less.
ODOMETRY, POSE, TWIST = '/odometry', '/pose', '/twist'


def names(asker: str) -> List[str]:
    """Those of all namespaces, with their namespaces. asker: a node's name."""
    topics = {topic for topic, _ in rosgraph.Master(asker).getSystemState()[0]}
    found = {topic[:-len(ODOMETRY)] for topic in topics if topic.endswith(ODOMETRY)}
    return sorted(name for name in found if {name + POSE, name + TWIST} <= topics)


def absence(asker: str, body: str, option: str) -> str:
    """What to do where nobody publishes a body, with its namespace; else empty. option: by which
    a person named it. Throws OSError or rosgraph.MasterException if the master has ended."""
    found = names(asker)
    if body in found:
        return ''
    return (f'Nobody publishes {body}{ODOMETRY}: learn this body (learn_body), or name another by '
            f'{option}; there {"are" if found else "is"} {", ".join(found) or "none"}')
