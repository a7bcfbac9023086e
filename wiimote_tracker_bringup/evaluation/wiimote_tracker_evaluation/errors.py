"""What goes wrong in an experiment."""


class ExperimentError(Exception):
    """The experiment cannot go on; the text says why and what to do."""
