"""Ctrl-C and its relatives as an exception, once."""

import signal

SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


class Interrupted(BaseException):
    """The user wants to stop."""


def raise_when_interrupted() -> None:
    """From now on."""
    for number in SIGNALS:
        signal.signal(number, interrupt)


def interrupt(number, frame):
    # A second signal must not disturb the clearing up.
    for each in SIGNALS:
        signal.signal(each, signal.SIG_IGN)
    raise Interrupted()
