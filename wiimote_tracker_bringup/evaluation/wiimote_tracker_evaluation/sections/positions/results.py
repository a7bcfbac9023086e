"""Results of the program evaluate_positions, by cameras, method and ray model."""

import dataclasses
import os

import numpy as np

from wiimote_tracker_bringup.programs import read_csv
from wiimote_tracker_evaluation.sessions import joined, where

CASES = ('C1', 'C2', 'C3', 'C4', 'C5')
OURS = ('square', 'wave', 'wand')
TWO, FACING, FOUR = '1 2', '1 3', '1 2 3 4'  # cameras, as the tables name them


@dataclasses.dataclass(eq=False)
class Group:
    """One method in all sessions: arrays of sessions x points x 3 [m]; covariance, sessions x
    points x 3 x 3 [m^2], NaN if not stated. Sessions that could not be solved are NaN."""

    nominal: np.ndarray
    true: np.ndarray
    measured: np.ndarray
    covariance: np.ndarray

    def from_nominal(self):
        """From the nominal position of the LED, as in the paper: solved sessions x points [m]."""
        return solved(np.linalg.norm(self.measured - self.nominal, axis=2))

    def from_truth(self):
        return solved(np.linalg.norm(self.measured - self.true, axis=2))

    def unsolved(self):
        return int(np.isnan(self.measured).any(axis=(1, 2)).sum())

    def stated(self):
        """Mean squared error predicted by the covariances, sessions x points [m^2]."""
        return np.trace(self.covariance, axis1=2, axis2=3)

    def normalised(self):
        """NEES by the stated covariances; its mean is 3 if they are right."""
        error = self.measured - self.true
        whitened = np.linalg.solve(self.covariance, error[..., None])[..., 0]
        return solved((error * whitened).sum(axis=2))


def solved(values):
    return values[~np.isnan(values).any(axis=1)]


class Results:
    """sessions: their number."""

    def __init__(self, folders):
        self.points, self.places, self.traces = (
            joined([read_csv(os.path.join(folder, name)) for folder in folders])
            for name in ('points.csv', 'places.csv', 'traces.csv'))
        self.sessions = len(np.unique(self.points['session']))

    def has(self, cameras):
        return bool((self.points['cameras'] == cameras).any())

    def group(self, cameras, method, ray_model='calibrated', places=False):
        """places: of the 27 in the whole cube instead of the ten points."""
        table = self.places if places else self.points
        chosen = where(table, cameras=cameras, method=method, ray_model=ray_model)
        number = 27 if places else 10

        def triple(name):
            return np.stack([table[f'{name}_{axis}'][chosen] for axis in 'xyz'],
                            axis=1).reshape(-1, number, 3)

        covariance = np.stack([
            table['var_' + ''.join(sorted(pair))][chosen]
            for pair in ('xx', 'xy', 'xz', 'yx', 'yy', 'yz', 'zx', 'zy', 'zz')], axis=1)
        return Group(triple('nominal'), triple('true'), triple('measured'),
                     covariance.reshape(-1, number, 3, 3))

    def trace(self, cameras, case, ray_model, session):
        """Rounds of one correction, by camera: arrays by column name."""
        chosen = where(self.traces, cameras=cameras, case=case, ray_model=ray_model,
                       session=session)
        numbers = np.unique(self.traces['camera'][chosen])
        return [{name: values[chosen & (self.traces['camera'] == number)]
                 for name, values in self.traces.items()} for number in numbers]

    def last_round(self, cases, ray_model):
        """Rows of the traces after the last round of each correction, as arrays by column name."""
        traces = self.traces
        chosen = np.isin(traces['case'], cases) & (traces['ray_model'] == ray_model)
        keys = list(zip(traces['session'], traces['cameras'], traces['case'], traces['camera']))
        last = {keys[row]: row for row in np.flatnonzero(chosen)}  # rounds are sorted
        return {name: values[sorted(last.values())] for name, values in traces.items()}
