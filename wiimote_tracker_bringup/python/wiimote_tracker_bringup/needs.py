"""Python packages that the tracker's Debian package only recommends."""

import importlib.util
import os
import sys


OPTIONAL = ('matplotlib', 'scipy')


def require(name: str) -> None:
    """Ends the program with what to do if this one of them is missing; names all that are."""
    missing = [each for each in OPTIONAL if not importlib.util.find_spec(each)]
    if name in missing:
        sys.exit(f'{os.path.basename(sys.argv[0])} needs Python packages that are missing; run: '
                 'apt install ' + ' '.join('python3-' + each for each in missing))
