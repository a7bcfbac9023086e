"""A section of the evaluation in execution, for tests of its parts."""

import argparse

from wiimote_tracker_evaluation.section import Run


def section_run(folder, name='a', **options):
    """options: of the command line, where they are not the default ones."""
    return Run(name, name, str(folder), argparse.Namespace(
        **dict({'rig': '', 'quick': False, 'seed': 1, 'live': False}, **options)))
