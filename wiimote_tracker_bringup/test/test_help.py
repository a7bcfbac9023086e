"""The programs in Python say what they do, what their parameters are and what they lack, without a
master."""

import os
import signal
import subprocess
import sys

import pytest
import rospy
from wiimote_tracker_bringup import nodes

PACKAGE = os.path.join(os.path.dirname(os.path.realpath(__file__)), '..')
NODES = ('launch/drivers', 'launch/master_watch', 'launch/record_watch',
         'simulation/simulated_hand', 'rig_planning/place_cameras', 'body_motion/probe')
CHECKS = ('launch/check_body', '../wiimote_tracker_msgs/python/check_arguments')
NOWHERE = 'http://localhost:1'


@pytest.mark.parametrize('program, words', zip(NODES, (
    '(default: 10)', 'no parameters', 'no parameters', '[m]', 'needed', '[s] (default: 10)')))
def test_help_tells_the_parameters(program, words):
    done = subprocess.run([sys.executable, os.path.join(PACKAGE, program), '__name:=other',
                           '--help'], capture_output=True, text=True, timeout=60,
                          env=dict(os.environ, ROS_MASTER_URI=NOWHERE))
    assert (done.returncode, done.stderr) == (0, '')
    assert done.stdout.startswith(f'usage: {os.path.basename(program)} ')
    assert words in done.stdout


@pytest.mark.parametrize('address, problem', [
    ('', 'ROS_MASTER_URI is empty, but must be such as http://HOST:11311: correct it'),
    ('htp://x', 'ROS_MASTER_URI is htp://x, but must be such as http://HOST:11311: correct it'),
    ('http://x.invalid:11311', 'there is no ROS master at http://x.invalid:11311: do this')])
def test_a_master_that_cannot_be_used_is_named(monkeypatch, address, problem):
    monkeypatch.setenv('ROS_MASTER_URI', address)
    # The name is refused soon also where no name server answers.
    monkeypatch.setenv('RES_OPTIONS', 'timeout:1 attempts:1')
    assert nodes.master_problem('do this') == problem


@pytest.mark.parametrize('program', NODES)
def test_without_a_master_it_ends_with_what_to_do(program):
    done = subprocess.run([sys.executable, os.path.join(PACKAGE, program)], timeout=60,
                          capture_output=True, text=True,
                          env=dict(os.environ, ROS_MASTER_URI=NOWHERE))
    assert done.returncode == 1
    assert done.stderr == (f'{os.path.basename(program)}: there is no ROS master at {NOWHERE}: '
                           'start roscore or use roslaunch\n')


@pytest.mark.parametrize('program', NODES[:-1] + CHECKS)
def test_one_that_is_ended_while_it_starts_says_nothing(program, tmp_path):
    """As by roslaunch, when another node ends that is required."""
    for module in ('rospy', 'rosgraph', 'rospkg'):
        (tmp_path / f'{module}.py').write_text('import signal, time\n'
                                               'signal.raise_signal(signal.SIGINT)\n'
                                               'time.sleep(60.0)\n')
    path = os.pathsep.join([str(tmp_path), os.environ.get('PYTHONPATH', '')])
    done = subprocess.run([sys.executable, os.path.join(PACKAGE, program)], timeout=60,
                          capture_output=True, text=True, env=dict(os.environ, PYTHONPATH=path))
    assert (done.returncode, done.stdout, done.stderr) == (-signal.SIGINT, '', '')


def test_a_node_that_is_ended_while_it_registers_says_nothing(monkeypatch):
    def interrupted(_):
        raise rospy.ROSInitException('init_node interrupted before it could complete')
    monkeypatch.setattr(sys, 'argv', ['probe'])
    monkeypatch.setattr(nodes, 'master_problem', lambda _: '')
    monkeypatch.setattr(rospy, 'init_node', interrupted)
    with pytest.raises(rospy.ROSInitException):
        nodes.start('probe', '')
    monkeypatch.setattr(rospy, 'is_shutdown', lambda: True)
    with pytest.raises(SystemExit):
        nodes.start('probe', '')


def without(packages, program):
    script = ('import runpy, sys; sys.modules.update(dict.fromkeys(sys.argv[1].split())); '
              'sys.argv = sys.argv[2:]; runpy.run_path(sys.argv[0], run_name="__main__")')
    return subprocess.run([sys.executable, '-c', script, packages, os.path.join(PACKAGE, program)],
                          capture_output=True, text=True, timeout=60)


@pytest.mark.parametrize('program', [
    'benchmark/benchmark_latency', 'body_motion/body_to_base', 'body_motion/evaluate_trajectory',
    'body_motion/probe', 'evaluation/evaluate', 'evaluation/evaluate_recording',
    'evaluation/fault_matrix', 'evaluation/lead_demo', 'evaluation/results_table',
    'rig_planning/place_cameras', 'rig_planning/plan_rig'])
def test_a_program_names_the_python_package_that_it_lacks(program):
    done = without('scipy', program)
    assert done.returncode == 1
    assert done.stderr.endswith('apt install python3-scipy\n')
    assert 'Traceback' not in done.stderr


def test_a_program_names_all_that_are_missing_at_once():
    done = without('matplotlib scipy', 'rig_planning/plan_rig')
    assert done.stderr.endswith('apt install python3-matplotlib python3-scipy\n')
