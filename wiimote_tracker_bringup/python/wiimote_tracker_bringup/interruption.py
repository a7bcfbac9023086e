"""How programs end after Ctrl-C, or a similar signal: the first is turned into an exception."""

import signal
import sys
from typing import NoReturn

EXIT_STATUS = 130  # as a shell gives it for a program that SIGINT ended
SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


class Interrupted(BaseException):
    """The user wants to stop."""


def raise_when_interrupted() -> None:
    """Installs the signal handlers."""
    for number in SIGNALS:
        signal.signal(number, interrupt)


def interrupt(number, frame):
    # A second signal must not disturb the cleanup.
    for each in SIGNALS:
        signal.signal(each, signal.SIG_IGN)
    raise Interrupted()


def end(program: str) -> NoReturn:
    """Of a program that Ctrl-C has interrupted."""
    print(f'{program}: interrupted', file=sys.stderr)
    sys.exit(EXIT_STATUS)
