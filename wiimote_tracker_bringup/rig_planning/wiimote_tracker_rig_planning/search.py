"""Searches places and aims of cameras: greedily, and then all together.

All together by differential evolution (R. Storn and K. Price, J. Global Optimization 11, 1997),
which begins with the greedy result and so never ends with a worse one.
"""

import itertools

import numpy as np
from scipy.optimize import differential_evolution

from wiimote_tracker_rig_planning.prediction import cost

PER_CAMERA = 7   # numbers from 0 to 1: which stand, where in it, target in the volume
ACROSS = 4       # points along an edge of the volume
CANDIDATES = 500  # of the greedy search, for each camera
POPULATION = 3    # of the evolution, for each number


def across(plan):
    """A body takes longer, for its LEDs and headings."""
    return ACROSS - 1 if plan.body else ACROSS


def decode(plan, numbers):
    """Positions and targets, each N x 3."""
    numbers = np.asarray(numbers).reshape(-1, PER_CAMERA)
    stands = np.array(plan.stands)
    stand = stands[np.minimum((numbers[:, 0] * len(stands)).astype(int), len(stands) - 1)]
    volume = np.array(plan.volume)
    return (stand[:, :3] + numbers[:, 1:4] * (stand[:, 3:] - stand[:, :3]),
            volume[:3] + numbers[:, 4:7] * (volume[3:] - volume[:3]))


def rating(plan, tell=lambda: None):
    """The cost by the numbers of some cameras. tell: called at each."""
    points = plan.grid(across(plan))

    def rate(numbers):
        tell()
        return cost(plan, *decode(plan, numbers), points)
    return rate


def greedy(plan, random, rate=None):
    """Each camera where it helps most beside those before."""
    rate = rate or rating(plan)
    chosen = np.zeros(0)
    for _ in range(plan.cameras):
        trials = [np.append(chosen, each)
                  for each in random.random_sample((CANDIDATES, PER_CAMERA))]
        chosen = min(trials, key=rate)
    return chosen


def proposal(plan):
    """A quick one: positions and targets, each N x 3."""
    return decode(plan, greedy(plan, np.random.RandomState(1)))


def search(plan, seed, generations, tell=lambda share: None):
    """Positions and targets, each N x 3. seed: the same gives the same. tell: of the share done."""
    random = np.random.RandomState(seed)
    numbers = plan.cameras * PER_CAMERA
    population = POPULATION * numbers
    rates = plan.cameras * CANDIDATES + (generations + 1) * population
    done = itertools.count()
    rate = rating(plan, lambda: tell(next(done) / rates))
    first = greedy(plan, random, rate)
    start = random.random_sample((population, numbers))
    near = np.clip(first + 0.1 * random.standard_normal(start.shape), 0.0, 1.0)
    start[::2] = near[::2]
    start[0] = first
    found = differential_evolution(rate, numbers * [(0.0, 1.0)], init=start, maxiter=generations,
                                   seed=seed, polish=False, tol=1e-4)
    tell(1.0)  # it may end before all generations
    return decode(plan, found.x)
