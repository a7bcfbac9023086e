"""Where to put the cameras of a room."""

from wiimote_tracker_bringup.needs import require

require('scipy')
