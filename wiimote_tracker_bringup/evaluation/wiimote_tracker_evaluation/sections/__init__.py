"""The sections of the evaluation, in the paper's order."""

import importlib
import types
from typing import List

# Name, and approximate duration on two cores [s]: quick, full.
SECTIONS = (('distance', 2, 5), ('latency', 40, 150), ('identification', 10, 100),
            ('positions', 20, 210), ('circles', 10, 40), ('ours', 20, 190), ('cost', 35, 280),
            ('recordings', 60, 60), ('faults', 1, 1))


def names() -> List[str]:
    return [name for name, _, _ in SECTIONS]


def load(name: str) -> types.ModuleType:
    return importlib.import_module(f'{__name__}.{name}')


def seconds(name: str, quick: bool) -> float:
    return next(short if quick else full for each, short, full in SECTIONS if each == name)
