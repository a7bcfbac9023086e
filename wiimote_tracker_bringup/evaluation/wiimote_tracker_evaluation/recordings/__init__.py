"""Recordings that others made: calibrated and tracked by the ordinary programs, and measured."""
