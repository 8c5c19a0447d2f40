"""What the tests of the sources share."""

from types import ModuleType

import pytest

from tests.engine import skeleton_files


@pytest.fixture(scope="session")
def made() -> ModuleType:
    """The makers of skeletons and of files in every format."""
    return skeleton_files
