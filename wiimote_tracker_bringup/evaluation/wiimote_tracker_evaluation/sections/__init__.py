"""The sections of the evaluation, in the paper's order."""

import importlib
import types

NAMES = ('distance', 'latency', 'identification', 'positions', 'circles', 'ours', 'cost',
         'recordings', 'faults')


def load(name: str) -> types.ModuleType:
    return importlib.import_module(f'{__name__}.{name}')
