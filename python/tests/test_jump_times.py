"""When a command jumped, which a slow logger does not tell: from the readings."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from plant_support import NOISE, RIG
from sms import Params, simulate_bench
from sms.arrays import Array, Index
from sms.diagnosis.preparation import make_data
from sms.estimation.jump_times import with_jump_times
from sms.estimation.problem import is_commanded
from sms.estimation.windows import Runs
from sms.io import load_rig, write_record
from sms.io.records import load_record

from validation.random_cases import draw

EVERY = 10
"""Control periods of 1 ms in a sample."""


def steps_of(random: np.random.Generator) -> tuple[Index, Array]:
    """When the set-point of 4 s steps, in whole milliseconds, once in each window, 3 to 9 ms ahead of the sample that
    shows it, and the set-point at each."""
    at = 500 + 1000 * np.arange(4) + EVERY * random.integers(0, 10, 4) + random.integers(1, 8, 4)
    levels = 0.2 + np.cumsum(np.append(0.0, random.uniform(0.03, 0.06, 4) * (-1.0) ** np.arange(4)))
    return at, np.repeat(levels, np.diff(np.concatenate([[0], at, [4000]])))


def logged_slowly(folder: Path, wanted: Array, machine: Params, hold: str = "") -> Runs:
    """The record of a loop that follows the set-point, to be identified with."""
    random = np.random.default_rng(1)
    run = simulate_bench(wanted, controller="pid", params=machine, tolerance=1e-6)
    time = 1e-3 * np.arange(len(wanted))
    signals = {"time": time[::EVERY], "valve_command": run["valve_command"][::EVERY]}
    for name, size in NOISE.items():
        clean = run.reading(name)[::EVERY]
        signals[name] = clean + random.normal(0.0, size, clean.size)
    roles = ("identify", "validate")
    for role in roles:
        write_record(folder / f"{role}.csv", signals)
    text = RIG.replace('"valve_command"\n', '{ column = "valve_command"' + hold + " }\n")
    text += "".join(f'\n[[records]]\nfile = "{r}.csv"\nrole = "{r}"\n' for r in roles)
    (folder / "rig.toml").write_text(text)
    rig = load_rig(folder / "rig.toml")
    return make_data(rig, [load_record(rig, source) for source in rig.records]).identify


def test_the_times_of_jumps_are_found_from_the_readings(tmp_path: Path) -> None:
    at, wanted = steps_of(draw("jumps between samples"))
    machine = Params(proportional_gain=8.0)
    runs = logged_slowly(tmp_path, wanted, machine)
    (run,) = runs.motions
    assert run.hold == "stepped"
    assert run.jump_deviation == pytest.approx(0.01 / 12.0**0.5)
    timed = with_jump_times(runs, machine)
    (found,) = timed.motions
    shown = -(-at // EVERY)
    assert found.ahead is not None
    assert found.ahead.shape == (len(run.time), 1)
    assert np.all((found.ahead >= 0.0) & (found.ahead <= run.step))
    assert found.ahead[shown, 0] == pytest.approx(1e-3 * (EVERY * shown - at), abs=1e-3)
    before, after = (float(np.mean(r.problem.errors(machine) ** 2)) for r in (runs, timed))
    assert before > 1.5
    assert after < 1.0 + 0.3 * (before - 1.0)
    half = found.part(slice(200, None))
    assert half.ahead is not None
    assert np.array_equal(half.ahead, found.ahead[200:])


def test_jumps_that_are_known_stay_where_they_are(tmp_path: Path) -> None:
    _, wanted = steps_of(draw("jumps that are known"))
    runs = logged_slowly(tmp_path, wanted, Params(proportional_gain=8.0), ', hold = "previous"')
    assert with_jump_times(runs, Params()) is runs


def test_what_cannot_be_is_refused(tmp_path: Path) -> None:
    _, wanted = steps_of(draw("jumps refused"))
    runs = logged_slowly(tmp_path, wanted, Params(proportional_gain=8.0))
    samples = len(runs.motions[0].time)
    problem = runs.simulation
    assert is_commanded(problem)
    with pytest.raises(IndexError, match="no command 1 of a record 0"):
        problem.set_ahead(0, 1, np.zeros(samples))
    with pytest.raises(ValueError, match="ahead has 3 values; the record has 400 samples"):
        problem.set_ahead(0, 0, np.zeros(3))
    for wrong in (-1e-6, 0.011, np.nan):
        with pytest.raises(ValueError, match=r"from 0 to 0\.01"):
            problem.set_ahead(0, 0, np.full(samples, wrong))
