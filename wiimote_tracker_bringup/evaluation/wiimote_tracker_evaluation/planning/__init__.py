"""Where to put the cameras of a room."""

from wiimote_tracker_evaluation.needs import require

require('scipy')
