"""Whether the ROS master can be used: rospy would wait for one for ever, even where none can be."""


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
