"""Numbers that people give, which must be in a range."""

import argparse
from typing import Callable, Type, TypeVar

from wiimote_tracker_bringup.errors import ExperimentError

Number = TypeVar('Number', int, float)


def within(least: Number, most: Number, kind: Type[Number] = float) -> Callable[[str], Number]:
    """A type for argparse, which puts the option's name before the refusal."""
    def read(text: str) -> Number:
        try:
            value = kind(text)
        except ValueError:
            words = 'a whole number' if kind is int else 'a number'
            raise argparse.ArgumentTypeError(f'{text!r} is not {words}') from None
        if not least <= value <= most:  # nor is NaN
            raise argparse.ArgumentTypeError(f'{text} is not within {least} and {most}')
        return value
    return read


def check(name: str, value: object, least: float, most: float) -> float:
    """The value of a parameter. Throws ExperimentError if it is no number within the range."""
    if isinstance(value, (int, float)) and not isinstance(value, bool) and least <= value <= most:
        return value
    raise ExperimentError(f'{name} is {value!r}, but must be within {least} and {most}: correct it')
