"""What a room needs and allows, read from a file."""

import dataclasses
from typing import Tuple

import numpy as np

from wiimote_tracker_bringup.errors import Refusal
from wiimote_tracker_bringup.files import read_yaml

Box = Tuple[float, float, float, float, float, float]  # two opposite corners, the lesser first [m]
Light = Tuple[float, float, float, float, float, float]  # an LED on a body: place [m], direction


@dataclasses.dataclass(frozen=True)
class Plan:
    """cameras: how many, 2 or more. volume: where the LED, or the body's middle, will be. stands:
    where lenses may be. obstacles: what hides LEDs. led_axis: direction in which an LED shines;
    beam: full angle in which it is seen [degrees]. body: the LEDs of an upright rigid body that may
    be turned to any side, instead of one LED: place on the body and direction of each. farthest:
    distance at which a camera sees an LED [m]. margin: of the image that is not used, since nobody
    aims exactly [px]. pixel_stddev: of each pixel coordinate. hidden: the probability that a person
    hides the LED from one of the cameras. square: side of the calibration square, which all cameras
    are to see, on the floor in the volume's middle [m]."""

    cameras: int
    volume: Box
    stands: Tuple[Box, ...]
    obstacles: Tuple[Box, ...] = ()
    led_axis: Tuple[float, float, float] = (0.0, 0.0, 1.0)
    body: Tuple[Light, ...] = ()
    beam: float = 360.0
    farthest: float = 10.0
    margin: float = 20.0
    pixel_stddev: float = 0.5
    hidden: float = 0.2
    square: float = 2.5

    def grid(self, across: int) -> np.ndarray:
        """N x 3 points of the volume, so many along each edge, its surface included."""
        corners = np.array(self.volume).reshape(2, 3)
        steps = np.linspace(0.0, 1.0, across)
        shares = np.stack(np.meshgrid(steps, steps, steps, indexing='ij'), axis=-1).reshape(-1, 3)
        return corners[0] + shares * (corners[1] - corners[0])

    def corners(self) -> np.ndarray:
        """4 x 3, of the calibration square."""
        low, high = np.array(self.volume).reshape(2, 3)
        middle = (low + high)[:2] / 2.0
        sides = self.square / 2.0 * np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
        return np.column_stack([middle + sides, np.full(4, low[2])])


def read(path: str) -> Plan:
    """Throws Refusal if a key is unknown, missing or out of range."""
    content = read_yaml(path)
    fields = {field.name: field for field in dataclasses.fields(Plan)}
    if not isinstance(content, dict):
        raise Refusal(f'{path} must have the keys {", ".join(fields)}')
    unknown = sorted(set(map(str, content)) - set(fields))
    if unknown:
        raise Refusal(f'{path}: {unknown[0]} is unknown; the keys are {", ".join(fields)}')
    missing = [name for name, field in fields.items()
               if field.default is dataclasses.MISSING and name not in content]
    if missing:
        raise Refusal(f'{path}: {missing[0]} is missing')
    plan = Plan(**{name: _value(path, name, value) for name, value in content.items()})
    if plan.body and plan.beam == 360.0:
        raise Refusal(f'{path}: with a body give beam, since cameras behind the body do '
                      'not see its LEDs')
    return plan


RANGES = {'cameras': (2, 64), 'beam': (1.0, 360.0), 'farthest': (0.1, 100.0),
          'margin': (0.0, 300.0), 'pixel_stddev': (0.01, 100.0), 'hidden': (0.0, 1.0),
          'square': (0.1, 100.0)}


def _value(path, name, value):
    if name == 'body':
        if not isinstance(value, list) or 0 < len(value) < 3:
            raise Refusal(f'{path}: body must be a list of 3 LEDs or more [x, y, z, '
                          'direction x, y, z]')
        return tuple(_light(path, f'{name}[{index}]', led) for index, led in enumerate(value))
    if name in ('stands', 'obstacles'):
        if not isinstance(value, list) or (name == 'stands' and not value):
            raise Refusal(f'{path}: {name} must be a list of boxes [x, y, z, x, y, z]')
        return tuple(_box(path, f'{name}[{index}]', box) for index, box in enumerate(value))
    if name == 'volume':
        box = _box(path, name, value)
        if not np.prod(np.subtract(box[3:], box[:3])) > 0.0:
            raise Refusal(f'{path}: {name} must have a length, width and height above 0')
        return box
    if name == 'led_axis':
        return _direction(path, name, _numbers(path, name, value, 3))
    low, high = RANGES[name]
    if (isinstance(value, bool) or not isinstance(value, int if name == 'cameras' else (int, float))
            or not low <= value <= high):
        raise Refusal(f'{path}: {name} is {value}, but must be from {low:g} to {high:g}')
    return value


def _direction(path, name, value):
    if not np.linalg.norm(value) > 0.0:
        raise Refusal(f'{path}: {name} must have a direction that is not 0')
    return tuple(value / np.linalg.norm(value))


def _light(path, name, value):
    numbers = _numbers(path, name, value, 6)
    return tuple(numbers[:3]) + _direction(path, name, numbers[3:])


def _box(path, name, value):
    corners = _numbers(path, name, value, 6).reshape(2, 3)
    return tuple(np.concatenate([corners.min(axis=0), corners.max(axis=0)]))


def _numbers(path, name, value, count):
    good = isinstance(value, list) and len(value) == count and all(
        isinstance(each, (int, float)) and not isinstance(each, bool) and abs(each) <= 1000.0
        for each in value)
    if not good:
        raise Refusal(f'{path}: {name} must be {count} numbers from -1000 to 1000 [m]')
    return np.array(value, dtype=float)
