"""Motions in bags: comparing two of them, and where a tracked body sits on a robot."""

import importlib.util
import sys

if importlib.util.find_spec('scipy') is None:
    sys.exit('rotations need SciPy: apt install python3-scipy')
