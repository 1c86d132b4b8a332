"""Actuator identification: truth recovered, what records cannot tell, bad records named with what is left."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from sms.identification.actuator import BenchResult, identify_actuator
from sms.identification.bench_records import load_bench
from sms.identification.bench_result import declarations, sentences, to_dict
from sms.identification.spool import identify_spool
from sms.identification.spool_result import sentences as spool_sentences
from sms.io import InputError
from sms.io.clipping import stuck_at_extremes
from sms.report.actuator import actuator_html
from test_cli_diagnose import refused
from test_cli_diagnose import sms as command

from validation.twins.actuator_runs import draw

SEED = 2
Drawn = tuple[Path, dict[str, float]]
Change = Callable[[Any], Any]


@pytest.fixture(scope="module")
def drawn(tmp_path_factory: pytest.TempPathFactory) -> Drawn:
    """Three short runs with their truth."""
    out = tmp_path_factory.mktemp("actuator")
    truth = draw(out, SEED, excited_by=("multisine", "steps"), validate=("chirp",), duration=3.0)
    return out / "rig.toml", truth


@pytest.fixture(scope="module")
def identified(drawn: Drawn) -> BenchResult:
    return identify_actuator(drawn[0])


def changed(rig: Path, to: Path, record: str, **columns: Change) -> Path:
    """The rig with one record's columns replaced."""
    to.mkdir()
    for file in rig.parent.glob("*.csv"):
        table = pd.read_csv(file)
        if file.stem == record:
            for name, make in columns.items():
                column = next(c for c in table.columns if c.startswith(name))
                table[column] = make(table[column])
        table.to_csv(to / file.name, index=False)
    (to / "rig.toml").write_text(rig.read_text())
    return to / "rig.toml"


def test_the_truth_of_an_independent_machine_comes_back(
    drawn: Drawn, identified: BenchResult
) -> None:
    fit = identified.fit
    told = {t.name: t for t in fit.wanted}
    for name in ("moving_mass", "mass_flow_gain", "coulomb_force", "viscous_friction"):
        assert told[name].told, name
        assert abs(told[name].value - drawn[1][name]) < 4.5 * told[name].error, name
    assert told["mass_flow_gain"].value == pytest.approx(drawn[1]["mass_flow_gain"], rel=0.03)
    assert told["viscous_friction"].value == pytest.approx(drawn[1]["viscous_friction"], rel=0.02)
    assert fit.found.scale == pytest.approx(1.0, abs=0.15)


def test_ratios_that_only_count_with_the_gain_are_named(identified: BenchResult) -> None:
    left_out = dict(identified.fit.left_out)
    assert "product" in left_out["inflow_heat_ratio"]
    assert "product" in left_out["outflow_heat_ratio"]
    assert "inflow_heat_ratio" not in declarations(identified)


def test_unseen_records_are_predicted_better_than_as_declared(identified: BenchResult) -> None:
    extension = [g for g in identified.fit.gain if g.channel == "extension"]
    assert extension
    assert all(g.after < 0.5 * g.before for g in extension)
    assert all(g.after < 2.0 * g.noise for g in identified.fit.gain)
    assert any("One supply pressure only" in text for text in sentences(identified))


def test_page_and_json_hold_everything(identified: BenchResult) -> None:
    page = actuator_html(identified)
    for part in ("parameters", "fits", "gain", "runs", "correlation", "surroundings", "not-told"):
        assert f'id="{part}"' in page
    answer = to_dict(identified)
    names = answer["covariance"]["names"]
    assert np.asarray(answer["covariance"]["values"]).shape == (len(names), len(names))


def test_without_motion_nothing_of_mass_and_friction_is_asked(drawn: Drawn, tmp_path: Path) -> None:
    blocked: dict[str, Change] = {
        "extension": lambda x: 0.2 + 1e-5 * np.sin(np.arange(x.size)),
        "valve_command": lambda u: u.clip(
            lower=5.0
        ),  # both ways it would be a dead sensor's record
    }
    rig = changed(drawn[0], tmp_path / "a", "identify_1_multisine", **blocked)
    notes = load_bench(rig, "actuator").notes
    assert any("mass and friction are not identifiable" in n and "dead volumes" in n for n in notes)


def test_records_that_do_not_stir_are_refused_with_what_to_do(drawn: Drawn, tmp_path: Path) -> None:
    rng = np.random.default_rng(1)
    still: dict[str, Change] = {
        "valve_command": lambda u: np.full(u.size, 5.0),
        "extension": lambda x: 0.2 + 1e-5 * rng.standard_normal(x.size),
        "chamber_pressure_lower": lambda x: 2.8e5 + 300.0 * rng.standard_normal(x.size),
        "chamber_pressure_upper": lambda x: 2.9e5 + 300.0 * rng.standard_normal(x.size),
    }
    rig = changed(drawn[0], tmp_path / "a", "identify_1_multisine", **still)
    rig = changed(rig, tmp_path / "b", "identify_2_steps", **still)
    with pytest.raises(InputError, match="nothing can be identified; record a run"):
        load_bench(rig, "actuator")


def test_a_clipped_sensor_costs_its_windows_only(drawn: Drawn, tmp_path: Path) -> None:
    def clip(values: pd.Series) -> pd.Series:
        return values.clip(upper=float(values.quantile(0.95)))

    rig = changed(drawn[0], tmp_path / "a", "identify_1_multisine", chamber_pressure_lower=clip)
    records = load_bench(rig, "actuator")
    assert any("clipped" in n and "windows" in n for n in records.notes)
    assert 0.3 < records.counted.mean() < 1.0
    ramp = np.linspace(0.0, 1.0, 500)
    assert not stuck_at_extremes(ramp).any()
    assert stuck_at_extremes(np.minimum(ramp, 0.9)).sum() == pytest.approx(50, abs=2)


def test_a_record_that_cannot_be_used_is_left_out_and_named(drawn: Drawn, tmp_path: Path) -> None:
    def dead(values: pd.Series) -> pd.Series:
        return values.where(values.index < 5, 2.9e5)

    one = {"chamber_pressure_lower": dead}
    rig = changed(drawn[0], tmp_path / "a", "identify_1_multisine", **one)
    records = load_bench(rig, "actuator")
    assert [m.name for m in records.identify.motions] == ["identify_2_steps"]
    assert any("identify_1_multisine is left out" in note for note in records.notes)
    none = changed(rig, tmp_path / "b", "identify_2_steps", **one)
    with pytest.raises(InputError, match="left out"):
        load_bench(none, "actuator")


def test_the_command_writes_a_rig_file_that_every_command_reads(
    tmp_path: Path,
) -> None:
    draw(tmp_path / "records", SEED, excited_by=("multisine",), duration=2.5)
    rig = tmp_path / "records" / "rig.toml"
    result = command("identify", "actuator", str(rig), "--out", "actuator", cwd=tmp_path)
    assert result.returncode == 0, result.stderr
    assert "Identified: " in result.stdout
    assert "One record only" in result.stdout
    found = tomllib.loads((tmp_path / "actuator" / "actuator.toml").read_text())
    assert "uncertainty" in found["parameters"]["mass_flow_gain"]
    assert load_bench(tmp_path / "actuator" / "actuator.toml", "actuator").moves
    answer = json.loads((tmp_path / "actuator" / "actuator.json").read_text())
    assert {p["name"] for p in answer["parameters"]} >= {"moving_mass", "coulomb_force"}
    other = tmp_path / "tank.toml"
    other.write_text(rig.read_text().replace('"bench"', '"cylinder"'))
    refused(command("identify", "actuator", str(other), cwd=tmp_path), "tank.toml")


@pytest.mark.full
def test_the_spool_shows_in_the_pressures(drawn: Drawn) -> None:
    result = identify_spool(drawn[0])
    assert result.position is None
    assert result.pressure is not None
    assert any("position was not measured" in text for text in spool_sentences(result))
    told = {t.name: t for t in result.pressure.fit.wanted}
    assert (
        abs(told["valve_centre"].value - drawn[1]["valve_centre"])
        < 4.5 * told["valve_centre"].error
    )
    assert abs(told["dead_band_change"].value) < 4.5 * told["dead_band_change"].error
