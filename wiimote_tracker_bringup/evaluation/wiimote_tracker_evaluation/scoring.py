"""Computes figures from a recording and its segments."""

import dataclasses
from typing import Dict, List

import numpy as np

from wiimote_tracker_evaluation import alignment, experiment, statistics


@dataclasses.dataclass(eq=False)
class MeasuredPlace:
    """Position of a still LED and mean of the measurements [m]; scatter: standard deviation of
    single points about that mean, over all three axes [m]."""

    name: str
    true: np.ndarray
    measured: np.ndarray
    scatter: float
    frames: int

    def error(self) -> float:
        return float(np.linalg.norm(self.measured - self.true))


@dataclasses.dataclass(eq=False)
class MeasuredCircle:
    """RMS of single points: distance from the axis minus the radius, and height [m]."""

    name: str
    radial: float
    height: float
    frames: int


@dataclasses.dataclass(eq=False)
class Score:
    """places: of the test points. position_rms: by kind of alignment [m]. scatter: of single
    points, RMS over the places [m]. rate: of points while measuring [Hz]. latency_p50, latency_p99:
    from a report's arrival to its point [s]. age_p50: from the instant of a point to its arrival at
    the recorder [s]."""

    places: List[MeasuredPlace]
    position_rms: Dict[str, float]
    scatter: float
    circles: List[MeasuredCircle]
    rate: float
    latency_p50: float
    latency_p99: float
    age_p50: float


def measured_place(recording, segment) -> MeasuredPlace:
    inside = recording.between(segment.start, segment.end)
    frames = int(inside.sum())
    if frames < 2:
        raise ValueError('only %d points were published while the LED was at %s' %
                         (frames, segment.name))
    positions = recording.position[inside]
    measured = positions.mean(axis=0)
    true = recording.truth_at(recording.stamp[inside]).mean(axis=0)
    scatter = np.sqrt(((positions - measured) ** 2).sum() / (frames - 1))
    return MeasuredPlace(segment.name, true, measured, float(scatter), frames)


def measured_circle(recording, segment) -> MeasuredCircle:
    inside = recording.between(segment.start, segment.end)
    if not inside.any():
        raise ValueError(f'no point was published during the {segment.name}')
    offset = recording.position[inside] - np.asarray(segment.target)
    radial = np.hypot(offset[:, 0], offset[:, 1]) - experiment.CIRCLE_RADIUS
    return MeasuredCircle(segment.name, statistics.rms(radial), statistics.rms(offset[:, 2]),
                          int(inside.sum()))


def score(recording, segments) -> Score:
    """Score of a recording. @raise ValueError: something was not measured."""
    def of_kind(kind):
        return [segment for segment in segments if segment.kind == kind]
    places = [measured_place(recording, segment) for segment in of_kind('test')]
    aligning = [measured_place(recording, segment) for segment in of_kind('alignment')]
    circles = [measured_circle(recording, segment) for segment in of_kind('circle')]

    measured, true = (np.array([getattr(place, name) for place in places])
                      for name in ('measured', 'true'))
    position_rms = {}
    for kind in alignment.KINDS:
        fitted = alignment.fit_kind(kind, [place.measured for place in aligning],
                                    [place.true for place in aligning])
        position_rms[kind] = alignment.rms(fitted.apply(measured) - true)

    duration = sum(segment.end - segment.start for segment in segments)
    frames = sum(int(recording.between(s.start, s.end).sum()) for s in segments)
    if not len(recording.latency):
        raise ValueError('no message on the topic points was recorded')
    p50, p99 = np.percentile(recording.latency, [50, 99])
    return Score(places, position_rms, statistics.rms([place.scatter for place in places]), circles,
                 frames / duration, float(p50), float(p99), float(np.median(recording.age)))
