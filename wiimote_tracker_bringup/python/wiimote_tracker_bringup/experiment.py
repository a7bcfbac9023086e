"""Positions of the LED in the paper's experiment. World z up, metres.

z points into the floor in the paper; its point (x, y, -h) is (x, y, h) here.
"""

import numpy as np

SIDE = 2.5                # of the square and the cube [m]
CORNER_STDDEV = 0.005     # of an LED placed on a corner, each horizontal axis [m]
CIRCLE_RADIUS = 0.75      # [m]

# Initial lens of a calibration: the paper's K (2), fx, fy, cx, cy [px], and k1.
NOMINAL_LENS = np.array([1306.3, 1302.3, 535.0, 401.7, 0.0])

# Corners of the square, counter-clockwise seen from above, so that z is up.
CORNERS = np.array([(0.0, 0.0, 0.0), (SIDE, 0.0, 0.0), (SIDE, SIDE, 0.0), (0.0, SIDE, 0.0)])

# The paper's ten points (section V.B): the cube's corners, the middle of the floor, one inside.
TEST_POINTS = np.array(
    [tuple(corner[:2]) + (height,) for height in (0.0, SIDE) for corner in CORNERS] +
    [(1.25, 1.25, 0.0), (1.25, 1.25, 1.5)])

# Centres of the paper's circles (section V.B).
CIRCLE_CENTERS = np.array([(1.0, 1.0, 0.23), (1.5, 1.5, 0.23), (1.25, 1.25, 0.95)])


def placed_corners(seed: int) -> np.ndarray:
    """Random placements of the LED at the corners: some millimetres off."""
    placed = CORNERS.copy()
    placed[:, :2] += CORNER_STDDEV * np.random.RandomState(seed).randn(4, 2)
    return placed


def alignment_points(seed: int, number: int = 25) -> np.ndarray:
    """Points in the whole cube, used only for fitting alignments."""
    return np.random.RandomState(seed).uniform(0.1, SIDE - 0.1, (number, 3))


def circle_points() -> np.ndarray:
    angle = np.linspace(0.0, 2.0 * np.pi, 90, endpoint=False)
    ring = CIRCLE_RADIUS * np.stack([np.cos(angle), np.sin(angle), 0.0 * angle], axis=1)
    return np.concatenate([center + ring for center in CIRCLE_CENTERS])
