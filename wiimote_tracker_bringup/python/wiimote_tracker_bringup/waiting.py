"""Waiting for what other processes do."""

import time
from typing import Callable, Union

from wiimote_tracker_bringup.errors import Refusal


def wait_until(condition: Callable[[], object], timeout: float,
               problem: Union[str, Callable[[], str]], check: Callable[[], None] = lambda: None,
               period: float = 0.02) -> None:
    """Waits until the condition holds. problem: a sentence, or a function that tells it. check:
    called meanwhile, raises if waiting is useless. timeout, period: [s].
    @raise Refusal: not within timeout."""
    deadline = time.monotonic() + timeout
    while not condition():
        check()
        if time.monotonic() > deadline:
            raise Refusal(problem() if callable(problem) else problem)
        time.sleep(period)
