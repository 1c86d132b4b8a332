"""`sms sweep`: the plan, runs on cores and on a cluster, resuming, and what it refuses."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from cli_support import sms_started
from sms.io import InputError
from sms.report.sweep import sweep_html
from sms.sweep import load_sweep, run_sweep
from sms.sweep.run import PARTIAL, WHOLE, evaluate
from test_cli_diagnose import refused
from test_cli_diagnose import sms as command
from test_scenario import DAMPED, FLOW_TEST, ROLL

PLAN = """
[sweep]
scenario = "scenario.toml"
samples = 3
seed = 7

[vary.payload_mass]
lower = "200 kg"
upper = "300 kg"

[vary.coulomb_force]
deviation = "10 N"

[vary.supply_pressure]
grid = ["4.5 bar", "5 bar"]
"""


def plan(folder: Path, text: str = PLAN, duration: str = "1 s") -> Path:
    (folder / "scenario.toml").write_text(ROLL.replace('"4 s"', f'"{duration}"') + DAMPED)
    (folder / "sweep.toml").write_text(text)
    return folder / "sweep.toml"


def test_grids_multiply_and_distributions_are_drawn(tmp_path: Path) -> None:
    many = PLAN.replace("samples = 3", "samples = 400")
    found = load_sweep(plan(tmp_path, many))
    assert found.names == ("supply_pressure", "payload_mass", "coulomb_force")
    assert found.values.shape == (800, 3)
    assert set(found.values[:, 0]) == {4.5e5, 5e5}
    payload, friction = found.values[:, 1], found.values[:, 2]
    assert payload.min() > 200.0 and payload.max() < 300.0
    assert friction.mean() == pytest.approx(38.0, abs=0.5)
    assert friction.std() == pytest.approx(10.0, abs=0.5)
    assert friction.min() >= 0.0  # cut off at the parameter's bound
    assert np.array_equal(found.values, load_sweep(plan(tmp_path, many)).values)
    other = load_sweep(plan(tmp_path, many.replace("seed = 7", "seed = 8")))
    assert not np.array_equal(found.values, other.values) and found.digest != other.digest


@pytest.mark.parametrize("kind", ["drawn", "grid"])
def test_distributions_alone_and_grids_alone(tmp_path: Path, kind: str) -> None:
    drawn, grid = PLAN.rindex("[vary.payload_mass]"), PLAN.rindex("[vary.supply_pressure]")
    text = PLAN[:grid] if kind == "drawn" else PLAN[:drawn] + PLAN[grid:]
    found = load_sweep(plan(tmp_path, text))
    assert found.values.shape == ((3, 2) if kind == "drawn" else (2, 1))


def test_a_larger_tank_takes_longer_in_proportion(tmp_path: Path) -> None:
    """Behind an open valve the equations hold time over volume alone; the spool opens as long for all."""
    path = plan(
        tmp_path,
        PLAN[: PLAN.index("samples")] + "[vary.tank_volume]\ngrid = ['1 l', '2 l', '3 l']\n",
    )
    (tmp_path / "scenario.toml").write_text(FLOW_TEST.replace("[0, 1, -1]", "[1]"))
    asked = load_sweep(path)
    results = run_sweep(asked, tmp_path / "out", workers=1)
    arrival = results["arrival [s]"].to_numpy()
    assert abs(arrival[2] - 2.0 * arrival[1] + arrival[0]) <= 2.001e-3  # samples of 1 ms
    assert arrival[1] > 1.9 * arrival[0]
    assert np.ptp(results["greatest_flow [kg/s]"]) < 1e-2 * results["greatest_flow [kg/s]"].max()
    assert (results["ended"] == "").all() and not any("roll" in str(name) for name in results)
    page = sweep_html(asked, results)
    assert "arrival is shown" in page and "tank volume (rank correlation +1.00)" in page


def test_on_two_cores_the_same_as_one_after_the_other(tmp_path: Path) -> None:
    asked = load_sweep(plan(tmp_path))
    results = run_sweep(asked, tmp_path / "out", workers=2)
    for variant in (0, 4):
        alone = evaluate(asked.tables, str(asked.scenario), asked.settings(variant))
        assert results["extension_rms_error [m]"][variant] == alone["extension_rms_error"]
    assert (results["ended"] == "").all()
    written = pd.read_parquet(tmp_path / "out" / WHOLE)
    assert np.array_equal(written["payload_mass [kg]"], asked.values[:, 1])
    assert not (tmp_path / "out" / PARTIAL).exists()


def test_a_stopped_sweep_goes_on_where_it_was(tmp_path: Path) -> None:
    asked = load_sweep(plan(tmp_path))
    whole = run_sweep(asked, tmp_path / "whole", workers=1)
    seen: list[str] = []

    def stop(text: str, share: float) -> None:
        seen.append(text)
        if share > 0.4:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run_sweep(asked, tmp_path / "out", workers=1, progress=stop)
    partial = tmp_path / "out" / PARTIAL
    kept = len(partial.read_text().splitlines()) - 1
    assert 0 < kept < 6 and not (tmp_path / "out" / WHOLE).exists()
    with partial.open("a") as file:
        file.write('{"variant": 5, "en')  # the line that was being written
    again: list[str] = []
    results = run_sweep(
        asked, tmp_path / "out", workers=1, progress=lambda text, _: again.append(text)
    )
    assert len(again) == 6 - kept
    pd.testing.assert_frame_equal(results, whole)


def test_another_sweep_s_leftovers_are_not_used(tmp_path: Path) -> None:
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / PARTIAL).write_text(json.dumps({"sweep": "other"}) + "\n")
    with pytest.raises(InputError, match="left by another sweep"):
        run_sweep(load_sweep(plan(tmp_path)), tmp_path / "out")


def test_a_variant_that_cannot_run_is_a_row_that_says_why(tmp_path: Path) -> None:
    text = PLAN.replace('["4.5 bar", "5 bar"]', '["5 bar"]').replace(
        "[vary.coulomb_force]", '[vary.stroke]\ngrid = ["400 mm", "150 mm"]\n[vary.coulomb_force]'
    )
    results = run_sweep(load_sweep(plan(tmp_path, text)), tmp_path / "out", workers=2)
    assert list(results["ended"] == "") == [True] * 3 + [False] * 3
    assert results["roll_rms_error [rad]"].isna().sum() == 3
    assert "150 mm" in results["ended"].iloc[-1] or "stroke" in results["ended"].iloc[-1]


def test_on_a_dask_cluster_the_same_numbers(tmp_path: Path) -> None:
    distributed = pytest.importorskip("distributed", reason="needs the extra sms[cluster]")
    asked = load_sweep(plan(tmp_path))
    here = run_sweep(asked, tmp_path / "here", workers=1)
    with distributed.LocalCluster(
        n_workers=1, threads_per_worker=1, processes=False, dashboard_address=None
    ) as cluster:
        there = run_sweep(asked, tmp_path / "there", scheduler=cluster.scheduler_address)
    pd.testing.assert_frame_equal(here, there)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("payload_mass", "payload_mas", ("[vary.payload_mas]", "did you mean 'payload_mass'")),
        ("samples", "sample", ("[sweep]: the key 'sample'", "samples, seed, draw")),
        ('upper = "300 kg"', "", ("[vary.payload_mass]", "given are lower")),
        ('"4.5 bar"', '"0 Pa"', ("supply_pressure] grid: 0 Pa", "50000 to 1.2e+06 Pa")),
        ('lower = "200 kg"', 'lower = "400 kg"', ("lower, 400, must be below upper, 300",)),
        ('"10 N"', '"-10 N"', ("coulomb_force] deviation: -10",)),
        ("scenario.toml", "gone.toml", ("there is no such scenario file",)),
    ],
)
def test_bad_plans(tmp_path: Path, old: str, new: str, said: tuple[str, ...]) -> None:
    with pytest.raises(InputError, match="toml") as problem:
        load_sweep(plan(tmp_path, PLAN.replace(old, new)))
    for words in said:
        assert words in str(problem.value)


def test_at_the_prompt(tmp_path: Path) -> None:
    plan(tmp_path, duration="0.5 s")
    swept = sms_started("sweep", "sweep.toml", "--out", "out", "--workers", "1", cwd=tmp_path)
    assert swept.returncode == 0, swept.stderr
    assert "6 variants" in swept.stdout and "depends most on" in swept.stdout
    assert "Spearman" in (tmp_path / "out/sweep.html").read_text(encoding="utf-8")
    nobody = command("sweep", "sweep.toml", "--scheduler", "tcp://127.0.0.1:1", cwd=tmp_path)
    refused(nobody, "--scheduler tcp://127.0.0.1:1", "dask scheduler")
