"""Python packages that the tracker's Debian package does without."""

import importlib.util
import os
import sys


def require(*names: str) -> None:
    """Ends the program with what to do if one of these packages is missing."""
    missing = [name for name in names if not importlib.util.find_spec(name)]
    if missing:
        sys.exit(f'{os.path.basename(sys.argv[0])} needs Python packages that are missing; run: '
                 'apt install ' + ' '.join('python3-' + name for name in missing))
