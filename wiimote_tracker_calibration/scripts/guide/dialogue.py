"""Turns keys and words into requests, and passes what comes back to the Guide.

One at a time: until the node has answered a request, only a cancel is accepted.
"""

import queue
from typing import Callable, List, Sequence

from .commands import Command, UsageError, find
from .guide import Advice, Guide

PROPOSED = 'apply'  # What becomes the next command, or no longer is it, at any time.
CHANGED = 'What is next has just changed: read it, then press SPACE or the button again'


class Dialogue:
    def __init__(self, guide: Guide, node, command_list: List[Command],
                 advice: Callable[[], Advice]):
        """node: with send(word, request), call_off_capture() and the queue events."""
        self.guide = guide
        self.node = node
        self.command_list = command_list
        self.advice = advice
        self._next_is_wanted = False
        self._next_shown = None  # the command when it was asked for

    def command(self, word_or_key: str, arguments: Sequence[str] = ()) -> None:
        """Sends a command to the node."""
        command = find(self.command_list, word_or_key)
        if command is None:
            self.guide.say(f'there is no "{word_or_key}"; ? lists all commands')
            return
        if self.guide.running:
            if command.word != 'cancel':
                self.guide.say(f'{self.guide.running[-1]} has not been answered yet; x cancels it')
                return
            if self.guide.running == ['capture']:
                self.node.call_off_capture()
                return
        try:
            request = command.build(self.guide.status, list(arguments))
        except UsageError as error:
            self.guide.say(str(error))
            return
        self.guide.on_request(command.word)
        self.node.send(command.word, request)

    def next(self) -> None:
        """Does what SPACE stands for, as soon as a status is newer than the last answer."""
        self._next_is_wanted = True
        self._next_shown = self.advice().word
        self._do_next()

    def is_busy(self) -> bool:
        """Whether an answer or the next command is outstanding."""
        return bool(self.guide.running) or self._next_is_wanted

    def take_events(self, now: float) -> int:
        """Reads what has come in. Returns how often a bell should ring."""
        rings = 0
        while True:
            try:
                event, *values = self.node.events.get_nowait()
            except queue.Empty:
                break
            rings = max(rings, self._take(event, values, now))
        self._do_next()
        return rings

    def _take(self, event: str, values: list, now: float) -> int:
        """Returns how often a bell should ring for it."""
        guide = self.guide
        if event == 'board':
            return int(guide.on_board(values[0]))
        if event == 'sound':
            return 2 if values[0].data == 'refused' else 1
        if event == 'status':
            guide.on_status(values[0], now)
        elif event == 'feedback':
            guide.feedback, guide.progress = values
        elif event == 'answer':
            guide.on_answer(*values, now)
            if values[0] in ('length', 'known') and values[1] and guide.has_done('solve'):
                self.command('solve')  # to show what it gained
        elif event == 'image_size':
            guide.image_sizes[values[0]] = values[1]
        else:
            setattr(guide, event, values[0])  # verdict, trace
        return 0

    def _do_next(self) -> None:
        guide = self.guide
        is_known = guide.running or guide.status is None or guide.statuses_since_answer > 0
        if not self._next_is_wanted or not is_known:
            return
        self._next_is_wanted = False
        advice = self.advice()
        if advice.word == PROPOSED and self._next_shown != PROPOSED:
            guide.say(CHANGED)
        elif advice.word is not None:
            self.command(advice.word, advice.arguments)
        else:
            guide.say(advice.sentence)
