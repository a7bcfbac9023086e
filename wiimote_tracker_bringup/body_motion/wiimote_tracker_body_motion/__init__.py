"""Motions in bags: comparing two of them, and where a tracked body sits on a robot."""

from wiimote_tracker_bringup.needs import require

require('scipy')
