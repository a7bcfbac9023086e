"""Boots the guest and returns its output."""

import os
import subprocess
import time
from dataclasses import dataclass
from typing import List

from fetch import Parts

# Instruction counting: each instruction of the guest takes 2 ns of its time, and its waits are
# skipped. So the guest's clock does not depend on this machine's load, and runs are repeatable. It
# works with one processor only.
COUNTED = ['-accel', 'tcg', '-icount', 'shift=1,sleep=off', '-cpu', 'qemu64', '-smp', '1']
# In real time, on two processors.
EMULATED = ['-accel', 'tcg,thread=multi', '-cpu', 'qemu64', '-smp', '2']
KVM = ['-accel', 'kvm', '-cpu', 'host', '-smp', '2']

KVM_PROOF_LIMIT = 10.0  # [s]

_running = set()  # processes of guests


@dataclass
class Run:
    """One boot of the guest."""

    text: str        # output of the guest
    seconds: float   # of this machine's time
    finished: bool   # False: stopped by the limit, or QEMU failed

    def lines(self) -> List[str]:
        return [line.rstrip('\r') for line in self.text.split('\n')]


def boot(parts: Parts, initramfs: str, scenario: str, accelerator: List[str], limit: float) -> Run:
    """Boots the guest for one scenario and waits until it powers off, at most `limit` [s]."""
    command = parts.qemu_command() + accelerator + [
        '-M', 'pc', '-m', '256', '-nodefaults', '-no-user-config', '-display', 'none', '-no-reboot',
        '-serial', 'stdio', '-kernel', parts.kernel, '-initrd', initramfs, '-append',
        'console=ttyS0 loglevel=1 panic=-1 nokaslr mitigations=off scenario=' + scenario]
    start = time.monotonic()
    process = subprocess.Popen(command, env=parts.qemu_environment(), stdin=subprocess.DEVNULL,
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    _running.add(process)
    finished = True
    try:
        output, _ = process.communicate(timeout=limit)
    except subprocess.TimeoutExpired:
        finished = False
        process.kill()
        output, _ = process.communicate()
    except BaseException:
        process.kill()
        process.wait()
        raise
    finally:
        _running.discard(process)
    return Run(output.decode('utf-8', 'replace'), time.monotonic() - start,
               finished and process.returncode == 0)


def stop_all() -> None:
    """Ends all guests, which other threads wait for."""
    for process in list(_running):
        process.kill()


def kvm_works(parts: Parts, initramfs: str) -> bool:
    """Whether a guest boots under KVM: /dev/kvm may exist and not work."""
    if not os.access('/dev/kvm', os.R_OK | os.W_OK):
        return False
    run = boot(parts, initramfs, 'boot', KVM, KVM_PROOF_LIMIT)
    return run.finished and 'with status 0' in run.text
