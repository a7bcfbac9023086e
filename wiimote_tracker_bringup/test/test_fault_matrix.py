"""The quick form of the fault matrix: every fault is survived. How fast is no matter here."""

import json
import os
import subprocess
import sys

HERE = os.path.dirname(os.path.realpath(__file__))
PROGRAM = os.path.join(HERE, '../evaluation/fault_matrix')
sys.path.insert(0, os.path.join(HERE, '../evaluation'))

LIMIT = 600.0  # on a busy computer [s]


def test_quick_faults_are_survived(tmp_path):
    path = tmp_path / 'faults.json'
    done = subprocess.run([sys.executable, PROGRAM, '--quick', '--json', str(path)],
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True,
                          timeout=LIMIT)
    results = json.loads(path.read_text())
    assert len(results) == 8, done.stdout
    assert [result['problems'] for result in results] == 8 * [[]], done.stdout
    assert done.returncode == 0, done.stdout
