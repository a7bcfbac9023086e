"""Errors of an experiment."""


class ExperimentError(Exception):
    """The experiment cannot continue; the text says why and what to do."""
