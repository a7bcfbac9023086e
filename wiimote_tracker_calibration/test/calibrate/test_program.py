"""The program itself, without a ROS master."""

import os
import pty
import signal
import subprocess
import sys

import pytest

PROGRAM = os.path.join(os.path.dirname(os.path.realpath(__file__)), '../../scripts/calibrate')


def test_without_a_master_it_ends_with_what_to_do():
    done = subprocess.run([sys.executable, PROGRAM], timeout=60,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True,
                          env=dict(os.environ, ROS_MASTER_URI='http://localhost:1'))
    assert (done.returncode, done.stdout) == (1, '')
    assert done.stderr.startswith('there is no ROS master at http://localhost:1: start the ')
    assert done.stderr.count('\n') == 1


@pytest.mark.parametrize('option, length, refusal', [
    ('--wand', '10', '--wand needs a length above 0 and at most 5 m'),
    ('--wand', '0,5', 'argument --wand: the length must be a number such as 2.5, not "0,5"'),
    ('--side', '2,5', 'argument --side: the length must be a number such as 2.5, not "2,5"')])
def test_a_length_that_cannot_be_is_refused(option, length, refusal):
    done = subprocess.run([sys.executable, PROGRAM, option, length], timeout=60,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True)
    assert (done.returncode, done.stdout) == (2, '')
    assert refusal in done.stderr


@pytest.mark.parametrize('name', ['', 'no_such_terminal'])
def test_an_unknown_terminal_is_named(name):
    master, terminal = pty.openpty()
    try:
        done = subprocess.run([sys.executable, PROGRAM], timeout=60, stdin=terminal,
                              stdout=terminal, stderr=subprocess.PIPE, universal_newlines=True,
                              env=dict(os.environ, TERM=name))
    finally:
        os.close(terminal)
        os.close(master)
    assert done.returncode == 1
    assert f'"{name}"' in done.stderr and 'use --plain' in done.stderr
    assert done.stderr.count('\n') == 1


def test_ctrl_c_at_the_start_prints_nothing(tmp_path):
    (tmp_path / 'rosgraph.py').write_text('import os, signal, time\n'
                                          'os.kill(os.getpid(), signal.SIGINT)\n'
                                          'time.sleep(60.0)\n')
    path = os.pathsep.join([str(tmp_path), os.environ.get('PYTHONPATH', '')])
    done = subprocess.run([sys.executable, PROGRAM], timeout=60, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, env=dict(os.environ, PYTHONPATH=path))
    assert (done.returncode, done.stdout, done.stderr) == (-signal.SIGINT, b'', b'')


# The program with a node that is silent, interrupted again while Python ends.
INTERRUPTED = """
import atexit, os, queue, signal, sys, types
from importlib import machinery, util
loader = machinery.SourceFileLoader('calibrate', sys.argv.pop(1))
program = util.module_from_spec(util.spec_from_loader(loader.name, loader))
loader.exec_module(program)
program.master_problem = lambda _: ''
program.rospy.init_node = lambda *arguments, **options: None
program.Node = lambda: types.SimpleNamespace(events=queue.Queue())
atexit.register(lambda: os.kill(os.getpid(), signal.SIGINT))
sys.exit(program.main())
"""


def test_ctrl_c_twice_prints_no_traceback():
    with subprocess.Popen([sys.executable, '-c', INTERRUPTED, PROGRAM, '--plain'],
                          stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          universal_newlines=True) as program:
        assert program.stdout.readline().startswith('Type a word')  # now it runs
        program.send_signal(signal.SIGINT)
        said = program.stdout.read(), program.stderr.read()
        assert program.wait(60) == -signal.SIGINT
    assert said[1] == '' and '; this took ' in said[0].splitlines()[-1]
