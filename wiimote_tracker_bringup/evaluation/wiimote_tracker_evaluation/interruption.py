"""Turns the first Ctrl-C, or a similar signal, into an exception."""

import signal

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
