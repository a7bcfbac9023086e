"""What a person can ask for: keys and words, and the requests to the node that they stand for.

Knows the names of services and their fields, but does not use ROS.
"""

from dataclasses import dataclass, replace
from typing import Any, Callable, Dict, List, Optional, Sequence

LENS_MODELS = ['automatic', 'no_distortion', 'k1', 'k1_k2', 'plumb_bob', 'equidistant']


class UsageError(Exception):
    """What was typed cannot be understood; the text says what can be."""


@dataclass
class Request:
    """One call below calibration/."""
    name: str   # of the service or action
    type: str   # of the service or action
    fields: Dict[str, Any]


def request(name: str, type_: str, **fields: Any) -> Request:
    return Request(name, type_, fields)


@dataclass
class Command:
    word: str                        # as typed in plain text
    key: str                         # on the screen
    label: str                       # what it does
    build: Callable[..., Request]    # from the status of the node and the list of arguments
    arguments: str = ''              # that may be typed after the word
    ask: Optional[str] = None        # the question for them on the screen


# --- Reading arguments

def number(text: str, what: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = float('nan')
    if not -1e9 < value < 1e9:
        raise UsageError(f'{what} must be a number such as 2.5, not "{text}"')
    return value


def optional_number(arguments: List[str], place: int, what: str) -> float:
    """The number at a place, or 0, for which the node takes its default."""
    return number(arguments[place], what) if len(arguments) > place else 0.0


def side(arguments: List[str], place: int, what: str) -> float:
    """As optional_number(), but 0 is refused: it would be the default."""
    value = optional_number(arguments, place, what)
    if len(arguments) > place and value <= 0.0:
        raise UsageError(f'{what} must be above 0, not "{arguments[place]}": give it in metres')
    return value


def at_most(arguments: List[str], count: int, usage: str) -> None:
    if len(arguments) > count:
        raise UsageError(f'too many words: give {usage}')


def point(arguments: List[str]) -> List[float]:
    if len(arguments) < 3:
        raise UsageError('give the place as three numbers: x y z, in metres')
    return [number(text, 'a coordinate') for text in arguments[:3]]


# --- From arguments to requests

def trigger(name: str, type_: str = 'Trigger'):
    """A request without fields."""
    def build(status, arguments):
        at_most(arguments, 0, 'nothing after it')
        return request(name, type_)
    return build


def for_seconds(name: str, type_: str):
    def build(status, arguments):
        at_most(arguments, 1, 'a duration in seconds, or nothing')
        return request(name, type_, duration=optional_number(arguments, 0, 'the duration'))
    return build


def with_path(name: str, type_: str):
    def build(status, arguments):
        return request(name, type_, path=' '.join(arguments))
    return build


def start(status, arguments):
    usage = 'one side or two in metres, or the word wand and its length if it lies on the floor'
    if arguments[:1] == ['wand']:
        at_most(arguments, 3, usage)
        return request('start', 'StartCalibration', without_square=True,
                       wand_length=optional_number(arguments, 1, 'the length of the wand'),
                       wand_stddev=optional_number(arguments, 2, 'its standard deviation'))
    at_most(arguments, 2, usage)
    return request('start', 'StartCalibration',
                   side_x=side(arguments, 0, 'the side of the square'),
                   side_y=side(arguments, 1, 'the second side'))


def capture(status, arguments):
    at_most(arguments, 1, 'the corner to take again, 1 to 4, or nothing')
    if not arguments:
        return request('capture_corner', 'CaptureCorner')
    if arguments[0] not in ('1', '2', '3', '4'):
        raise UsageError('the corner to take again must be 1, 2, 3 or 4')
    return request('capture_corner', 'CaptureCorner', retake=True, corner=int(arguments[0]) - 1)


def hands_free(status, arguments):
    if arguments not in ([], ['on'], ['off']):
        raise UsageError('say on or off, or nothing to change over')
    on = arguments == ['on'] if arguments else not (status and status.hands_free)
    return request('hands_free', 'SetBool', data=on)


def wave(status, arguments):
    at_most(arguments, 2, 'the length of the wand and its standard deviation, or nothing')
    if status and status.step == status.WAVING and not arguments:
        return request('stop_wave', 'Trigger')
    return request('start_wave', 'StartWave',
                   wand_length=optional_number(arguments, 0, 'the length of the wand'),
                   wand_stddev=optional_number(arguments, 1, 'its standard deviation'))


def length(status, arguments):
    at_most(arguments, 4, 'two corners, the length and, if you like, its standard deviation')
    if len(arguments) < 3 or not {*arguments[:2]} <= {*'1234'}:
        raise UsageError('give two corners, 1 to 4, and the length between them in metres')
    return request('measure_length', 'MeasureLength', from_corner=int(arguments[0]) - 1,
                   to_corner=int(arguments[1]) - 1, length=number(arguments[2], 'the length'),
                   stddev=optional_number(arguments, 3, 'the standard deviation'))


def check(status, arguments):
    at_most(arguments, 4, 'x y z and, if you like, the standard deviation of the place')
    return request('check', 'CheckPlace', known=point(arguments),
                   known_stddev=optional_number(arguments, 3, 'the standard deviation'))


def measure_place(status, arguments):
    return request('measure_place', 'CheckPlace', **check(status, arguments).fields)


def add_place(status, arguments):
    at_most(arguments, 3, 'x y z')
    return request('known_places/add', 'AddKnownPlace', known=point(arguments))


def fit_places(status, arguments):
    return request('known_places/fit', 'FitRemap', models=list(arguments))


def recalibrate(status, arguments):
    if not 1 <= len(arguments) <= 2:
        raise UsageError('give the camera to solve and, if you like, a number of seconds')
    return request('recalibrate_camera', 'RecalibrateCamera', camera=arguments[0],
                   duration=optional_number(arguments, 1, 'the duration'))


def remove(status, arguments):
    if len(arguments) != 1:
        raise UsageError('give the camera to take out of the rig')
    return request('remove_camera', 'RemoveCamera', camera=arguments[0])


def board_start(camera: str):
    def build(status, arguments):
        at_most(arguments, 2, 'the spacing of the columns and of the rows, or nothing')
        return request('board/start', 'StartBoard', camera=camera,
                       column_spacing=optional_number(arguments, 0, 'the spacing of the columns'),
                       row_spacing=optional_number(arguments, 1, 'the spacing of the rows'))
    return build


def board_solve(status, arguments):
    model = arguments[0] if arguments else LENS_MODELS[0]
    if len(arguments) > 1 or model not in LENS_MODELS:
        raise UsageError(f'the lens model must be one of {", ".join(LENS_MODELS)}')
    return request('board/solve', 'SolveBoard', model=LENS_MODELS.index(model))


# --- All commands

RIG = [
    Command('masks', 'm', 'learn the lights of the room, to ignore them (LED off)',
            for_seconds('learn_masks', 'LearnMasks'), '[SECONDS]'),
    Command('unmask', 'M', 'ignore no lights any more', trigger('clear_masks')),
    Command('connection', 'k', 'check that all cameras see the LED',
            for_seconds('check_connection', 'CheckConnection'), '[SECONDS]'),
    Command('start', 'n', 'start a calibration', start,
            '[SIDE [SIDE_Y] | wand [LENGTH [STDDEV]]]',
            'Side [m] of the square, or wand and its length [m]; Enter: parameter'),
    Command('capture', 't', 'capture the next corner, or one again', capture, '[CORNER]',
            'Corner to take again, 1 to 4; Enter: the next one'),
    Command('undo', 'u', 'drop a length taken last, else place, else wave, else corner',
            trigger('undo')),
    Command('hands_free', 'h', 'capture a corner when the LED is held still',
            hands_free, '[on|off]'),
    Command('wave', 'w', 'begin to record a wave, or end it', wave, '[WAND_LENGTH [STDDEV]]',
            'Length of the wand in metres; Enter: one LED'),
    Command('solve', 's', 'solve all cameras', trigger('solve', 'SolveCalibration')),
    Command('length', 'd', 'take a length between two corners, by tape', length,
            'CORNER CORNER METRES [STDDEV]', 'Two corners and the length between them by tape, '
            'like 1 3 3.536 (0: drop it)'),
    Command('known', 'a', 'take a known place of the LED, to solve with', measure_place,
            'X Y Z [STDDEV]', 'Known place of the LED, to solve with: x y z in metres'),
    Command('save', 'v', 'save the rig', with_path('save', 'SaveRig'), '[FILE]'),
    Command('check', 'c', 'measure the LED at a known place', check, 'X Y Z [STDDEV]',
            'Where is the LED? x y z in metres'),
    Command('load', 'l', 'use a rig from a file', with_path('load', 'LoadRig'), '[FILE]',
            'Rig file; Enter: parameter rig_file'),
    Command('recalibrate', 'r', 'solve one camera again, or add one, while the LED is waved',
            recalibrate, 'CAMERA [SECONDS]', 'Camera to solve again or to add'),
    Command('remove', 'R', 'take a camera out of the rig', remove, 'CAMERA',
            'Camera to take out of the rig'),
    Command('apply', 'A', 'use what continuous calibration proposes',
            trigger('continuous/apply')),
    Command('revert', 'b', 'go back to the rig before that', trigger('continuous/revert'), '',
            'Go back to the rig before the last correction? Enter: yes, Escape: no'),
    Command('join', 'j', 'move this rig into the world of another',
            with_path('join', 'JoinRig'), '[FILE]',
            "The first room's rig file; Enter: parameter rig_file"),
    Command('place', 'p', 'measure a known place, for a correction', add_place, 'X Y Z',
            'Known place of the LED for the correction of the volume: x y z in metres'),
    Command('drop_place', 'P', 'drop the last known place', trigger('known_places/undo')),
    Command('clear_places', 'C', 'drop all known places', trigger('known_places/clear')),
    Command('fit', 'f', 'correct the volume by the known places', fit_places, '[MODEL ...]'),
    Command('save_samples', 'o', 'save what was captured',
            with_path('save_samples', 'SaveSamples'), '[FILE]'),
    Command('load_samples', 'O', 'load what was captured, to solve it',
            with_path('load_samples', 'LoadSamples'), '[FILE]',
            'Samples file; Enter: the one beside the rig file'),
    Command('cancel', 'x', 'stop what goes on, or drop all', trigger('cancel'), '',
            'Drop all that was captured? Enter: yes, Escape: no'),
]


def rig_commands(given: Sequence[str]) -> List[Command]:
    """RIG, in which `start` without arguments takes the given ones, if there are any."""
    if not given:
        return RIG
    usual = find(RIG, 'start')
    begin = replace(usual, build=lambda status, arguments: start(status, arguments or list(given)),
                    ask=usual.ask.replace('parameter', in_words(given)))
    return [begin if command is usual else command for command in RIG]


def in_words(given: Sequence[str]) -> str:
    """Arguments of `start`: "2.5 x 1 m", "wand of 0.5 m"."""
    return (' of ' if given[0] == 'wand' else ' x ').join(given) + ' m'


def board_commands(camera: str) -> List[Command]:
    return [
        Command('start', 'n', 'start to collect views',
                board_start(camera), '[COLUMN_SPACING [ROW_SPACING]]',
                'Spacing of the LEDs in metres: columns, rows; Enter: parameters'),
        Command('undo', 'u', 'drop the last view', trigger('board/undo')),
        Command('solve', 's', 'solve the lens', board_solve, '[MODEL]'),
        Command('commit', 'v', 'use the lens and give it to the driver', trigger('board/commit')),
        Command('cancel', 'x', 'drop all views', trigger('board/cancel'), '',
                'Drop all views? Enter: yes, Escape: no'),
    ]


def find(commands: List[Command], word_or_key: str) -> Optional[Command]:
    """The command of this word or key, or None."""
    return next((c for c in commands if word_or_key in (c.word, c.key)), None)
