"""Programs that start others end with status 130 after each signal that asks for their end."""

import os
import signal
import time

import program_module
import pytest
from wiimote_tracker_bringup import interruption
from wiimote_tracker_evaluation import evaluation
from wiimote_tracker_evaluation.demo import lead_demo
from wiimote_tracker_evaluation.faults import matrix

benchmark_latency = program_module.load('benchmark/benchmark_latency')
# Each with what it calls first of all.
PROGRAMS = [(evaluation, evaluation, 'evaluate'), (lead_demo, lead_demo, 'Demo'),
            (matrix, matrix, 'Matrix'), (benchmark_latency, benchmark_latency.stack, 'master')]


@pytest.fixture(autouse=True)
def handlers():
    before = {number: signal.getsignal(number) for number in interruption.SIGNALS}
    yield
    for number, handler in before.items():
        signal.signal(number, handler)


@pytest.mark.parametrize('number', interruption.SIGNALS)
@pytest.mark.parametrize('program, module, first', PROGRAMS)
def test_a_signal_gives_status_130(program, module, first, number, monkeypatch, capsys):
    def work(*_, **__):
        os.kill(os.getpid(), number)
        time.sleep(60.0)  # at the latest here
    monkeypatch.setattr(module, first, work)
    monkeypatch.setattr('sys.argv', ['program'])
    with pytest.raises(SystemExit, match='^130$'):
        program.main()
    assert capsys.readouterr().err.endswith(': interrupted\n')
