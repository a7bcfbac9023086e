"""Subjects beyond the paper: occlusion, more cameras, bodies, gestures.

One module per subject. Those that simulate a room have PROGRAM, QUICK and FULL, the CAPTION of its
table, and tell(run, table); the others have tell(run).
"""

from wiimote_tracker_evaluation.sections.ours import bodies, cameras, gestures, occlusion
from wiimote_tracker_evaluation.section import Option
from wiimote_tracker_evaluation.sessions import keep, read_shared, shared

TITLE = 'Beyond the paper'
SECONDS = 20, 190
OPTION = Option('gestures', 'DIR', gestures.folder_of_people,
                'recordings of your own gestures: a folder per person with a CSV per gesture')

PARTS = (occlusion, cameras)


def run(run):
    commands = [command for part in PARTS for command in shared(
        run, part.PROGRAM, part.QUICK if run.quick else part.FULL, 2)]
    run.compute(commands + bodies.commands(run), 'measuring in simulated time', 0.0, 0.9)
    for number, part in enumerate(PARTS):
        run.progress(0.9 + 0.1 * number / (len(PARTS) + 1), 1.0, 'drawing')
        table = read_shared(run, part.PROGRAM)
        part.tell(run, table)
        keep(run, part.PROGRAM.replace('evaluate_', ''), table, part.CAPTION)
    run.progress(0.9 + 0.1 * len(PARTS) / (len(PARTS) + 1), 1.0, 'drawing')
    bodies.tell(run)
    gestures.tell(run)
