"""Where the tests find the modules of the source tree."""

import os
import sys

HERE = os.path.dirname(os.path.realpath(__file__))
sys.path[:0] = [os.path.join(HERE, '..', folder) for folder in (
    'body_motion', 'evaluation', 'python', 'rig_planning', 'scripts')]
