"""How many threads the core takes: from the option, from the environment, and what neither can be."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import sms.diagnosis
from plant_support import write_bench
from sms import _core
from sms.cli.command import app
from sms.diagnosis import pipeline
from sms.diagnosis.preparation import make_data
from sms.errors import InputError
from sms.io.records import load_record
from sms.io.rig import load_rig
from sms.rigs.threads import VARIABLE, threads
from typer.testing import CliRunner


def test_the_environment_says_how_many(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv(VARIABLE, raising=False)
    assert threads() == 2
    monkeypatch.setenv(VARIABLE, " 7 ")
    assert threads() == 7
    for wrong in ("many", "0", "-1", "2.5"):
        monkeypatch.setenv(VARIABLE, wrong)
        with pytest.raises(InputError, match=r"SMS_THREADS is .* 1 or more"):
            threads()


@pytest.mark.parametrize(("options", "seen"), [((), 5), (("--threads", "3"), 3)])
def test_the_option_goes_before_the_environment(
    options: tuple[str, ...], seen: int, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv(VARIABLE, "5")
    asked: list[int] = []

    def instead(*_: Any) -> None:
        asked.append(threads())
        raise InputError("that is all")

    monkeypatch.setattr(sms.diagnosis, "diagnose", instead)
    out = str(tmp_path / "o")
    told = CliRunner().invoke(app, ["diagnose", "rig.toml", "--out", out, *options])
    assert str(told.exception) == "that is all"
    assert asked == [seen]


def test_no_threads_are_refused() -> None:
    assert CliRunner().invoke(app, ["diagnose", "rig.toml", "--threads", "0"]).exit_code == 2


def test_what_is_wrong_with_the_environment_is_no_fault_of_a_record(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv(VARIABLE, "two")
    with pytest.raises(InputError, match=f"^{VARIABLE} is 'two'"):
        pipeline.diagnose("no rig file is looked for")


@pytest.mark.skipif(not _core.has_estimation, reason="built without Ceres")
def test_several_threads_work_out_the_same_bits(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """Which is why all other tests of a run on several cores do with one each."""
    rig = load_rig(write_bench(tmp_path, 3, {}))
    names, found = ["coulomb_force", "mass_flow_gain", "valve_frequency"], []
    for number in ("1", "2", "3"):
        monkeypatch.setenv(VARIABLE, number)
        data = make_data(rig, [load_record(rig, source) for source in rig.records])
        found.append(data.identify.problem.evaluate(rig.start(), names))
    for residual, jacobian in found[1:]:
        assert np.array_equal(residual, found[0][0])
        assert np.array_equal(jacobian, found[0][1])
