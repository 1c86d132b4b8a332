"""The noise of a reading where none is declared, and records that have none: another program's simulation."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from sms.diagnosis.design.detection_limits import published_rig
from sms.diagnosis.pipeline import diagnose, read_and_check
from sms.diagnosis.preparation import make_data
from sms.estimation.noise import noise_of, rounding_step, sample_noise
from sms.estimation.run import Run
from sms.io.rig import load_rig
from sms.io.write import write_record
from sms.rigs.bench import BENCH, OUTPUTS
from sms.rigs.kinds import kind_of

LEAK = 2e-9  # kg/(s Pa)


def test_white_noise_on_a_smooth_motion() -> None:
    rng = np.random.default_rng(5)
    time = np.arange(4000) / 200.0
    values = 0.2 + 0.1 * np.sin(2.0 * time) + rng.normal(0.0, 1e-4, time.size)
    assert sample_noise(values) == pytest.approx(1e-4, rel=0.1)
    assert rounding_step(values) == 0.0


@pytest.mark.parametrize("step", [1e-4, 250.0])
def test_a_signal_that_rests_between_the_steps_of_its_converter_has_the_error_of_rounding(
    step: float,
) -> None:
    values = step * np.round(3.0 * np.sin(np.arange(2000) / 300.0))
    assert np.median(np.abs(np.diff(values, 3))) == 0.0
    assert sample_noise(values) == pytest.approx(step / np.sqrt(12.0))


def test_a_clean_ramp_is_not_rounded_and_a_constant_has_no_step() -> None:
    assert sample_noise(0.01 * np.arange(500.0)) < 1e-12
    assert sample_noise(np.full(500, 4.86e5)) == 0.0
    assert rounding_step(0.1 + np.array([0.0, 1e-17, 0.0, 3e-17] * 20)) == 0.0


def clean_records(folder: Path) -> Path:
    """A bench without any noise, as another simulator would export it; nothing is declared."""
    rig = published_rig("bench")
    machine = rig.start()
    machine["chamber_leakage_lower"] = LEAK
    text = '[rig]\nkind = "bench"\n[signals]\ntime = "time"\nvalve_command = "valve_command"\n'
    text += "".join(f'{signal} = "{signal}"\n' for signal in OUTPUTS)
    for number, role in enumerate(("identify", "identify", "validate", "validate")):
        run = BENCH.menu[number].simulated(rig, machine, OUTPUTS)
        assert run is not None
        signals = {s: run.signals[s] for s in ("valve_command", *OUTPUTS)}
        write_record(folder / f"{number}.csv", {"time": run.time} | signals)
        text += f'\n[[records]]\nfile = "{number}.csv"\nrole = "{role}"\n'
    (folder / "rig.toml").write_text(text)
    return folder / "rig.toml"


def test_noise_of_clean_records_is_what_a_fine_converter_would_leave(tmp_path: Path) -> None:
    rig = load_rig(clean_records(tmp_path))
    runs = make_data(rig, read_and_check(rig)[0]).identify
    assert all(noise > 0.0 for noise in runs.noise.values())
    assert 0.1 < runs.noise["chamber_pressure_lower"] < 10.0  # Pa
    assert 1e-8 < runs.noise["extension"] < 1e-5  # m
    rows = np.zeros(len(runs.channel))
    assert runs.floor(rows).tolist() == [1.0] * len(OUTPUTS)


@pytest.mark.parametrize("kind", ["bench", "platform", "tank"])
def test_every_output_of_a_rig_has_a_noise_although_none_is_declared_and_it_rests(
    kind: str,
) -> None:
    """A leg's signals are named with its number."""
    rig = published_rig(kind)
    rig = replace(rig, signals={n: replace(s, noise=None) for n, s in rig.signals.items()})
    outputs = kind_of(rig).outputs
    at_rest = Run(
        "at rest",
        "identify",
        np.arange(99) / 200,
        dict.fromkeys(outputs, np.ones(99)),
        frozenset(),
        {},
    )
    assert all(0.0 < noise < 1e4 for noise in noise_of(rig, kind_of(rig), [at_rest]).values())


@pytest.mark.full
@pytest.mark.filterwarnings("error::RuntimeWarning")
def test_a_leak_in_clean_records_is_found(tmp_path: Path) -> None:
    answer = diagnose(clean_records(tmp_path))
    (cause,) = answer.causes
    assert (cause.effect, cause.signal) == ("fitting_leakage", "lower")
    leak, _ = cause.parameters
    # Its law is unknown, and these motions hardly tell it.
    assert abs(leak.value - LEAK) < 2.0 * leak.standard_error < 0.6 * LEAK
