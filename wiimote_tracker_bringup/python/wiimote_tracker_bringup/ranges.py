"""Numbers on the command line, which must be in a range."""

import argparse
from typing import Callable, Type, TypeVar

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
