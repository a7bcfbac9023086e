"""What the tests of this folder share."""

import pytest

from program import recorded, write


@pytest.fixture
def bag(tmp_path):
    """One LED for two seconds."""
    path = tmp_path / 'recorded.bag'
    write(path, recorded())
    return path
