"""Boots the guest and hands back what it says."""

import os
import signal
import subprocess
import time

# Instruction counting: each instruction of the guest takes 2 ns of its time, and waiting takes no
# time of ours. So the guest's clock, by which everything is measured, does not depend on how busy
# this machine is, and each run of a scenario is the same. The price is one processor.
COUNTED = ['-accel', 'tcg', '-icount', 'shift=1,sleep=off', '-cpu', 'qemu64', '-smp', '1']
# In real time, on two processors.
EMULATED = ['-accel', 'tcg,thread=multi', '-cpu', 'qemu64', '-smp', '2']
KVM = ['-accel', 'kvm', '-cpu', 'host', '-smp', '2']

KVM_PROOF_LIMIT = 10.0  # [s]


class Run(object):
    """One boot of the guest."""

    def __init__(self, text, seconds, finished):
        self.text = text  # all that the guest said
        self.seconds = seconds  # of this machine's time
        self.finished = finished  # False: it was stopped by the limit, or QEMU failed

    def lines(self):
        return [line.rstrip('\r') for line in self.text.split('\n')]


def boot(parts, initramfs, scenario, accelerator, limit):
    """Boots the guest for one scenario and waits until it switches itself off, at most `limit` [s].
    """
    command = parts.qemu_command() + accelerator + [
        '-M', 'pc', '-m', '256', '-nodefaults', '-no-user-config', '-display', 'none', '-no-reboot',
        '-serial', 'stdio', '-kernel', parts.kernel, '-initrd', initramfs, '-append',
        'console=ttyS0 loglevel=1 panic=-1 nokaslr mitigations=off scenario=' + scenario]
    start = time.monotonic()
    process = subprocess.Popen(command, env=parts.qemu_environment(), stdin=subprocess.DEVNULL,
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                               start_new_session=True)
    finished = True
    try:
        output, _ = process.communicate(timeout=limit)
    except subprocess.TimeoutExpired:
        finished = False
        os.killpg(process.pid, signal.SIGKILL)
        output, _ = process.communicate()
    except BaseException:
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()
        raise
    return Run(output.decode('utf-8', 'replace'), time.monotonic() - start,
               finished and process.returncode == 0)


def kvm_works(parts, initramfs):
    """Whether a guest boots under KVM. That /dev/kvm is there proves nothing."""
    if not os.access('/dev/kvm', os.R_OK | os.W_OK):
        return False
    run = boot(parts, initramfs, 'boot', KVM, KVM_PROOF_LIMIT)
    return run.finished and 'with status 0' in run.text
