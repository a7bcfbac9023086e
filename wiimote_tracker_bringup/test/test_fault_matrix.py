"""The quick form of the fault matrix: every fault is survived. How fast is no matter here."""

import json
import os
import subprocess
import sys
import types

import pytest

from wiimote_tracker_bringup.errors import Refusal
from wiimote_tracker_evaluation.faults import fault, matrix, room

PROGRAM = os.path.join(os.path.dirname(os.path.realpath(__file__)), '../evaluation/fault_matrix')
LIMIT = 600.0  # on a busy computer [s]


def test_a_fault_that_cannot_be_caused_does_not_end_the_others():
    def cannot_be_tracked():
        raise subprocess.CalledProcessError(32, 'mount')
    tried = object.__new__(matrix.Matrix)
    tried._log, tried._kind = None, {}
    tried._room = types.SimpleNamespace(wait_until_tracked=cannot_be_tracked, stop=lambda: None)
    result = tried.run(fault.Fault('full_disk', 'The disk is full', None))
    assert len(result.problems) == 1 and 'mount' in result.problems[0]


def test_a_problem_says_how_to_keep_what_the_nodes_said():
    """The room's own folder is gone when the sentence is read."""
    empty = types.SimpleNamespace(nodes=dict, log='/tmp/gone/nodes.log')
    with pytest.raises(Refusal, match='the node /driver does not run; with --log FILE'):
        room.Room.pid(empty, '/driver')


@pytest.mark.parametrize('option', ['--json', '--log'])
def test_a_file_that_cannot_be_written_is_named_at_once(option, tmp_path, capsys):
    with pytest.raises(SystemExit):
        matrix.parse([option, str(tmp_path / 'nowhere' / 'file')])
    assert 'nowhere/file: No such file' in capsys.readouterr().err


def test_quick_faults_are_survived(tmp_path):
    path = tmp_path / 'faults.json'
    done = subprocess.run([sys.executable, PROGRAM, '--quick', '--json', str(path)],
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          timeout=LIMIT)
    results = json.loads(path.read_text())
    quick = sorted(fault.name for fault in matrix.FAULTS if fault.quick)
    assert sorted(result['name'] for result in results) == quick, done.stdout
    assert not any(result['problems'] for result in results), done.stdout
    assert done.returncode == 0, done.stdout
