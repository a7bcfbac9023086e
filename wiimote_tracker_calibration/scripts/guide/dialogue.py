"""From keys and words to requests; what comes back goes into the Guide.

One at a time: while the node works on a request, others are refused, except to call it off.
"""

import queue

from .commands import UsageError, find


class Dialogue(object):
    def __init__(self, guide, node, command_list, advice):
        """node: with send(word, request), call_off_capture() and the queue events. advice: what to
        do next, a function without arguments."""
        self.guide = guide
        self.node = node
        self.command_list = command_list
        self.advice = advice
        self._next_is_wanted = False

    def command(self, word_or_key, arguments=()):
        """Asks the node for something."""
        command = find(self.command_list, word_or_key)
        if command is None:
            self.guide.say('there is no "%s"; ? lists what there is' % word_or_key)
            return
        if self.guide.running:
            if command.word != 'cancel':
                self.guide.say('%s has not been answered yet; x calls it off'
                               % self.guide.running[-1])
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

    def next(self):
        """What SPACE stands for; as soon as a status tells what the latest answer has led to."""
        self._next_is_wanted = True
        self._do_next()

    def is_busy(self):
        """Whether something is still to be answered or to be done."""
        return bool(self.guide.running) or self._next_is_wanted

    def _do_next(self):
        guide = self.guide
        known = guide.running or guide.status is None or guide.statuses_since_answer > 0
        if not self._next_is_wanted or not known:
            return
        self._next_is_wanted = False
        advice = self.advice()
        if advice.word is not None:
            self.command(advice.word, advice.arguments)
        else:
            guide.say(advice.sentence)

    def take_events(self, now):
        """Reads what has come in. @return whether a bell should ring."""
        ring = False
        while True:
            try:
                event = self.node.events.get_nowait()
            except queue.Empty:
                break
            if event[0] == 'status':
                ring = self.guide.on_status(event[1], now) or ring
            elif event[0] == 'verdict':
                self.guide.verdict = event[1]
            elif event[0] == 'trace':
                self.guide.trace = event[1]
            elif event[0] == 'board':
                ring = self.guide.on_board(event[1]) or ring
            elif event[0] == 'feedback':
                self.guide.on_feedback(event[1], event[2])
            else:
                self.guide.on_answer(event[1], event[2], event[3], now)
        self._do_next()
        return ring
