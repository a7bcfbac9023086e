"""What programs refuse, and how they say it."""


class Refusal(Exception):
    """What was wanted is not possible; the text says why and what to do."""


def sentence_of(error: Exception) -> str:
    """What a program says of it; of a file that cannot be used also what to do."""
    if isinstance(error, OSError) and error.filename:
        return f'{error.filename}: {error.strerror}; check its name and permissions'
    return str(error)
