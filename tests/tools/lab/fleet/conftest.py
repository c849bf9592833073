"""What the tests of ale-fleet share."""
import pytest

from fleet_at_work import short_drives


@pytest.fixture(scope="session")
def drives(tmp_path_factory):
    return short_drives(tmp_path_factory.mktemp("drives"))
