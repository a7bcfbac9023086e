"""Where to put the cameras of a room."""

import importlib.util
import sys

if importlib.util.find_spec('scipy') is None:
    sys.exit('the search needs SciPy: apt install python3-scipy')
