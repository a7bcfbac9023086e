"""Where a person stands in the calibration; the node says what to do next.

Takes messages, answers and the time; uses neither ROS nor a terminal.
"""

from dataclasses import dataclass, field
from typing import Dict, List, Optional, Sequence

from .commands import in_words

SILENT_AFTER = 3.0  # [s] The node publishes its status twice a second.
FOUND_WITHIN = 3.0  # [s] Longest search for a node that runs.
KEPT = 20  # Statuses during which an answer stays whatever happens: 10 s.
LOST = ('The calibration node was started again: what was captured, or solved and not saved, is '
        'lost. Start again.')
# The command for each CalibrationStatus.next_request.
WORDS = {'learn_masks': 'masks', 'check_connection': 'connection', 'start': 'start',
         'capture_corner': 'capture', 'start_wave': 'wave', 'stop_wave': 'wave', 'solve': 'solve',
         'save': 'save', 'continuous/apply': 'apply'}
# What a person uses to ask for something: keys on the screen, words line by line.
KEYS = {'next': 'SPACE', 'connection': 'k', 'solve': 's', 'save': 'v', 'check': 'c', 'quit': 'q',
        'cancel': 'x', 'side': 'n asks for the side', 'length': 'w asks for the length'}
PLAIN_WORDS = {'next': 'The word next', 'connection': 'The word connection',
               'solve': 'The word solve', 'save': 'The word save', 'check': 'check X Y Z',
               'quit': 'The word quit', 'cancel': 'the word cancel',
               'side': 'start METRES gives the side', 'length': 'wave METRES begins'}


@dataclass
class Advice:
    """What to do next, and the command that SPACE or `next` stands for (None: no command)."""
    sentence: str
    word: Optional[str] = None
    arguments: List[str] = field(default_factory=list)


class Guide:
    """All that the screen is drawn from. Times [s] are of one steady clock."""

    def __init__(self, now: float, start: Sequence[str] = (), asking: Dict[str, str] = KEYS):
        """start: arguments of `start` that SPACE uses. asking: KEYS or PLAIN_WORDS."""
        self._start = list(start)
        self.asking = asking
        self.began = now
        self.status = None
        self.status_at = None
        self.statuses_since_answer = 0
        self.verdict = None
        self.trace = None       # of the principal points' correction
        self.board = None
        self.image_sizes = {}   # name of a camera -> (width, height) [px]
        self.answer = ''
        self._answered_at = ''  # next_title then
        self.answers = []       # (good, text) of all answers
        self.measured = ''      # the answer to the last length or known place
        self.elsewhere = ''     # what to do if the node runs in another namespace only
        self.lost = ''          # LOST from then on until the next request
        self.running = []       # words of the commands that have not been answered
        self.feedback = ''
        self.progress = 0.0
        self._done = {}         # word of a command -> number of its last good answer
        self._started_at = None
        self._square_at = None  # when the last corner was captured
        self._saved_at = None

    # --- What comes in

    def on_status(self, status, now: float) -> None:
        before = self.status
        self.status = status
        if before is not None and status.message != before.message:
            self.answer = ''  # the node's message is newer
        if self.statuses_since_answer < 2:  # the first may have been on its way
            self._answered_at = status.next_title
        elif self.statuses_since_answer > KEPT and status.next_title != self._answered_at:
            self._answered_at = status.next_title
            self.answer = ''  # of another situation
        if before is not None and status.header.seq < before.header.seq and (
                status.READY <= before.step <= status.SOLVED):
            self.lost = LOST  # Another publisher counts anew.
        self.status_at = now
        self.statuses_since_answer += 1
        self._keep_time(before, status, now)

    def on_board(self, board) -> bool:
        """Returns whether a view was added."""
        before = self.board
        self.board = board
        return before is not None and before.camera == board.camera and board.views > before.views

    def on_request(self, word: str) -> None:
        self.running.append(word)
        self.lost = ''
        self.feedback = ''
        self.progress = 0.0

    def on_answer(self, word: str, good: bool, text: str, now: float) -> None:
        if word in self.running:
            self.running.remove(word)
        self.answer = text
        self.statuses_since_answer = 0
        self.answers.append((good, text))
        if word == 'start' and good:
            self._started_at = now
            self._square_at = self._saved_at = None
            self.measured = ''
        if word in ('length', 'known') and good:
            self.measured = text
        if word == 'save' and good and not self._is_unsolved():
            self._saved_at = now
        if good:
            self._done[word] = len(self.answers)

    def say(self, text: str) -> None:
        """Shows a sentence of this program in the place of an answer."""
        self.answer = text

    # --- What it means

    def said(self) -> str:
        """The newest answer or message."""
        return self.answer or self.lost or (self.status.message if self.status else '')

    def silent(self, now: float) -> str:
        """Why there is nothing to see; empty when all is well."""
        if self.status is None and self.elsewhere:
            return f'None here, but {self.elsewhere}'
        if self.status is None and now - self.began < FOUND_WITHIN:
            return 'Looking for the calibration node.'
        if self.status is None:
            return ('No calibration node answers at calibration/status: start it with  roslaunch '
                    'wiimote_tracker_bringup tracker.launch cameras:=FILE, or set ROS_NAMESPACE')
        silence = now - self.status_at
        if silence > SILENT_AFTER:
            return (f'The calibration node has said nothing for {int(silence)} s: check that it '
                    'still runs')
        return ''

    def advice(self) -> Advice:
        """What the node wants to be done next, and the command for it."""
        status = self.status
        if status is None:
            return Advice('Waiting for the calibration node.')
        word = WORDS.get(status.next_request)
        if word is None:
            return Advice(status.next_sentence + self._other_way(status))
        if word == 'wave' and status.corners_needed == 0 and not self.is_waving():
            return Advice(f'{status.next_sentence} {self.asking["length"]}.')
        arguments = [str(status.next_corner + 1)] if status.next_corner >= 0 else []
        label = status.next_label
        wand = self._start[:1] == ['wand']
        if word == 'connection' and wand:  # two LEDs: the wand on the floor shows who sees them
            return Advice('Switch the wand on and lay it on the floor. '
                          f'{self.asking["next"]}: start with it.', 'start', self._start)
        if word == 'start':
            arguments = self._start
            label += (f' with {"the " if wand else ""}{in_words(arguments)}' if arguments else
                      f'; {self.asking["side"]}')
        return Advice(f'{status.next_sentence} {self.asking["next"]}: {label}.'
                      f'{self._other_way(status)}', word, arguments)

    def is_waving(self) -> bool:
        return self.status is not None and self.status.step == self.status.WAVING

    def is_started(self) -> bool:
        """Whether a calibration is, also one that was saved."""
        status = self.status
        return status is not None and (
            bool(status.square_sides) or status.corners_needed == 0)

    def is_busy(self) -> bool:
        """Whether the node does something that `cancel` would end."""
        status = self.status
        return status is not None and status.step in (
            status.CAPTURING, status.WAVING, status.SOLVING, status.MASKING, status.MEASURING)

    def _is_unsolved(self) -> bool:
        """Whether what was captured is not solved, and the rig is an earlier one."""
        status = self.status
        return status is not None and status.step in (status.READY, status.COMPLETE)

    def _is_changed_since_save(self) -> bool:
        # The first status after an answer may be older than that. A corrected rig that is still
        # approached ("Wait") was saved.
        return (self._saved_at is not None and self.statuses_since_answer > 1
                and self.status.step == self.status.SOLVED and self.status.next_title != 'Wait')

    def has_done(self, word: str, since: str = 'start') -> bool:
        """Whether a command succeeded after `start` and another one last did."""
        return self._done.get(word, 0) > max(self._done.get(other, 0) for other in ('start', since))

    def elapsed(self, now: float) -> float:
        """From the start of the calibration until it was saved, or until now [s]."""
        begin = self.began if self._started_at is None else self._started_at
        return (now if self._saved_at is None else self._saved_at) - begin

    def took(self, now: float) -> str:
        """The last sentences: how long it took, what is not saved, and what goes on without us."""
        return self._took(now) + (
            ' The change since is not saved: start calibrate again. '
            f'{self.asking["save"]} saves it.'
            if self._is_changed_since_save() else '') + (
            f' The node goes on with {self.running[-1]}: calibrate shows it, and '
            f'{self.asking["cancel"]} stops it there.'
            if self.running and 'cancel' not in self.running else '')

    def _took(self, now: float) -> str:
        if self._started_at is None or self._saved_at is None:
            status = self.status
            kept = status.corners_captured if status and status.step != status.SAVED else 0
            corners = 'one corner: calibrate goes on with it' if kept == 1 else \
                f'{kept} corners: calibrate goes on with them'
            # Saved without a start: a camera was recalibrated, for example.
            done = 'No calibration was saved' if self._saved_at is None else \
                'The rig was saved'
            return f'{done}; this took {spoken(now - self.began)}.' + (
                f' The node keeps {corners}.' if kept else '')
        text = f'Calibrated and saved in {spoken(self._saved_at - self._started_at)}'
        if self._square_at is not None:
            text += f', {spoken(self._square_at - self._started_at)} of it for the square'
        return text + '.'

    def _other_way(self, status) -> str:
        """What asks for another way on, of which the sentence speaks too."""
        request = status.next_request
        if request == 'learn_masks':
            return f' {self.asking["connection"]} goes on without.'
        if status.step == status.COMPLETE and request == 'start_wave':
            return f' {self.asking["solve"]} solves.'
        if status.step == status.SOLVED and request != 'save':
            return f' {self.asking["save"]} saves.'
        is_well = (status.step == status.SAVED and status.next_title != 'No images'
                   and not any(c.health for c in status.cameras))
        return f' {self.asking["check"]} checks it.' if is_well else ''

    def _keep_time(self, before, status, now: float) -> None:
        if before is None and self._started_at is None and status.step not in (
                status.IDLE, status.SAVED):
            self._started_at = now  # somebody else started it, at this time or earlier
        complete = status.corners_needed and status.corners_captured >= status.corners_needed
        if complete and self._square_at is None and self._started_at is not None:
            self._square_at = now


def spoken(seconds: float) -> str:
    minutes, rest = divmod(int(round(seconds)), 60)
    return f'{minutes} min {rest} s' if minutes else f'{rest} s'
