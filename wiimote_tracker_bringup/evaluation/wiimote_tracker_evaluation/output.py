"""The folder for a program's results."""

import os
import shutil
import tempfile
from typing import Iterable

from wiimote_tracker_evaluation.errors import ExperimentError


def prepare(folder: str, names: Iterable[str]) -> None:
    """Makes it, and removes files and folders of an earlier run that have these names."""
    try:
        os.makedirs(folder, exist_ok=True)
        tempfile.TemporaryFile(dir=folder).close()
        for path in (os.path.join(folder, name) for name in names):
            if os.path.isdir(path) and not os.path.islink(path):
                shutil.rmtree(path)
            elif os.path.lexists(path):
                os.remove(path)
    except OSError as error:
        raise ExperimentError(f'cannot write to {folder}: {error.strerror}; choose another folder '
                              'with --output')
