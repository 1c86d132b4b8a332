"""What tests of several files read."""

from __future__ import annotations

import os
import pickle
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from plant_support import LEAK, with_known_map, write_bench
from sms import _core
from sms.diagnosis import Diagnosis, diagnose


@pytest.fixture(scope="session")
def leaking_bench(tmp_path_factory: pytest.TempPathFactory) -> Diagnosis:
    """The answer on a bench with a leak past the piston, its valve's map known to 3 %.

    Of several processes that share a run the first leaves it to the others: it takes twenty seconds.
    """
    if not _core.has_estimation:
        pytest.skip("built without Ceres")
    shared = "PYTEST_XDIST_WORKER" in os.environ
    kept = tmp_path_factory.getbasetemp().parent / "leaking_bench.pickle"  # of this run alone
    if shared and kept.exists():
        found = pickle.loads(kept.read_bytes())
        assert isinstance(found, Diagnosis)
        return found
    folder = tmp_path_factory.mktemp("leaking")
    answer = diagnose(with_known_map(write_bench(folder, 2, {"piston_leakage": LEAK})))
    if shared:
        whole = folder / kept.name
        whole.write_bytes(pickle.dumps(answer))
        whole.replace(kept)
    return answer


@pytest.fixture(scope="session")
def exported(tmp_path_factory: pytest.TempPathFactory) -> Any:
    """(kind, version) -> the FMU of the published machine."""
    from sms.fmi import export_fmu  # noqa: PLC0415

    folder = tmp_path_factory.mktemp("fmu")

    def of(kind: str, version: str) -> Path:
        file = folder / f"{kind}-{version}.fmu"
        if not file.exists():
            export_fmu(kind, file, version)
        return file

    return of


@pytest.fixture
def opened(exported: Any, tmp_path: Path) -> Iterator[Any]:
    """(kind, version) -> an instance of it in fmpy; each freed after the test."""
    from fmi_support import Slave  # noqa: PLC0415 (fmpy)

    open_now: list[Slave] = []

    def of(kind: str, version: str) -> Slave:
        open_now.append(Slave(exported(kind, version), tmp_path / f"{kind}-{version}"))
        return open_now[-1]

    yield of
    for slave in open_now:
        slave.fmu.freeInstance()
