"""Descriptions of simulated rigs derived from another one."""

import copy
import math
import os
from typing import Dict

import numpy as np

from wiimote_tracker_bringup import experiment
from wiimote_tracker_bringup.errors import Refusal
from wiimote_tracker_bringup.files import read_yaml

MIDDLE = np.array([experiment.SIDE / 2.0, experiment.SIDE / 2.0, 0.0])  # of the rig's floor [m]


def is_description(path: str) -> bool:
    try:
        content = read_yaml(path)
    except Refusal:
        return False
    return isinstance(content, dict) and 'seed' in content


def with_absolute_files(description: Dict, folder: str) -> Dict:
    """The rig that was read in this folder, so that it can be written to any other one."""
    changed = copy.deepcopy(description)
    named = [(drawing, 'file') for drawing in changed.get('drawings', {}).values()]
    named += [(led['blink'], 'codes') for led in changed.get('leds', {}).values()
              if 'codes' in led.get('blink', {})]
    for entry, key in named:
        entry[key] = os.path.join(os.path.abspath(folder), entry[key])
    return changed


def placed(description: Dict, positions, targets) -> Dict:
    """The rig with its cameras at these positions, aimed at these targets [m], to 1 mm."""
    return dict(description, cameras={
        name: dict(camera, position=np.round(position, 3).tolist(),
                   look_at=np.round(target, 3).tolist())
        for (name, camera), position, target in zip(
            description['cameras'].items(), positions, targets)})


def identities(description: Dict) -> Dict[str, str]:
    """Bluetooth address of every camera."""
    return {name: camera['identity'] for name, camera in description['cameras'].items()}


def centred(description: Dict, scale: float) -> Dict:
    """The rig moved from the floor's middle to the origin, with all distances times `scale`."""
    moved = dict(description)
    moved['cameras'] = {name: dict(camera, **{
        key: (scale * (np.array(camera[key]) - MIDDLE)).tolist()
        for key in ('position', 'look_at')})
        for name, camera in description['cameras'].items()}
    return with_leds(moved, [scale * np.array([0.0, 0.0, 0.1])])


def with_leds(description, positions, lit=True):
    """The rig with only LEDs at these places [m], like its first one; named led, led_b, led_c,
    ..."""
    first = next(iter(description['leds'].values()))
    like = {key: first[key] for key in ('size', 'brightness') if key in first}
    changed = {key: value for key, value in description.items()
               if key not in ('board', 'people', 'reflections', 'drawings')}
    changed['leds'] = {('led_' + chr(ord('a') + number) if number else 'led'): dict(
        like, position=[float(v) for v in position], lit=lit)
        for number, position in enumerate(positions)}
    return changed


def with_cameras(description: Dict, number: int) -> Dict:
    """The first `number` cameras. Further ones are placed between them on the same circle, with
    other clocks and addresses."""
    cameras = dict(list(description['cameras'].items())[:number])
    originals = list(description['cameras'].values())
    for extra in range(number - len(cameras)):
        like = originals[extra % len(originals)]
        turn = math.pi / len(originals) * (1 + extra // len(originals))
        rotation = np.array([[math.cos(turn), -math.sin(turn), 0.0],
                             [math.sin(turn), math.cos(turn), 0.0], [0.0, 0.0, 1.0]])
        position = rotation @ (np.array(like['position']) - MIDDLE) + MIDDLE
        clock = dict(like['clock'], phase=(like['clock'].get('phase', 0.0) + 0.0011) % 0.01)
        cameras['wiimote_%d' % (len(cameras) + 1)] = dict(
            like, position=position.tolist(), clock=clock,
            identity=f'00:1f:32:00:01:{extra:02x}')
    changed = dict(description, cameras=cameras)
    changed.pop('board', None)  # its camera may be missing
    return changed
