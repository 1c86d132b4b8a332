"""What tests of several files read."""

from __future__ import annotations

import pytest
from plant_support import LEAK, write_bench
from sms import _core
from sms.diagnosis import Diagnosis, diagnose


@pytest.fixture(scope="session")
def leaking_bench(tmp_path_factory: pytest.TempPathFactory) -> Diagnosis:
    """The answer on a bench with a leak past the piston."""
    if not _core.has_estimation:
        pytest.skip("built without Ceres")
    return diagnose(write_bench(tmp_path_factory.mktemp("leaking"), 2, {"piston_leakage": LEAK}))
