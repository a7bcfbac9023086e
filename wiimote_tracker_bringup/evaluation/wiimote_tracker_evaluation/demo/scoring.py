"""Computes figures from a recording and its segments, as summary.json has them."""

from typing import Dict, Tuple

import numpy as np

from wiimote_tracker_bringup import alignment, experiment, statistics
from wiimote_tracker_bringup.errors import Refusal


def milli(value: float) -> float:
    """In mm or ms, from m or s."""
    return round(1e3 * float(value), 4)


def measured_place(recording, segment) -> Tuple[np.ndarray, np.ndarray, float, int]:
    """Position of a still LED and mean of the measurements [m]; standard deviation of single points
    about that mean, over all three axes [m]; number of points."""
    inside = recording.between(segment.start, segment.end)
    frames = int(inside.sum())
    if frames < 2:
        raise Refusal(f'only {frames} points were published while the LED was at '
                      f'{segment.name}; see nodes.log')
    positions = recording.position[inside]
    measured = positions.mean(axis=0)
    true = recording.truth_at(recording.stamp[inside]).mean(axis=0)
    scatter = np.sqrt(((positions - measured) ** 2).sum() / (frames - 1))
    return true, measured, float(scatter), frames


def measured_circle(recording, segment) -> Dict:
    """RMS of single points: distance from the axis minus the radius, and height."""
    inside = recording.between(segment.start, segment.end)
    if not inside.any():
        raise Refusal(f'no point was published during the {segment.name}; see nodes.log')
    offset = recording.position[inside] - np.asarray(segment.target)
    radial = np.hypot(offset[:, 0], offset[:, 1]) - experiment.CIRCLE_RADIUS
    return {'name': segment.name, 'radial_rms_mm': milli(statistics.rms(radial)),
            'height_rms_mm': milli(statistics.rms(offset[:, 2])), 'frames': int(inside.sum())}


def score(recording, segments) -> Dict:
    """Score of a recording. position_rms_mm: of the test points, by kind of alignment. rate_hz: of
    points while measuring. latency_ms: from a report's arrival to its point. point_age_ms: from the
    instant of a point to its arrival at the recorder. point_scatter_mm: of single points, RMS over
    the places. @raise Refusal: something was not measured."""
    names = [segment.name for segment in segments if segment.kind == 'test']
    (true, measured, scatter, frames), (aligning_true, aligning, _, _) = (
        [np.array(values) for values in zip(*(measured_place(recording, segment)
                                              for segment in segments if segment.kind == kind))]
        for kind in ('test', 'alignment'))
    circles = [measured_circle(recording, segment) for segment in segments
               if segment.kind == 'circle']
    duration = sum(segment.end - segment.start for segment in segments)
    published = sum(int(recording.between(s.start, s.end).sum()) for s in segments)
    if not len(recording.latency):
        raise Refusal('no message on the topic points was recorded; see nodes.log')
    p50, p99 = np.percentile(recording.latency, [50, 99])
    return {
        'position_rms_mm': {kind: milli(alignment.rms(
            alignment.fit_kind(kind, aligning, aligning_true).apply(measured) - true))
            for kind in alignment.KINDS},
        'rate_hz': round(published / duration, 2),
        'latency_ms': {'p50': milli(p50), 'p99': milli(p99)},
        'point_age_ms': {'p50': milli(np.median(recording.age))},
        'point_scatter_mm': milli(statistics.rms(scatter)),
        'points': [{'name': name, 'true_m': at.round(6).tolist(),
                    'measured_m': found.round(6).tolist(),
                    'error_mm': milli(np.linalg.norm(found - at)), 'frames': int(number)}
                   for name, at, found, number in zip(names, true, measured, frames)],
        'circles': circles}
