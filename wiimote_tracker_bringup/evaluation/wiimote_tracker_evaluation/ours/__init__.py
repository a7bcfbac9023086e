"""The parts of the section ours, one per subject: PROGRAM, QUICK and FULL, the CAPTION of its
table, and tell(run, table); gestures have commands(run) and tell(run)."""
