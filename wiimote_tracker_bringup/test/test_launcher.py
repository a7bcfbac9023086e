"""Misspelt arguments of roslaunch, which says nothing of them."""

import os
import shlex
import subprocess
import sys

import pytest
from launch_files import LAUNCH, configuration
from wiimote_tracker_launch import launcher

TRACKER = os.path.join(LAUNCH, 'tracker.launch')
OURS = ['--skip-log-check', 'wiimote_tracker_bringup', 'tracker.launch']


@pytest.mark.parametrize('words, said', [
    (OURS + ['cemeras:=4'], [
        'tracker.launch has no argument cemeras, so cemeras:= has no effect: write cameras:=']),
    ([TRACKER, 'rvitz:=true', 'quux:=1'], [
        'tracker.launch has no argument rvitz, so rvitz:= has no effect: write rviz:=',
        'tracker.launch has no argument quux, so quux:= has no effect: choose one of '
        'roslaunch --ros-args wiimote_tracker_bringup tracker.launch']),
    (['wiimote_tracker_bringup', 'simulated_rig.launch', 'hand:=true', 'mod:=instant'], [
        'simulated_rig.launch has no argument mod, so mod:= has no effect: write mode:=']),
    # What it passes on to calibrate.launch and triangulation.launch.
    (OURS + ['cameras:=a:=b', 'drivers:=false', 'label_places:=a', '__name:=x'], []),
    (OURS + ['label_places:='], [
        'label_places:= has no effect, since roslaunch ignores an empty value: set the parameter '
        'in a file, parameters:=FILE']),
    (OURS + ['rig_file:=', 'parameters:='], []),  # as their defaults
    (['wiimote_tracker_bringup', 'record.launch', 'output:='], [
        'output:= has no effect, since roslaunch ignores an empty value: leave it out']),
    (OURS + ['rig_file:=1.10', 'camera_latency:=0.010', 'labels:=a'], [
        'roslaunch takes rig_file:=1.10 for 1.1: write rig_file:=./1.10']),
    (OURS + ['socket_directory:=true', 'rig_file:=110', 'bodies:=./1.10'], [
        'roslaunch takes socket_directory:=true for True: write socket_directory:=./true']),
    (['wiimote_tracker_triangulation', 'gestures.launch', 'file:=1e3'], [
        'roslaunch takes file:=1e3 for 1000.0: write file:=./1e3']),
    (['wiimote_tracker_bringup', 'record.launch', 'gigabytes:=1.50'], []),  # numbers
    (['wiimote_tracker_bringup', 'mavros_vision.launch', 'rate:=30.50'], []),
    (OURS + ['cemeras:=mine.launch'], [
        'tracker.launch has no argument cemeras, so cemeras:= has no effect: write cameras:=']),
    (['wiimote_tracker_bringup', 'diagnostics.launch', 'rviz:=1'], [
        'diagnostics.launch has no argument rviz, so rviz:= has no effect: leave it out']),
    # Whose arguments are unknown.
    (['my_package', 'tracker.launch', 'cemeras:=4'], []), (['mine.launch', 'cemeras:=4'], []),
    (OURS + ['mine.launch', 'cemeras:=4'], []), ([], [])])
def test_arguments_that_nobody_takes_are_told(words, said):
    assert list(launcher.without_effect(words)) == said


@pytest.mark.parametrize('file, given, meant', [
    ('calibration/calibration', 'rig_fiel', 'rig_file'), ('driver/driver', 'devise', 'device'),
    ('triangulation/gestures', 'fil', 'file'), ('triangulation/record_points', 'cvs', 'csv'),
    ('triangulation/triangulation', 'confg', 'config'),
    ('mavros_vision', 'massage', 'message'), ('plan', 'plain', 'plan'),
    ('record', 'outptu', 'output'), ('replay', 'rat', 'rate'),
    ('robot_localization', 'odometri', 'odometry'), ('calibrate', 'cemeras', 'cameras'),
    ('triangulation', 'labbels', 'labels'), ('rviz', 'check_argument', 'check_arguments')])
@pytest.mark.parametrize('here', [False, True])
def test_launch_files_without_master_watch_tell_it_too(tmp_path, file, given, meant, here):
    package, file = file.split('/') if '/' in file else ('bringup', file)
    packages = os.path.join(LAUNCH, '../../wiimote_tracker_')
    with open(f'{packages}{package}/launch/{file}.launch', encoding='utf-8') as text:
        assert 'type="check_arguments"' in text.read()
    stand_in = tmp_path / 'roslaunch'
    stand_in.write_text('import subprocess, sys\n'
                        'subprocess.call([sys.executable, sys.argv[1]], cwd="/")')
    done = subprocess.run(
        [sys.executable, str(stand_in), packages + 'msgs/python/check_arguments',
         *([] if here else ['wiimote_tracker_' + package]), file + '.launch', given + ':=1'],
        capture_output=True, text=True, timeout=60,
        cwd=f'{packages}{package}/launch' if here else None)
    assert done.stderr == (f'[WARN] {file}.launch has no argument {given}, so {given}:= has no '
                           f'effect: write {meant}:=.\n')


@pytest.mark.parametrize('text, warned', [
    ('calibration: {}\ncoverage: {}\ndrivers: {}\ntriangulation/mode: instant\n', []),
    ('simulated_hand: {calibrate: false}\n/calibraton: {}\nmanager: {}\n', []),
    ('calibration: {yaw: !degrees 90}\n', []),
    ('calibraton: {yaw: 1.0}\ndrivrs/driver: {}\n', ['is called "calibraton", "drivrs": write']),
    ('triangulation: {mode: instant}\npixel_stddev: 0.2\n', ['is called "pixel_stddev": write']),
    ('a: 1\nb: 2\nc: 3\nd: 4\ne: 5\n', ['is called "a", "b", "c" and 2 more: write']),
    ('calibraton: [', []), ('calibraton', []),  # after roslaunch took it
    ('', ['has no parameters']), ('---\n', ['has no parameters']),
    ('# none\n', ['has no parameters'])])
def test_parameters_that_no_node_reads_are_warned_of(tmp_path, text, warned):
    path = tmp_path / 'my.yaml'
    path.write_text(text)
    nodes = ['calibration', 'coverage', 'drivers', 'triangulation']
    warnings = list(launcher.unread(str(path), nodes))
    assert len(warnings) == len(warned)
    for warning, words in zip(warnings, warned):
        assert warning.startswith(str(path)) and words in warning


# Those with drivers and without, and those that the others are part of.
@pytest.mark.parametrize('words, read', [
    ('tracker.launch', ['calibration', 'coverage', 'drivers', 'triangulation']),
    ('tracker.launch drivers:=false', ['calibration', 'coverage', 'drivers', 'triangulation']),
    ('calibrate.launch', ['calibration', 'drivers']),
    ('triangulation.launch', ['coverage', 'triangulation']),
    ('replay.launch bag:=x', ['coverage', 'triangulation']),
    ('several_machines.launch', ['calibration', 'first_drivers', 'second_drivers']),
    ('robot_localization.launch', ['ekf_odom', 'ekf_map'])])
def test_launch_files_warn_of_parameters_that_no_node_reads(tmp_path, words, read):
    (tmp_path / 'my file.yaml').write_text(''.join(name + ': {a: 1}\n' for name in read + ['b']))
    name, *arguments = words.split()
    config = configuration(name, *arguments, f'parameters:={tmp_path}/my file.yaml')
    args, = [node.args for node in config.nodes
             if node.type in ('master_watch', 'check_arguments')]
    said, = launcher.warnings(*shlex.split(args))
    assert said.startswith(f'{tmp_path}/my file.yaml: no node of this launch file is called "b": ')
