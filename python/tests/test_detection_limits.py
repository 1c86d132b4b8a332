"""Detection limits: against the linear theory, against what an experiment cannot show, and the command."""

from __future__ import annotations

import csv
from dataclasses import replace
from pathlib import Path

import pytest
from sms import _core
from sms.cli import app
from sms.diagnosis.design.detection_limits import (
    Limit,
    Row,
    detection_limits,
    limits_of,
    published_rig,
)
from sms.diagnosis.effects.catalogue import effects_of
from sms.io import InputError
from sms.io.declarations import Declaration
from sms.rigs import kinds
from sms.rigs.kinds import KINDS
from typer.testing import CliRunner

pytestmark = pytest.mark.skipif(not _core.has_estimation, reason="built without Ceres")


@pytest.fixture
def short_menu(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two experiments of the tank's menu: short bursts, and the valve hardly open."""
    tank = KINDS["tank"]
    monkeypatch.setattr(kinds, "KINDS", {"tank": replace(tank, menu=tank.menu[1:3])})


def test_a_limit_is_three_standard_errors_and_grows_with_the_noise() -> None:
    rig = published_rig("tank")
    kind = KINDS["tank"]
    effects = [e for e in effects_of(rig) if e.key in ("fitting_leakage of lower", "command_delay")]
    run = kind.menu[0].simulated(rig, rig.start(), ("tank_pressure",))
    assert run is not None
    noise = {s: 1.0 for s in kind.outputs} | {"tank_pressure": 300.0}
    quiet = limits_of(rig, kind, [run], noise, effects)
    loud = limits_of(rig, kind, [run], noise | {"tank_pressure": 600.0}, effects)
    # In proportion to the noise, but for what is declared as uncertain, which noise does not change.
    for a, b in zip(quiet, loud, strict=True):
        assert a.size is not None and b.size is not None
        assert 1.0 < b.size / a.size <= 2.0 + 1e-6


def test_a_shift_counts_from_the_end_of_the_declared_uncertainty() -> None:
    rig, kind = published_rig("tank"), KINDS["tank"]
    effects = [e for e in effects_of(rig) if e.key == "valve_centre_offset"]
    run = kind.menu[0].simulated(rig, rig.start(), ("tank_pressure",))
    assert run is not None
    noise = {s: 1.0 for s in kind.outputs} | {"tank_pressure": 300.0}

    def limit(uncertainty: float) -> Limit:
        centre = {"valve_centre": Declaration(5.0, uncertainty)}
        (found,) = limits_of(replace(rig, parameters=centre), kind, [run], noise, effects)
        return found

    exactly, roughly = limit(0.0), limit(0.03)
    assert exactly.size is not None and roughly.size is not None
    assert (exactly.declared, roughly.declared) == (0.0, 0.03)
    assert roughly.size == pytest.approx(0.03 + exactly.size, rel=1e-9)


def test_the_command_writes_table_and_page(short_menu: None, tmp_path: Path) -> None:
    done = CliRunner().invoke(
        app, ["limits", "tank", "--out", str(tmp_path / "out")], catch_exceptions=False
    )
    assert done.exit_code == 0
    assert "1  Bursts of a tenth of a second" in done.output
    rows = list(csv.DictReader((tmp_path / "out" / "limits.csv").open()))
    assert len({r["experiment"] for r in rows}) == 2
    size = {(r["effect"], r["experiment"]): float(r["size"] or "inf") for r in rows}
    late = [v for (e, _), v in size.items() if e == "command_delay"]
    assert late[0] < 0.7 * late[1]  # what is late shows where the valve is opened often
    assert all(r["reason"] for r in rows if not r["size"])
    page = (tmp_path / "out" / "limits.html").read_text()
    assert "Detection limits" in page and 'class="heat"' in page


def test_a_folder_that_cannot_be_made_is_said(short_menu: None) -> None:
    done = CliRunner().invoke(app, ["limits", "tank", "--out", "/proc/nowhere"])
    assert isinstance(done.exception, InputError)
    assert "/proc/nowhere/limits.csv: cannot be written" in str(done.exception)


def test_a_kind_without_menu_is_refused(tmp_path: Path) -> None:
    rig = replace(published_rig("tank"), kind="cylinder", path=tmp_path / "rig.toml")
    with pytest.raises(InputError, match="a cylinder has no menu of experiments"):
        detection_limits(rig)


def test_a_machine_that_nobody_published_is_refused_by_those_that_are() -> None:
    with pytest.raises(InputError, match=r"nosuch: neither .* those are tank, bench, platform"):
        detection_limits("nosuch")
    with pytest.raises(InputError, match="there is no such rig file"):
        detection_limits("nosuch.toml")


def test_the_best_experiment_has_the_smallest_limit() -> None:
    rig = published_rig("tank")
    row = Row(effects_of(rig)[0], "V", (Limit(None, "x"), Limit(2.0), Limit(0.5)))
    assert row.best == 0.5
