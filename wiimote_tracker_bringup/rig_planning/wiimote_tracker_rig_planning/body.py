"""The LEDs of a rigid body as targets."""

import numpy as np
from scipy.spatial.transform import Rotation

HEADINGS = 4  # to which the body is turned about z


def lights(leds, points):
    """Places of the LEDs, their directions, and their places relative to the body's middle, each
    B x L x 3, for an upright body at each of the points in each heading, headings in turn.
    leds: L x 6."""
    angles = 2.0 * np.pi * np.arange(HEADINGS) / HEADINGS
    turns = Rotation.from_euler('z', angles).as_matrix()
    leds = np.array(leds)
    directions = leds[:, 3:] / np.linalg.norm(leds[:, 3:], axis=1, keepdims=True)
    levers, directions = (np.tile(each @ np.swapaxes(turns, 1, 2), (len(points), 1, 1))
                          for each in (leds[:, :3], directions))
    return np.repeat(points, HEADINGS, axis=0)[:, None] + levers, directions, levers
