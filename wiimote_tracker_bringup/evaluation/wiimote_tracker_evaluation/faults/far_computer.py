"""Another computer: a network namespace, and a cable to it that can be cut or made slow."""

import fcntl
import heapq
import itertools
import multiprocessing
import os
import select
import shutil
import signal
import struct
import subprocess
import time

_FORK = multiprocessing.get_context('fork')
_COUNT = itertools.count()
TUN = '/dev/net/tun'
TUNSETIFF, IFF_TUN, IFF_NO_PI = 0x400454ca, 0x1, 0x1000
PACKET = 65536  # longest [bytes]


def why_not():
    """Why there can be no such computer here; empty: there can."""
    if os.geteuid() != 0:
        return 'only root can make a network namespace'
    if not shutil.which('ip'):
        return 'the program ip is missing (package iproute2)'
    try:
        FarComputer().stop()
    except (OSError, subprocess.CalledProcessError) as error:
        return f'no network namespace or tunnel can be made: {error}'
    return ''


class FarComputer:
    """here, there: addresses of this computer and of the other one."""

    def __init__(self):
        number = (os.getpid() + next(_COUNT)) % 250
        self.here, self.there = f'10.213.{number}.1', f'10.213.{number}.2'
        self._name = f'wiimote_tracker_{number}'
        near, far = f'wtnear{number}', f'wtfar{number}'
        ends = []
        _ip('netns', 'add', self._name)
        try:
            for name in (near, far):
                ends.append(_tunnel(name))
            _ip('link', 'set', far, 'netns', self._name)
            _ip('address', 'add', self.here, 'peer', self.there, 'dev', near)
            _ip('link', 'set', near, 'up')
            _ip('-n', self._name, 'address', 'add', self.there, 'peer', self.here, 'dev', far)
            for device in ('lo', far):
                _ip('-n', self._name, 'link', 'set', device, 'up')
        except Exception:
            _ip('netns', 'delete', self._name)
            raise
        else:
            self._pipe, pipe = _FORK.Pipe()
            self._cable = _FORK.Process(target=_carry, args=(ends, pipe), daemon=True)
            self._cable.start()
        finally:
            for end in ends:
                os.close(end)

    def prefix(self):
        """Of a command that shall run there."""
        return ['ip', 'netns', 'exec', self._name, 'env', f'ROS_HOSTNAME={self.there}']

    def change(self, delay=0.0, cut=False):
        """From its return on. delay: of each packet, in both directions [s]. cut: packets are
        lost."""
        self._pipe.send((delay, cut))
        self._pipe.recv()

    def stop(self):
        self._cable.kill()
        self._cable.join()
        _ip('netns', 'delete', self._name)


def _ip(*arguments):
    subprocess.run(('ip',) + arguments, check=True, stderr=subprocess.PIPE)


def _tunnel(name):
    """A network device; what is sent through it is read from the file descriptor."""
    end = os.open(TUN, os.O_RDWR | os.O_NONBLOCK)
    fcntl.ioctl(end, TUNSETIFF, struct.pack('16sH', name.encode(), IFF_TUN | IFF_NO_PI))
    return end


def _carry(ends, pipe):
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.SIG_IGN)  # stop() ends it, after the nodes
    delay, cut = 0.0, False
    waiting, order = [], itertools.count()  # (due, order, end, packet)
    others = {ends[0]: ends[1], ends[1]: ends[0]}
    while True:
        patience = max(0.0, waiting[0][0] - time.monotonic()) if waiting else None
        for source in select.select(ends + [pipe], [], [], patience)[0]:
            if source is pipe:
                delay, cut = pipe.recv()
                pipe.send(None)
                continue
            packet = os.read(source, PACKET)
            if not cut:
                heapq.heappush(waiting, (time.monotonic() + delay, next(order), others[source],
                                         packet))
        while waiting and waiting[0][0] <= time.monotonic():
            _, _, end, packet = heapq.heappop(waiting)
            try:
                os.write(end, packet)
            except OSError:
                pass  # its device is not ready; a packet may be lost
