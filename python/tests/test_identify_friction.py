"""Friction identification: truth recovered, what motions cannot show, bad records named."""

from __future__ import annotations

import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from sms import _core
from sms.identification.friction import identify_friction
from sms.identification.friction_fit import collinearity, fit_law
from sms.identification.friction_result import declarations, sentences
from sms.io import InputError
from test_cli_diagnose import sms as command

from validation.twins.friction_runs import Run, draw

RUNS = (
    Run(0.10, 0.10, 20.0, "identify"),
    Run(0.33, 0.08, 12.0, "identify"),
    Run(0.45, 0.06, 10.0, "identify"),
    Run(0.25, 0.10, 12.0, "validate"),
)
SLOW = (Run(0.02, 0.08, 60.0, "identify"),)


def test_the_source_s_law_comes_back_and_beats_its_rivals(tmp_path: Path) -> None:
    result = identify_friction(draw(tmp_path, 4, RUNS, scatter=0.02))
    told = {t.name: t for t in result.law("acceleration_dependent").told}
    for name, truth in (
        ("coulomb_force", 38.0),
        ("viscous_friction", 530.0),
        ("stiction_force", 77.27),
        ("stribeck_acceleration_factor", 0.9),
    ):
        assert told[name].shown
        assert abs(told[name].value - truth) < 4.0 * told[name].error, name
        assert told[name].value == pytest.approx(truth, rel=0.15)
    assert np.isfinite(told["coulomb_force"].scatter)
    assert result.best == "acceleration_dependent"
    best = result.law("acceleration_dependent")
    assert all(best.rms_validate <= f.rms_validate for f in result.laws)
    assert best.rms_validate < 1.3 * best.rms_identify
    assert not told["exponential_friction_force"].shown  # the truth has none


def test_a_slow_run_does_not_claim_what_it_cannot_show(tmp_path: Path) -> None:
    result = identify_friction(draw(tmp_path, 4, SLOW))
    best = result.law("acceleration_dependent")
    left_out = dict(best.left_out)
    assert (
        "stiction_force" in left_out
    )  # at small |a| the term vanishes, as the source's own law says
    assert "stribeck_acceleration_factor" in left_out
    assert "stiction_force" not in declarations(result)
    assert any("One run only" in text for text in sentences(result))
    coulomb = next(t for t in best.told if t.name == "coulomb_force")
    assert coulomb.value == pytest.approx(38.0, rel=0.15)


def test_a_piston_that_never_moves_is_named(tmp_path: Path) -> None:
    rig = draw(tmp_path, 4, SLOW)
    rig.write_text(rig.read_text().replace("2 mm/s", "2 m/s"))
    with pytest.raises(InputError, match="never moves"):
        identify_friction(rig)


def test_collinearity_is_one_for_orthogonal_columns_and_large_for_twins() -> None:
    assert collinearity(np.eye(3)) == pytest.approx(1.0)
    twin = np.array([[1.0, 1.0], [0.0, 1e-3]])
    assert collinearity(twin / np.linalg.norm(twin, axis=0)) > 1e3


def test_the_command_writes_a_rig_file_with_what_was_found(tmp_path: Path) -> None:
    rig = draw(tmp_path / "records", 4, RUNS[:2])
    result = command("identify", "friction", str(rig), "--out", "friction", cwd=tmp_path)
    assert result.returncode == 0, result.stderr
    assert "eq. 6.5" in result.stdout
    found = tomllib.loads((tmp_path / "friction" / "friction.toml").read_text())
    assert "uncertainty" in found["parameters"]["coulomb_force"]
    again = identify_friction(tmp_path / "friction" / "friction.toml")  # every reader takes it
    assert again.law("acceleration_dependent").told
    assert 'id="map"' in (tmp_path / "friction" / "report.html").read_text()


@pytest.mark.filterwarnings("ignore:Mean of empty slice", "ignore:invalid value")
def test_a_record_that_tells_nothing_by_itself_is_named(tmp_path: Path) -> None:
    first, second, *_ = identify_friction(draw(tmp_path, 4, RUNS)).motions
    nothing = replace(second, used=np.zeros_like(second.used))
    with pytest.raises(InputError, match=f"record {second.name}: by itself"):
        fit_law("two_branch", [first, nothing], [], _core.Params(), ())
