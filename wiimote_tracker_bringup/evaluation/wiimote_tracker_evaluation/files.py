"""Files that people name."""

import os
from typing import Iterable, Optional

from wiimote_tracker_evaluation.errors import ExperimentError


def check_distinct(to_write: Iterable[Optional[str]], to_read: Iterable[Optional[str]]) -> None:
    """Empty names are no files. Throws ExperimentError if a file to write is also to be read, or to
    be written as something else."""
    taken = {os.path.realpath(path) for path in to_read if path}
    for path in filter(None, to_write):
        if os.path.realpath(path) in taken:
            raise ExperimentError(f'two arguments are {path}: write to another file')
        taken.add(os.path.realpath(path))
