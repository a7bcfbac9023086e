"""Runs bluetoothctl in a pseudo-terminal.

One process serves the whole session, because its agent and its scan end with it.
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
from typing import Callable, Optional

# Colours, and the marks of readline around them.
DECORATION = re.compile(r'\x1b\[[0-9;?]*[A-Za-z]|[\x01\x02]')
# "[bluetooth]# ", "[Nintendo RVL-CNT-01]# ", in later versions "[bluetoothctl]> ".
PROMPT = re.compile(r'\[[^\]]*\][#>] ?')
# Such as "[agent] Enter PIN code: ", without a line end.
QUESTION = re.compile(r'.*\[agent\] .*: ')
WIDTH = 250  # characters; avoids wrapped lines


class Bluetoothctl:
    """Sends commands and returns the output line by line, without decoration."""

    def __init__(self, hear: Optional[Callable[[str], None]] = None):
        """Starts bluetoothctl; raises FileNotFoundError when it is missing, or another OSError.
        hear: called with each line."""
        self._hear = hear or (lambda line: None)
        self._rest = b''
        self._lines = []
        self._ended = False
        self._asked = False  # a question of the agent is open
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

    def send(self, command: str) -> None:
        """Sends a command, or the answer to a question."""
        self._asked = False
        try:
            os.write(self._terminal, command.encode() + b'\n')
        except OSError:
            self._ended = True

    def line(self, timeout: float) -> Optional[str]:
        """The next line within timeout [s], or None. Prompts and questions count as lines."""
        end = time.monotonic() + timeout
        left = timeout
        while not self._lines and not self._ended and left >= 0.0:
            self._read(left)
            left = end - time.monotonic()
        return self._lines.pop(0) if self._lines else None

    @property
    def ended(self) -> bool:
        """Whether bluetoothctl has ended and all its lines have been returned."""
        return self._ended and not self._lines

    def close(self) -> None:
        """Ends bluetoothctl. An open question is not answered: "quit" would be sent as a PIN."""
        if self._asked:
            self._process.terminate()
        else:
            self.send('quit')
        try:
            self._process.wait(timeout=2.0)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        os.close(self._terminal)

    def _read(self, timeout: float) -> None:
        ready, _, _ = select.select([self._terminal], [], [], timeout)
        if not ready:
            return
        try:
            data = os.read(self._terminal, 4096)
        except OSError as error:
            if error.errno != errno.EIO:  # Linux: the other side is closed
                raise
            data = b''
        if not data:
            self._ended = True
        pieces = re.split(rb'[\r\n]+', self._rest + data)
        self._rest = pieces.pop()  # may end within an escape sequence
        for piece in pieces:
            self._add(_plain(piece))
        rest = _plain(self._rest)
        if PROMPT.fullmatch(rest) or QUESTION.fullmatch(rest):
            self._asked = bool(QUESTION.fullmatch(rest))
            self._add(rest)
            self._rest = b''

    def _add(self, text: str) -> None:
        prompt = PROMPT.match(text)
        if prompt and prompt.end() < len(text):
            text = text[prompt.end():]
        text = text.strip()
        if text:
            self._hear(text)
            self._lines.append(text)


def _plain(data: bytes) -> str:
    return DECORATION.sub('', data.decode(errors='replace'))
