"""The sections of the evaluation, in the paper's order."""

import importlib
import importlib.util

# Name, and about how long it takes on two cores [s]: quick, full.
SECTIONS = (('distance', 5, 60), ('latency', 40, 300), ('identification', 15, 240),
            ('positions', 60, 720), ('circles', 15, 120), ('ours', 45, 480), ('cost', 30, 300))


def names():
    """Of all sections there are."""
    return [name for name, _, _ in SECTIONS if importlib.util.find_spec(module_name(name))]


def module_name(name):
    return __name__ + '.' + name


def load(name):
    """The module of a section."""
    return importlib.import_module(module_name(name))


def seconds(name, quick):
    """About how long a section takes."""
    return next(short if quick else full for each, short, full in SECTIONS if each == name)
