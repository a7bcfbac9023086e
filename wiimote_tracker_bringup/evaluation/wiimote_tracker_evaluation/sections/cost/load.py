"""Processor time of nodes."""

import os
import time
import xmlrpc.client

import numpy as np
import psutil

TICK = 1.0 / os.sysconf('SC_CLK_TCK')  # [s]


def process_of(node):
    """Process id of a node; asks the node."""
    import rosgraph
    uri = rosgraph.Master('/evaluation').lookupNode(node)
    return xmlrpc.client.ServerProxy(uri).getPid('/evaluation')[2]


def processor_time(process: int) -> float:
    """User and kernel time of a process and its threads so far [s]."""
    times = psutil.Process(process).cpu_times()
    return times.user + times.system


def measure(processes, seconds, check, interval=1.0):
    """Load of each process (by name) [share of a core], one value per interval; calls check()."""
    names = list(processes)
    samples = [[processor_time(processes[name]) for name in names]]
    times = [time.monotonic()]
    while times[-1] - times[0] < seconds:
        due = times[0] + interval * len(times)
        while time.monotonic() < due:
            check()
            time.sleep(min(0.1, max(0.0, due - time.monotonic())))
        samples.append([processor_time(processes[name]) for name in names])
        times.append(time.monotonic())
    shares = np.diff(np.array(samples), axis=0) / np.diff(times)[:, None]
    return {name: shares[:, i] for i, name in enumerate(names)}
