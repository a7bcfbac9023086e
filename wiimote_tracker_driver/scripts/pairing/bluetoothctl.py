"""A running bluetoothctl, as a person at a terminal would use it.

A terminal of its own (a pseudo-terminal) keeps one session: its agent and its search live as long
as it does, which they would not with one call per command.
"""

import errno
import fcntl
import os
import pty
import re
import select
import struct
import subprocess
import termios
import time

# Colours, and the marks that readline puts around them.
DECORATION = re.compile(r'\x1b\[[0-9;?]*[A-Za-z]|[\x01\x02]')
# "[bluetooth]# ", "[Nintendo RVL-CNT-01]# ", in later versions "[bluetoothctl]> ".
PROMPT = re.compile(r'\[[^\]]*\][#>] ?')
# "[agent] Enter PIN code: " waits at the end of its line.
QUESTION = re.compile(r'.*\[agent\] .*: ')
WIDTH = 250  # [characters] Wide, so that no line is wrapped.


class Bluetoothctl(object):
    """Sends commands and hands out what comes back, line by line, without decoration."""

    def __init__(self, hear=None):
        """Starts bluetoothctl; OSError when there is none. hear: called with every line."""
        self._hear = hear or (lambda line: None)
        self._rest = b''
        self._lines = []
        self._ended = False
        self._terminal, slave = pty.openpty()
        fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack('HHHH', 50, WIDTH, 0, 0))
        try:
            self._process = subprocess.Popen(
                ['bluetoothctl'], stdin=slave, stdout=slave, stderr=slave, close_fds=True,
                env=dict(os.environ, TERM='dumb', LC_ALL='C'))
        except OSError:
            os.close(self._terminal)
            raise
        finally:
            os.close(slave)

    def send(self, command):
        """Types a command."""
        try:
            os.write(self._terminal, command.encode() + b'\n')
        except OSError:
            self._ended = True

    def line(self, timeout):
        """The next line within timeout [s], or None. A prompt, or a question that waits for an
        answer, is a line too."""
        end = time.monotonic() + timeout
        left = timeout
        while not self._lines and not self._ended and left >= 0.0:
            self._read(left)
            left = end - time.monotonic()
        return self._lines.pop(0) if self._lines else None

    @property
    def ended(self):
        """Whether bluetoothctl has ended and all it said has been handed out."""
        return self._ended and not self._lines

    def close(self):
        """Ends bluetoothctl."""
        self.send('quit')
        try:
            self._process.wait(timeout=2.0)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        os.close(self._terminal)

    def _read(self, timeout):
        ready, _, _ = select.select([self._terminal], [], [], timeout)
        if not ready:
            return
        try:
            data = os.read(self._terminal, 4096)
        except OSError as error:
            if error.errno != errno.EIO:  # the way Linux says that the other side is closed
                raise
            data = b''
        if not data:
            self._ended = True
        pieces = re.split(rb'[\r\n]+', self._rest + data)
        self._rest = pieces.pop()  # cut anywhere, also within a colour
        for piece in pieces:
            self._add(_plain(piece))
        rest = _plain(self._rest)
        if PROMPT.fullmatch(rest) or QUESTION.fullmatch(rest):
            self._add(rest)
            self._rest = b''

    def _add(self, text):
        prompt = PROMPT.match(text)
        if prompt and prompt.end() < len(text):
            text = text[prompt.end():]
        text = text.strip()
        if text:
            self._hear(text)
            self._lines.append(text)


def _plain(data):
    return DECORATION.sub('', data.decode(errors='replace'))
