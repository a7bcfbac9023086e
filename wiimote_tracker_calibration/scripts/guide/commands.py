"""What a person can ask for: keys and words, and the requests to the node that they stand for.

Knows the names of services and their fields, but nothing of ROS.
"""


class UsageError(Exception):
    """What was typed makes no sense; the text says what would."""


class Request(object):
    """One call below calibration/: name of the service (or action), its type, its fields."""

    def __init__(self, name, type_, **fields):
        self.name = name
        self.type = type_
        self.fields = fields

    def __eq__(self, other):
        return vars(self) == vars(other)

    def __repr__(self):
        return 'Request(%r, %r, %r)' % (self.name, self.type, self.fields)


class Command(object):
    """word: as typed in plain text. key: on the screen. label: for people. arguments: what may be
    typed behind it. ask: the question for them on the screen; None: none is asked. build: from the
    status and the list of arguments to a Request."""

    def __init__(self, word, key, label, build, arguments='', ask=None):
        self.word = word
        self.key = key
        self.label = label
        self.build = build
        self.arguments = arguments
        self.ask = ask


# --- Reading arguments

def number(text, what):
    try:
        value = float(text)
    except ValueError:
        value = float('nan')
    if not -1e9 < value < 1e9:
        raise UsageError('%s must be a number, not "%s"' % (what, text))
    return value


def optional_number(arguments, place, what):
    """The number at a place, or 0, which the node takes as its own default."""
    return number(arguments[place], what) if len(arguments) > place else 0.0


def at_most(arguments, count, usage):
    if len(arguments) > count:
        raise UsageError('too much: give %s' % usage)


def point(arguments):
    if len(arguments) < 3:
        raise UsageError('give the place as three numbers: x y z, in metres')
    return [number(text, 'a coordinate') for text in arguments[:3]]


def path(arguments):
    return ' '.join(arguments)


def one_name(arguments, what):
    if len(arguments) != 1:
        raise UsageError('give the name of %s' % what)
    return arguments[0]


# --- From arguments to requests

def trigger(name):
    def build(status, arguments):
        at_most(arguments, 0, 'nothing behind it')
        return Request(name, 'Trigger')
    return build


def learn_masks(status, arguments):
    at_most(arguments, 1, 'a duration in seconds, or nothing')
    return Request('learn_masks', 'LearnMasks',
                   duration=optional_number(arguments, 0, 'the duration'))


def check_connection(status, arguments):
    at_most(arguments, 1, 'a duration in seconds, or nothing')
    return Request('check_connection', 'CheckConnection',
                   duration=optional_number(arguments, 0, 'the duration'))


def start(status, arguments):
    at_most(arguments, 2, 'one side or two in metres, or the word wand')
    if arguments[:1] == ['wand']:
        return Request('start', 'StartCalibration', without_square=True)
    return Request('start', 'StartCalibration',
                   side_x=optional_number(arguments, 0, 'the side of the square'),
                   side_y=optional_number(arguments, 1, 'the second side'))


def capture(status, arguments):
    at_most(arguments, 1, 'the corner to take again, 1 to 4, or nothing')
    if not arguments:
        return Request('capture_corner', 'CaptureCorner')
    if arguments[0] not in ('1', '2', '3', '4'):
        raise UsageError('the corner to take again must be 1, 2, 3 or 4')
    return Request('capture_corner', 'CaptureCorner', retake=True, corner=int(arguments[0]) - 1)


def hands_free(status, arguments):
    if arguments not in ([], ['on'], ['off']):
        raise UsageError('say on or off, or nothing to change over')
    on = arguments == ['on'] if arguments else not (status and status.hands_free)
    return Request('hands_free', 'SetBool', data=on)


def wave(status, arguments):
    at_most(arguments, 2, 'the length of the wand and its standard deviation, or nothing')
    if status and status.step == status.WAVING and not arguments:
        return Request('stop_wave', 'Trigger')
    return Request('start_wave', 'StartWave',
                   wand_length=optional_number(arguments, 0, 'the length of the wand'),
                   wand_stddev=optional_number(arguments, 1, 'its standard deviation'))


def check(status, arguments):
    at_most(arguments, 4, 'x y z and, if need be, the standard deviation of the place')
    return Request('check', 'CheckPlace', known=point(arguments),
                   known_stddev=optional_number(arguments, 3, 'the standard deviation'))


def add_place(status, arguments):
    at_most(arguments, 3, 'x y z')
    return Request('known_places/add', 'AddKnownPlace', known=point(arguments))


def fit_places(status, arguments):
    return Request('known_places/fit', 'FitRemap', models=list(arguments))


def recalibrate(status, arguments):
    at_most(arguments, 2, 'the camera to solve anew and, if need be, for how many seconds')
    return Request('recalibrate_camera', 'RecalibrateCamera',
                   camera=one_name(arguments[:1], 'the camera to solve anew'),
                   duration=optional_number(arguments, 1, 'the duration'))


def with_path(name, type_):
    def build(status, arguments):
        return Request(name, type_, path=path(arguments))
    return build


def solve(status, arguments):
    at_most(arguments, 0, 'nothing behind it')
    return Request('solve', 'SolveCalibration')


LENS_MODELS = ['automatic', 'no_distortion', 'k1', 'k1_k2', 'plumb_bob', 'equidistant']


def board_start(camera):
    def build(status, arguments):
        at_most(arguments, 2, 'the spacing of the columns and of the rows, or nothing')
        return Request('board/start', 'StartBoard', camera=camera,
                       column_spacing=optional_number(arguments, 0, 'the spacing of the columns'),
                       row_spacing=optional_number(arguments, 1, 'the spacing of the rows'))
    return build


def board_solve(status, arguments):
    model = arguments[0] if arguments else LENS_MODELS[0]
    if len(arguments) > 1 or model not in LENS_MODELS:
        raise UsageError('the lens model must be one of %s' % ', '.join(LENS_MODELS))
    return Request('board/solve', 'SolveBoard', model=LENS_MODELS.index(model))


RIG = [
    Command('masks', 'm', 'learn which lights the room has (LED off)', learn_masks, '[SECONDS]'),
    Command('unmask', 'M', 'ignore no lights any more', trigger('clear_masks')),
    Command('connection', 'k', 'see whether all cameras see the LED',
            check_connection, '[SECONDS]'),
    Command('start', 'n', 'begin a calibration', start, '[SIDE [SIDE_Y] | wand]',
            'Side of the square in metres (two for a rectangle), wand: none; '
            'Enter: as the node says'),
    Command('capture', 't', 'capture the next corner, or take one again', capture, '[CORNER]',
            'Corner to take again, 1 to 4; Enter: the next one'),
    Command('undo', 'u', 'drop the last corner', trigger('undo')),
    Command('hands_free', 'h', 'corners are captured when the LED is held still',
            hands_free, '[on|off]'),
    Command('wave', 'w', 'begin to record a wave, or end it', wave, '[WAND_LENGTH [STDDEV]]',
            'Length of the wand in metres; Enter: one LED'),
    Command('solve', 's', 'solve all cameras', solve),
    Command('save', 'v', 'save the rig', with_path('save', 'SaveRig'), '[FILE]'),
    Command('check', 'c', 'compare a known place with where it is measured',
            check, 'X Y Z [STDDEV]',
            'Where is the LED? x y z in metres'),
    Command('load', 'l', 'use a rig from a file', with_path('load', 'LoadRig'), '[FILE]',
            'Rig file; Enter: as the node says'),
    Command('recalibrate', 'r', 'solve one camera anew while the LED is waved',
            recalibrate, 'CAMERA [SECONDS]',
            'Camera to solve anew while the LED is waved'),
    Command('join', 'j', 'put this rig into the world of another',
            with_path('join', 'JoinRig'), '[FILE]',
            "The first room's rig file; Enter: as the node says"),
    Command('place', 'p', 'measure a known place, for a correction', add_place, 'X Y Z',
            'Known place of the LED for the correction of the volume: x y z in metres'),
    Command('drop_place', 'P', 'drop the last known place', trigger('known_places/undo')),
    Command('clear_places', 'C', 'drop all known places', trigger('known_places/clear')),
    Command('fit', 'f', 'correct the volume by the known places', fit_places, '[MODEL ...]'),
    Command('save_samples', 'o', 'keep all that was captured',
            with_path('save_samples', 'SaveSamples'),
            '[FILE]'),
    Command('load_samples', 'O', 'read what was captured before, to solve it',
            with_path('load_samples', 'LoadSamples'),
            '[FILE]', 'Samples file; Enter: the one beside the rig file'),
    Command('cancel', 'x', 'stop what goes on, or drop all', trigger('cancel'), '',
            'Drop all that was captured? Enter: yes, Escape: no'),
]


def board_commands(camera):
    return [
        Command('start', 'n', 'begin to collect views',
                board_start(camera), '[COLUMN_SPACING [ROW_SPACING]]',
                'Spacing of the LEDs in metres: columns, rows; Enter: as the node says'),
        Command('undo', 'u', 'drop the last view', trigger('board/undo')),
        Command('solve', 's', 'solve the lens', board_solve, '[MODEL]'),
        Command('commit', 'v', 'use the lens: give it to the driver', trigger('board/commit')),
        Command('cancel', 'x', 'drop all views', trigger('board/cancel'), '',
                'Drop all views? Enter: yes, Escape: no'),
    ]


def find(commands, word_or_key):
    """The command of this word or key, or None."""
    for command in commands:
        if word_or_key in (command.word, command.key):
            return command
    return None
