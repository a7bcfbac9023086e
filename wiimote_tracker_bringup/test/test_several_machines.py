"""The distribution of nodes when the tracker runs on several computers."""

import os
import shlex

import roslaunch.core
from launch_files import configuration
from rosgraph_msgs.msg import Log
from wiimote_tracker_bringup import cameras_file

HERE = os.path.dirname(os.path.realpath(__file__))
CONFIG = os.path.join(HERE, '../config')


def load(*arguments):
    return configuration('several_machines.launch', *arguments)


def test_drivers_run_near_the_remotes_and_the_rest_here():
    config = load('first:=192.0.2.1', 'second:=192.0.2.2', 'user:=tracker',
                  'first_cameras:=/etc/a.yaml')
    machines = {node.name: node.machine_name for node in config.nodes}
    assert machines.pop('first_drivers') == 'first'
    assert machines.pop('second_drivers') == 'second'
    assert {'calibration', 'triangulation', 'master_watch'} <= set(machines)
    assert not any(machines.values())
    assert 'drivers' not in machines, 'none here'
    for name, address in (('first', '192.0.2.1'), ('second', '192.0.2.2')):
        machine = config.machines[name]
        assert (machine.address, machine.user) == (address, 'tracker')
        assert not roslaunch.core.is_machine_local(machine)
        assert machine.env_loader, 'without one, a node far away has no environment'
    assert config.params['/first_drivers/file'].value == '/etc/a.yaml'


def test_why_drivers_end_far_away_is_shown_here():
    node, = [node for node in load('first:=192.0.2.1').nodes if node.name == 'far_log']
    assert not node.machine_name and node.output == 'screen'
    words = shlex.split(node.args)
    shown = words[words.index('--filter') + 1]
    for level, name, is_shown in (
            (Log.FATAL, '/first_drivers', True), (Log.WARN, '/wiimote_1/driver', True),
            (Log.INFO, '/first_drivers', False), (Log.FATAL, '/calibration', False)):
        assert eval(shown, {'m': Log(level=level, name=name)}) == is_shown


def test_without_arguments_everything_runs_here():
    machines = load().machines
    assert machines and 'far_log' not in [node.name for node in load().nodes]
    assert all(roslaunch.core.is_machine_local(machine) for machine in machines.values())


def test_the_tracker_takes_its_arguments():
    params = load('mode:=instant', 'bodies:=/etc/bodies.yaml', 'side_length:=2.5').params
    assert params['/triangulation/mode'].value == 'instant'
    assert params['/triangulation/bodies/file'].value == '/etc/bodies.yaml'
    assert params['/calibration/side_length'].value == 2.5
    assert params['/use_sim_time'].value is False


def test_the_lists_fit_to_one_adapter_each_and_name_no_camera_twice():
    names = []
    for file in ('first_machine.yaml', 'second_machine.yaml'):
        devices = cameras_file.read_devices(os.path.join(CONFIG, file), '')
        assert devices
        assert cameras_file.too_many(devices, 1) is None
        names += [name for name, _ in devices]
    assert len(names) == len(set(names))
