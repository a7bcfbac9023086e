"""The demonstration: the paper's experiment with the whole system, recorded, scored and shown."""

from wiimote_tracker_bringup.needs import require

require('matplotlib')
