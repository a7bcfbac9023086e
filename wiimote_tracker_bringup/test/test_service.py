"""The unit of systemd that the Debian package installs."""

import os
import re
import shlex
import shutil
import subprocess
import sys

import pytest
import roslaunch.arg_dump

BRINGUP = os.path.join(os.path.dirname(os.path.realpath(__file__)), '..')
UNIT = os.path.join(BRINGUP, 'packaging/wiimote-tracker@.service')


def values_of(key):
    with open(UNIT) as file:
        return [line.split('=', 1)[1].strip() for line in file if line.startswith(key + '=')]


@pytest.mark.skipif(not shutil.which('systemd-analyze') or not os.path.exists('/usr/bin/roslaunch'),
                    reason='this computer has no systemd-analyze, or roslaunch elsewhere')
def test_systemd_understands_the_unit(tmp_path):
    instance = tmp_path / 'wiimote-tracker@root.service'
    shutil.copy(UNIT, instance)
    done = subprocess.run(['systemd-analyze', 'verify', str(instance)], stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True)
    if 'Failed to initialize manager' in done.stdout:
        pytest.skip('this systemd checks no unit here, as in a chroot of Debian 11')
    said = [line for line in done.stdout.splitlines() if 'wiimote-tracker' in line]
    assert (done.returncode, said) == (0, [])


def test_the_launch_file_has_the_arguments_of_the_unit():
    launched, = [word for value in values_of('Environment') for word in shlex.split(value)
                 if word.startswith('LAUNCH=')]
    _, file, *given = launched.partition('=')[2].split()
    known = roslaunch.arg_dump.get_args([os.path.join(BRINGUP, 'launch', file)])
    assert {word.split(':=')[0] for word in given} == {'cameras'} <= set(known)
    assert '$LAUNCH $ARGUMENTS' in values_of('ExecStart')[0]


def test_no_variable_of_the_command_is_unset():
    """systemd logs an error about one from version 254 on, as in Debian 13."""
    given = {word.partition('=')[0] for value in values_of('Environment')
             for word in shlex.split(value)}
    assert set(re.findall(r'\$\{?(\w+)', values_of('ExecStart')[0])) <= given | {'HOME'}


def test_each_user_may_have_variables_of_their_own():
    """The later file wins, as where a second user needs another ROS_MASTER_URI."""
    assert values_of('EnvironmentFile') == ['-/etc/default/wiimote-tracker',
                                            '-/etc/default/wiimote-tracker-%i']


def test_relative_paths_begin_in_the_home_folder(tmp_path):
    assert values_of('WorkingDirectory') == ['~']
    roslaunch_stand_in = [sys.executable, '-c', 'import os; print(os.environ["PWD"])']
    words = [word.replace('${HOME}', str(tmp_path))
             for word in shlex.split(values_of('ExecStart')[0])]
    place = words.index('/usr/bin/roslaunch')
    done = subprocess.run(words[:place] + roslaunch_stand_in, capture_output=True, text=True,
                          env={'HOME': str(tmp_path)}, timeout=60)
    assert (done.stdout, done.stderr) == (f'{tmp_path}\n', '')


def test_a_tracker_without_its_master_is_started_again():
    """roslaunch then ends with status 0, as it does when the node that starts the drivers dies."""
    assert values_of('Restart') == ['always']


def test_the_package_has_the_unit():
    with open(os.path.join(BRINGUP, 'scripts/package')) as file:
        script = file.read()
    assert os.path.basename(UNIT) in script and 'wiimote-tracker.p*' in script


def test_a_purge_removes_what_the_unit_leaves():
    with open(os.path.join(BRINGUP, 'packaging/wiimote-tracker.postrm')) as file:
        script = file.read()
    assert f'rm -rf /var/log/{values_of("LogsDirectory")[0].split("/")[0]}\n' in script
    wanted = f'/etc/systemd/system/{values_of("WantedBy")[0]}.wants/wiimote-tracker@*.service'
    assert f'rm -f {wanted}\n' in script
