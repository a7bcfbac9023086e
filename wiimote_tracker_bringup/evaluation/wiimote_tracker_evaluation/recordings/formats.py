"""The formats of recordings that others made, and what is measured on one."""

import dataclasses
import os
import tempfile
from typing import Callable, Dict, List, Tuple

import numpy as np

from wiimote_tracker_bringup.errors import Refusal
from wiimote_tracker_evaluation.recordings import (
    cameras, disturbed, flight, lighthouse, multicamselfcal, reprojection, time_maps)


@dataclasses.dataclass(eq=False)
class Outcome:
    """result: for a file. rows: name and value, as text. scores: by what was tracked or predicted,
    the figures of the recording. errors: of single points, at places on an axis."""

    method: str
    result: Dict
    rows: List[Tuple[str, str]]
    scores: Dict[str, Dict]
    axis: str
    places: np.ndarray
    unit: str
    errors: np.ndarray


def of_flight(views, folder):
    result, times, errors = flight.evaluate(views, folder)
    scores = {'one point': result, 'one point, smoothed': result['smoothed'],
              'body': result.get('body')}
    return Outcome(flight.METHOD, result, list(flight.rows_of(result)),
                   {what: figures for what, figures in scores.items() if figures},
                   'time [s]', times - times.min(), 'mm', 1e3 * errors)


def of_cameras(source, folder):
    views = cameras.read(source)
    maps = time_maps.solve(views, folder)
    outcome = of_flight(time_maps.mapped(views, maps), folder)
    outcome.result['time_maps'] = {}
    for camera, each in zip(views.cameras, maps):
        offset = 1e3 * each.offset + outcome.result['clock_offset_ms'][camera.name]
        outcome.result['time_maps'][camera.name] = {
            'middle_s': each.middle, 'offset_ms': offset, 'drift': each.drift,
            'read_out_ms': 1e3 * each.read_out}
        outcome.rows.append((f'{camera.name}, time map', f'offset {offset:.2f} ms at '
                             f'{each.middle:.1f} s, drift {1e6 * each.drift:.0f} ppm, read-out '
                             f'{1e3 * each.read_out:.2f} ms'))
    return outcome


def of_synchronised(source, folder):
    result, errors = multicamselfcal.evaluate(source, folder)
    rows = [(name, reprojection.sentence(figures)) for name, figures in result.items()]
    corrected = disturbed.evaluate(multicamselfcal.whole(folder), folder)
    rows += disturbed.rows_of(corrected)
    return Outcome(f'{multicamselfcal.METHOD}. {disturbed.METHOD}',
                   {'held_out': result, 'disturbed': corrected}, rows, {'pixels': result['all']},
                   'frame', np.array([frame for frame, _ in errors]), 'px',
                   np.array(list(errors.values())))


@dataclasses.dataclass(eq=False)
class Format:
    """sign: a file that only recordings of this format have. measure: of a recording, with a folder
    for files of its own, to an Outcome."""

    sign: str
    measure: Callable[[str, str], Outcome]


FORMATS = {
    'cameras': Format('detections.csv', of_cameras),
    'lighthouse': Format('bearings.csv.gz', lambda source, folder: of_flight(
        lighthouse.read(source), folder)),
    'multicamselfcal': Format('Res.dat', of_synchronised)}


def measure(name: str, source: str) -> Outcome:
    """@raise Refusal: the recording is damaged, or does not suffice."""
    with tempfile.TemporaryDirectory() as folder:
        outcome = FORMATS[name].measure(source, folder)
    outcome.result['method'] = outcome.method
    return outcome


def found_in(folder: str) -> Dict[str, str]:
    """Formats of the recordings in a folder and below it, by their paths in order.
    @raise Refusal: there is none."""
    found = {}
    for path, _, files in os.walk(folder):
        for name, each in FORMATS.items():
            if each.sign in files:
                found[path] = name
    if not found:
        signs = ' or '.join(sorted(each.sign for each in FORMATS.values()))
        raise Refusal(f'{folder} has no recording: a folder with {signs} is one')
    return dict(sorted(found.items()))
