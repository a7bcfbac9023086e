"""Where a person stands in the calibration, and what to do next.

Takes messages, answers and the time; uses neither ROS nor a terminal.
"""

from dataclasses import dataclass, field
from typing import List, Optional, Sequence

SILENT_AFTER = 3.0  # [s] The node publishes its status twice a second.
FOUND_WITHIN = 3.0  # [s] Longest search for a node that runs.
CORNERS = ("the world's origin", 'along x', 'counter-clockwise seen from above puts z up',
           'the last one')


@dataclass
class Advice:
    """What to do next, and the command that SPACE stands for (None: no command)."""
    sentence: str
    word: Optional[str] = None
    arguments: List[str] = field(default_factory=list)


class Guide:
    """All that the screen is drawn from. Times [s] are of one steady clock."""

    def __init__(self, now: float, side: Sequence[str] = ()):
        """side: arguments of `start` that SPACE uses."""
        self._side = list(side)
        self.began = now
        self.status = None
        self.status_at = None
        self.statuses_since_answer = 0
        self.verdict = None
        self.trace = None       # of the principal points' correction
        self.board = None
        self.image_sizes = {}   # name of a camera -> (width, height) [px]
        self.answer = ''
        self.answers = []       # (good, text) of all answers
        self.measured = ''      # the answer to the last length or known place
        self.running = []       # words of the commands that have not been answered
        self.feedback = ''
        self.progress = 0.0
        self.corners = []       # of each captured corner: name of a camera -> (x, y) [px]
        self._tried = set()     # (word, good)
        self._started_at = None
        self._square_at = None  # when the last corner was captured
        self._saved_at = None

    # --- What comes in

    def on_status(self, status, now: float) -> bool:
        """Returns whether something was achieved that should ring the bell."""
        before = self.status
        self.status = status
        if before is not None and status.message != before.message:
            self.answer = ''  # the node's message is newer
        self.status_at = now
        self.statuses_since_answer += 1
        self._remember_corners(status)
        self._keep_time(before, status, now)
        if before is None:
            return False
        return (status.corners_captured > before.corners_captured or
                (status.step == status.WAVING and bool(before.missing) and not status.missing) or
                (status.step == status.SOLVED and before.step == status.SOLVING))

    def on_board(self, board) -> bool:
        """Returns whether a view was added."""
        before = self.board
        self.board = board
        return before is not None and before.camera == board.camera and board.views > before.views

    def on_request(self, word: str) -> None:
        self.running.append(word)
        self.feedback = ''
        self.progress = 0.0

    def on_feedback(self, message: str, progress: float) -> None:
        self.feedback = message
        self.progress = progress

    def on_answer(self, word: str, good: bool, text: str, now: float) -> None:
        if word in self.running:
            self.running.remove(word)
        self.answer = text
        self.statuses_since_answer = 0
        self.answers.append((good, text))
        if word == 'start' and good:
            self._tried -= {('wave', False), ('solve', True), ('commit', True)}
            self._started_at = now
            self._square_at = self._saved_at = None
            self.measured = ''
        if word in ('length', 'known') and good:
            self.measured = text
        if word == 'save' and good:
            self._saved_at = now
        self._tried.add((word, good))

    def say(self, text: str) -> None:
        """Shows a sentence of this program in the place of an answer."""
        self.answer = text

    # --- What it means

    def silent(self, now: float) -> str:
        """Why there is nothing to see; empty when all is well."""
        if self.status is None and now - self.began < FOUND_WITHIN:
            return 'Looking for the calibration node.'
        if self.status is None:
            return ('No calibration node answers at calibration/status: start it with  roslaunch '
                    'wiimote_tracker_bringup calibrate.launch')
        silence = now - self.status_at
        if silence > SILENT_AFTER:
            return (f'The calibration node has said nothing for {int(silence)} s: check that it '
                    'still runs')
        return ''

    def advice(self) -> Advice:
        """What to do next, by the step of the node."""
        status = self.status
        if status is None:
            return Advice('Waiting for the calibration node.')
        handlers = {status.IDLE: self._before_start, status.READY: self._next_corner,
                    status.WAVING: self._waving, status.COMPLETE: self._complete,
                    status.SOLVED: self._solved}
        sentences = {status.CAPTURING: 'Keep the LED still.', status.SOLVING: 'Solving.',
                     status.MASKING: 'Leave the LED off.',
                     status.MEASURING: 'Keep the LED still.',
                     status.SAVED: 'c checks the rig: put the LED on a place that you know. n '
                                   'starts a new calibration, q ends.'}
        if status.step in handlers:
            return handlers[status.step]()
        return Advice(sentences.get(status.step, ''))

    def is_waving(self) -> bool:
        return self.status is not None and self.status.step == self.status.WAVING

    def is_busy(self) -> bool:
        """Whether the node does something that `cancel` would end."""
        status = self.status
        return status is not None and status.step in (
            status.CAPTURING, status.WAVING, status.SOLVING, status.MASKING, status.MEASURING)

    def is_clockwise(self) -> bool:
        """Whether the captured corners go round clockwise, as most cameras see them."""
        votes = 0
        for name in self.corners[0] if len(self.corners) == 4 else ():
            places = [corner[name] for corner in self.corners if name in corner]
            if len(places) == 4:  # twice the area, positive clockwise, since y points down
                area = sum(a[0] * b[1] - b[0] * a[1]
                           for a, b in zip(places, places[1:] + places[:1]))
                votes += 1 if area > 0.0 else -1
        return votes > 0

    def has_done(self, word: str) -> bool:
        """Whether a command succeeded."""
        return (word, True) in self._tried

    def elapsed(self, now: float) -> float:
        """From the start of the calibration until it was saved, or until now [s]."""
        begin = self.began if self._started_at is None else self._started_at
        return (now if self._saved_at is None else self._saved_at) - begin

    def took(self, now: float) -> str:
        """The last sentence: how long it took."""
        if self._started_at is None or self._saved_at is None:
            kept = self.status.corners_captured if self.status is not None else 0
            return f'Nothing was calibrated and saved; this took {spoken(now - self.began)}.' + (
                f' The node keeps {kept} corners: calibrate goes on with them.' if kept else '')
        text = f'Calibrated and saved in {spoken(self._saved_at - self._started_at)}'
        if self._square_at is not None:
            text += f', {spoken(self._square_at - self._started_at)} of it for the square'
        return text + '.'

    # --- Steps

    def _before_start(self) -> Advice:
        tried = {word for word, _ in self._tried}
        if not self.has_done('masks') and 'connection' not in tried:
            return Advice('Switch the LED off or take it away. SPACE learns which lights the room '
                          'has, to ignore them' + (
                              ' (k goes on without).' if 'masks' in tried else '.'), 'masks')
        if not self.has_done('connection'):
            return Advice('Switch the LED on and hold it up where all cameras see it. SPACE checks '
                          'that they do (n goes on without).', 'connection')
        side = f' with {" x ".join(self._side)} m' if self._side else ', n asks for the side'
        return Advice(f'Measure the side of the square on the floor. SPACE starts{side}.',
                      'start', self._side)

    def _next_corner(self) -> Advice:
        status = self.status
        if status.corners_needed == 0:
            return Advice('Take the wand. w asks for its length and begins to record.')
        number = status.corners_captured
        corner = f'corner {number + 1} ({CORNERS[number] if number < len(CORNERS) else ""})'
        if status.hands_free:
            return Advice(f'Hold the LED still on {corner} until it is captured.')
        return Advice(f'Put the LED on {corner}. SPACE captures it.', 'capture')

    def _waving(self) -> Advice:
        if self.status.missing:
            return Advice('Wave through the whole volume, high and low, near and far.')
        return Advice('Enough. SPACE ends the wave.', 'wave')

    def _complete(self) -> Advice:
        if self.status.wave_seconds > 0.0:
            return Advice('SPACE solves.', 'solve')
        if ('wave', False) in self._tried:
            return Advice('SPACE solves from the square alone; w waves.', 'solve')
        if self.is_clockwise():
            return Advice('The corners go clockwise, so z will point down. Do you want that? SPACE '
                          'goes on with the wave; n starts again, for z up.', 'wave')
        return Advice('Take the LED in your hand. SPACE begins the wave (w: with a wand; s: solve '
                      'from the square alone).', 'wave')

    def _solved(self) -> Advice:
        verdict = self.verdict
        if not (verdict and verdict.rig_id == self.status.rig_id and
                verdict.grade == verdict.REDO):
            return Advice('Read the verdict (i). SPACE saves.', 'save')
        if verdict.redo_corner < 0:
            return Advice('Do again what the verdict says. v saves all the same.')
        corner = str(verdict.redo_corner + 1)
        return Advice(f'Put the LED on corner {corner} again. SPACE captures it; v saves all the '
                      'same.', 'capture', [corner])

    # ---

    def _remember_corners(self, status) -> None:
        new = status.corners_captured - len(self.corners)
        if new > 0:
            places = {camera.name: (camera.x, camera.y) for camera in status.cameras
                      if camera.sees_led}
            self.corners += [{}] * (new - 1) + [places]
        del self.corners[status.corners_captured:]

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
