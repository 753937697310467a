"""One process for the bad input of all tests of a run."""

import pytest

from .worker import Worker


@pytest.fixture(scope="session")
def worker():
    with Worker() as started:
        yield started
