"""Misspelt arguments of roslaunch, which says nothing of them."""

import os

import pytest
from wiimote_tracker_bringup import launcher

TRACKER = os.path.join(os.path.dirname(os.path.realpath(__file__)), '../launch/tracker.launch')
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
    (OURS + ['cameras:=a:=b', 'drivers:=false', 'label_places:=', '__name:=x'], []),
    # Whose arguments are unknown.
    (['my_package', 'tracker.launch', 'cemeras:=4'], []), (['mine.launch', 'cemeras:=4'], []),
    (OURS + ['mine.launch', 'cemeras:=4'], []), ([], [])])
def test_arguments_that_nobody_takes_are_told(words, said):
    assert list(launcher.without_effect(words)) == said
