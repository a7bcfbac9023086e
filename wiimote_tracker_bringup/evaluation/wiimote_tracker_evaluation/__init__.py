"""Runs the paper's experiment on the tracker and measures the errors."""
