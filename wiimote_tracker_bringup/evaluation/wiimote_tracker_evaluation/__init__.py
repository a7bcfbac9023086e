"""Evaluates the tracker: sections of the report, measurements on a real rig (live), recordings by
others, the fault matrix (faults), the demonstration (demo)."""

from wiimote_tracker_bringup.needs import require

require('scipy')
