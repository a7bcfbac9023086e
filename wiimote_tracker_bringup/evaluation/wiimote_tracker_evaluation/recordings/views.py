"""What the cameras of a recording saw, and where the body truly was."""

import dataclasses
from typing import List, Optional

import numpy as np

from wiimote_tracker_bringup import timeseries

# Longest time between two images to interpolate between [s].
LONGEST_GAP = 0.05


@dataclasses.dataclass(eq=False)
class Camera:
    """A pinhole whose principal point is the middle of its square image.

    size: width and height [px]. times: n, increasing, by its own clock [s]. pixels: n x lights x 2,
    of the images that show all lights [px]. lines: n, where each image shows the light, from -0.5
    (top) to 0.5; None if all lines are exposed at once.
    """

    name: str
    size: int
    focal: float  # [px]
    times: np.ndarray
    pixels: np.ndarray
    lines: Optional[np.ndarray] = None

    @property
    def middle(self) -> float:
        """Both coordinates of the principal point [px]."""
        return 0.5 * (self.size - 1)

    @property
    def centers(self) -> np.ndarray:
        """Of the lights, n x 2 [px]: the point that is tracked."""
        return self.pixels.mean(axis=1)

    @property
    def blank_times(self) -> np.ndarray:
        """Of the images between those, at the camera's rate, which do not show all lights [s]."""
        steps = np.diff(self.times)
        counts = np.round(steps / np.median(steps)).astype(int)
        return np.concatenate([start + step * np.arange(1, count) / count for start, step, count
                               in zip(self.times, steps, counts)])

    def pixels_at(self, times) -> np.ndarray:
        """m x lights x 2, interpolated; NaN in gaps."""
        known = timeseries.covers(self.times, times, LONGEST_GAP)
        return np.where(known[:, None, None], timeseries.at(self.times, self.pixels, times), np.nan)


@dataclasses.dataclass(eq=False)
class Truth:
    """times m, increasing, by a clock of its own [s]; positions m x 3 [m]. Its time is about rate
    times the cameras' plus offset; tolerance: of that [s]."""

    times: np.ndarray
    positions: np.ndarray
    rate: float
    offset: float
    tolerance: float


@dataclasses.dataclass(eq=False)
class Views:
    """A recording. shape: lights x 3, where the lights are on the body; gives the scale, if there
    are several [m].
    accuracy: standard deviation of the errors of a lens, which vary slowly over its image [px]."""

    cameras: List[Camera]
    shape: np.ndarray
    accuracy: float
    truth: Truth
