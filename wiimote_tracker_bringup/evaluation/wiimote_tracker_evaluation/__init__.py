"""Runs the paper's experiment on the tracker and measures the errors."""

from wiimote_tracker_bringup.needs import require

require('scipy')
