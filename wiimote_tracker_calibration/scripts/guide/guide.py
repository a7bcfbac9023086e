"""Where a person stands in the calibration, and what is to be done next.

Fed with messages, answers and the time; knows nothing of ROS and of terminals.
"""

SILENT_AFTER = 3.0  # [s] The node tells its status twice a second.
FOUND_WITHIN = 3.0  # [s] A node that runs.


class Advice(object):
    """What to do next. word, arguments: the command that SPACE stands for; word None: none."""

    def __init__(self, sentence, word=None, arguments=()):
        self.sentence = sentence
        self.word = word
        self.arguments = list(arguments)


class Guide(object):
    """All that the screen is drawn from. Times [s] are of one steady clock."""

    def __init__(self, now, side=None):
        """side: arguments of start that SPACE uses."""
        self._side = list(side or [])
        self.began = now
        self.status = None
        self.status_at = None
        self.statuses_since_answer = 0
        self.verdict = None
        self.trace = None       # of the principal points' correction
        self.board = None
        self.answer = ''
        self.answer_good = True
        self.answers = []       # (good, text) of all answers
        self.running = []       # words of the commands that have not been answered
        self.feedback = ''
        self.progress = 0.0
        self.corners = []       # of each captured corner: name of a camera -> (x, y) [px]
        self._tried = set()
        self._started_at = None
        self._square_at = None  # when the last corner was there
        self._saved_at = None

    # --- What comes in

    def on_status(self, status, now):
        """@return whether something was achieved that a person away from the screen should hear."""
        before = self.status
        self.status = status
        if before is not None and status.message != before.message:
            self.answer = ''  # what the node says now is newer
        self.status_at = now
        self.statuses_since_answer += 1
        self._remember_corners(status)
        self._keep_time(before, status, now)
        if before is None:
            return False
        return (status.corners_captured > before.corners_captured or
                (status.step == status.WAVING and bool(before.missing) and not status.missing) or
                (status.step == status.SOLVED and before.step == status.SOLVING))

    def on_board(self, board):
        """@return whether a view was added."""
        before = self.board
        self.board = board
        return before is not None and before.camera == board.camera and board.views > before.views

    def on_request(self, word):
        self.running.append(word)
        self.feedback = ''
        self.progress = 0.0

    def on_feedback(self, message, progress):
        self.feedback = message
        self.progress = progress

    def on_answer(self, word, good, text, now):
        if word in self.running:
            self.running.remove(word)
        self.answer = text
        self.answer_good = good
        self.statuses_since_answer = 0
        self.answers.append((good, text))
        if word == 'start' and good:
            self._tried -= {('wave', False), ('solve', True), ('commit', True)}
        self._tried.add((word, good))
        if word == 'start' and good:
            self._started_at = now
            self._square_at = self._saved_at = None
        if word == 'save' and good:
            self._saved_at = now

    def say(self, text):
        """A sentence of our own, in the place of an answer."""
        self.answer = text
        self.answer_good = False

    # --- What it means

    def silent(self, now):
        """Why there is nothing to see; empty when all is well."""
        if self.status is None and now - self.began < FOUND_WITHIN:
            return 'Looking for the calibration node.'
        if self.status is None:
            return ('No calibration node answers at calibration/status: start it with  roslaunch '
                    'wiimote_tracker_bringup calibrate.launch')
        if now - self.status_at > SILENT_AFTER:
            return ('The calibration node has said nothing for %d s: see whether it still runs'
                    % (now - self.status_at))
        return ''

    def advice(self):
        """What to do next, by the step of the node."""
        status = self.status
        if status is None:
            return Advice('Waiting for the calibration node.')
        return {
            status.IDLE: self._before_start, status.READY: self._next_corner,
            status.CAPTURING: lambda: Advice('Keep the LED still.'),
            status.WAVING: self._waving, status.COMPLETE: self._complete,
            status.SOLVING: lambda: Advice('Solving.'), status.SOLVED: self._solved,
            status.SAVED: self._saved,
            status.MASKING: lambda: Advice('Leave the LED off.'),
            status.MEASURING: lambda: Advice('Keep the LED still.'),
        }.get(status.step, lambda: Advice(''))()

    def is_waving(self):
        return self.status is not None and self.status.step == self.status.WAVING

    def is_busy(self):
        """Whether the node is in the middle of something, that `cancel` would end."""
        status = self.status
        return status is not None and status.step in (
            status.CAPTURING, status.WAVING, status.SOLVING, status.MASKING, status.MEASURING)

    def has_done(self, word):
        """Whether a command succeeded."""
        return (word, True) in self._tried

    def elapsed(self, now):
        """From the start of the calibration until it was saved, or until now [s]."""
        begin = self.began if self._started_at is None else self._started_at
        return (now if self._saved_at is None else self._saved_at) - begin

    def took(self, now):
        """The last sentence: how long it took."""
        if self._started_at is None or self._saved_at is None:
            return 'Nothing was calibrated and saved; this took %s.' % spoken(now - self.began)
        text = 'Calibrated and saved in %s' % spoken(self._saved_at - self._started_at)
        if self._square_at is not None:
            text += ', %s of it for the square' % spoken(self._square_at - self._started_at)
        return text + '.'

    # --- Steps

    def _before_start(self):
        if not self._was_tried('masks'):
            return Advice('Switch the LED off or take it away. SPACE learns which lights the room '
                          'has, to ignore them.', 'masks')
        if not self.has_done('connection'):
            return Advice('Switch the LED on and hold it up where all cameras see it. SPACE checks '
                          'that they do (n goes on without).', 'connection')
        return Advice('Measure the side of the square on the floor. SPACE starts%s.'
                      % (' with %s m' % ' x '.join(self._side) if self._side else
                         ', n asks for the side'), 'start', self._side)

    def _next_corner(self):
        status = self.status
        if status.corners_needed == 0:
            return Advice('Take the wand. w asks for its length and begins to record.')
        corner = status.corners_captured + 1
        where = {1: "the world's origin", 2: 'along x',
                 3: 'counter-clockwise seen from above puts z up',
                 4: 'the last one'}.get(corner, '')
        if status.hands_free:
            return Advice('Hold the LED still on corner %d (%s) until it is captured.'
                          % (corner, where))
        return Advice('Put the LED on corner %d (%s). SPACE captures it.' % (corner, where),
                      'capture')

    def _waving(self):
        if self.status.missing:
            return Advice('Wave through the whole volume, high and low, near and far.')
        return Advice('Enough. SPACE ends the wave.', 'wave')

    def _complete(self):
        if self.status.wave_seconds > 0.0:
            return Advice('SPACE solves.', 'solve')
        if ('wave', False) in self._tried:
            return Advice('SPACE solves from the square alone; w waves.', 'solve')
        return Advice('Take the LED in your hand. SPACE begins the wave (w: with a wand; s: solve '
                      'from the square alone).', 'wave')

    def _solved(self):
        verdict = self.verdict
        if verdict and verdict.rig_id == self.status.rig_id and verdict.grade == verdict.REDO:
            if verdict.redo_corner >= 0:
                corner = verdict.redo_corner + 1
                return Advice('Put the LED on corner %d again. SPACE takes it; v saves all the '
                              'same.' % corner, 'capture', [str(corner)])
            return Advice('Do again what the verdict says. v saves all the same.')
        return Advice('Read the verdict (i). SPACE saves.', 'save')

    def _saved(self):
        return Advice('c checks the rig: put the LED on a place that you know. n starts a new '
                      'calibration, q ends.')

    # ---

    def _was_tried(self, word):
        return (word, True) in self._tried or (word, False) in self._tried

    def _remember_corners(self, status):
        if status.corners_captured > len(self.corners):
            places = {camera.name: (camera.x, camera.y) for camera in status.cameras
                      if camera.sees_led}
            self.corners += [{}] * (status.corners_captured - len(self.corners) - 1) + [places]
        del self.corners[status.corners_captured:]

    def _keep_time(self, before, status, now):
        if before is None and self._started_at is None and status.step not in (
                status.IDLE, status.SAVED):
            self._started_at = now  # somebody else started it: from here on at least
        complete = status.corners_needed and status.corners_captured >= status.corners_needed
        if complete and self._square_at is None and self._started_at is not None:
            self._square_at = now


def spoken(seconds):
    seconds = int(round(seconds))
    minutes = '%d min ' % (seconds // 60) if seconds >= 60 else ''
    return '%s%d s' % (minutes, seconds % 60)
