"""How programs end after Ctrl-C, or a similar signal, and after an error."""

import contextlib
import signal
import sys

from wiimote_tracker_bringup.errors import Refusal, sentence_of

EXIT_STATUS = 130  # as a shell gives it for a program that SIGINT ended
SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


def raise_when_interrupted() -> None:
    """From now on the first of SIGNALS raises KeyboardInterrupt."""
    for number in SIGNALS:
        signal.signal(number, interrupt)


def interrupt(number, frame):
    # A second signal must not disturb the cleanup.
    for each in SIGNALS:
        signal.signal(each, signal.SIG_IGN)
    raise KeyboardInterrupt


@contextlib.contextmanager
def answered(program: str):
    """A block after which the program ends, in words, if it is interrupted or refuses its input;
    any other exception is a mistake of the program, and shows where."""
    try:
        yield
    except KeyboardInterrupt:
        print(f'{program}: interrupted', file=sys.stderr)
        sys.exit(EXIT_STATUS)
    except (Refusal, OSError) as error:
        sys.exit(f'{program}: {sentence_of(error)}')
