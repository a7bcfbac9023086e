"""The fault that kills the master starts another one."""

from wiimote_tracker_bringup.processes import Processes, free_port
from wiimote_tracker_evaluation.faults import of_master
from wiimote_tracker_evaluation.faults.room import Room


class MasterAlone(Room):
    """A room without nodes."""

    def __init__(self, processes, log):
        self._processes, self._port, self.log = processes, free_port(), log

    def start_nodes(self):
        pass

    def listen(self):
        pass


def test_a_killed_master_is_started_again(tmp_path, monkeypatch):
    processes = Processes()
    room = MasterAlone(processes, str(tmp_path / 'log'))
    monkeypatch.setenv('ROS_MASTER_URI', f'http://localhost:{room._port}')
    try:
        room.start_master()
        killed = room.master
        course = of_master.restart_roscore.cause(room)
        next(course)
        killed.wait()
        assert next(course, 'over') == 'over'
        assert room.master is not killed and room.master.poll() is None
    finally:
        processes.stop_all()
