"""Signals that the rig file declares wrongly are said with the line to write, and never end in a physical cause."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from plant_support import write_bench, write_platform
from sms.diagnosis.adequacy.misdeclared_signals import (
    misdeclared_signals,
    of_another_machine,
)
from sms.diagnosis.effects.catalogue import effects_of
from sms.diagnosis.hypothesis import Data, baseline_hypothesis
from sms.diagnosis.pipeline import read_and_check
from sms.diagnosis.preparation import make_data
from sms.diagnosis.result import Finding
from sms.io import load_rig
from sms.io.records import Record

Signals = dict[str, NDArray[np.float64]]
AMBIENT = 86e3  # Pa, as write_bench has it
LOWER, UPPER = "chamber_pressure_lower", "chamber_pressure_upper"


@pytest.fixture(scope="module")
def healthy(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_bench(tmp_path_factory.mktemp("healthy"), 1, {})


@pytest.fixture(scope="module")
def leaking(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Several times what can be found: the declared model is wrong by many times the noise of every reading."""
    return write_bench(tmp_path_factory.mktemp("leaking"), 2, {"chamber_leakage_lower": 5e-10})


def found(path: Path, slip: Callable[[Signals], Signals] = dict) -> tuple[Finding, ...]:
    rig = load_rig(path)
    records, _ = read_and_check(rig)

    def slipped(record: Record) -> Record:
        return replace(record, signals=dict(record.signals) | slip(dict(record.signals)))

    data: Data = make_data(rig, [slipped(r) for r in records])
    return misdeclared_signals(data, baseline_hypothesis(data, effects_of(rig)).start)


def test_a_right_declaration_is_left_alone(healthy: Path, leaking: Path) -> None:
    assert found(healthy) == ()
    assert found(leaking) == ()


@pytest.mark.parametrize(
    ("slip", "signal", "line"),
    [
        (lambda x: {LOWER: x[LOWER] - AMBIENT, UPPER: x[UPPER] - AMBIENT}, LOWER,
         f"write gauge = true in [signals] {LOWER}, and so of every other chamber pressure"),
        (lambda x: {UPPER: x[UPPER] - AMBIENT}, UPPER, f"write gauge = true in [signals] {UPPER}"),
        (lambda x: {LOWER: x[UPPER], UPPER: x[LOWER]}, LOWER, "exchange the columns"),
        (lambda x: {"extension": 0.4 - x["extension"]}, "extension",
         'write scale = -1, offset = "0.4 m" in [signals] extension'),
        (lambda x: {"extension": -x["extension"]}, "extension", "write scale = -1"),
        (lambda x: {"valve_command": 10.0 - x["valve_command"]}, "valve_command",
         'write scale = -1, offset = "10 V" in [signals] valve_command'),
        (lambda x: {"time": 1.07 * x["time"]}, "time", "write scale = 0.934579 in [signals] time"),
    ],
)  # fmt: skip
@pytest.mark.parametrize("machine", [pytest.param("healthy", marks=pytest.mark.full), "leaking"])
def test_a_slip_is_said_with_the_line_to_write(
    slip: Callable[[Signals], Signals],
    signal: str,
    line: str,
    machine: str,
    request: pytest.FixtureRequest,
) -> None:
    """Beside a cause that is as large as the records can hold, too."""
    (finding,) = found(request.getfixturevalue(machine), slip)
    assert (finding.severity, finding.signal) == ("error", signal), finding
    assert line in finding.remedy


def test_a_valve_that_is_nearly_clogged_turns_no_sign(tmp_path: Path) -> None:
    """Its piston moves far less than the model, and the same way."""
    assert found(write_bench(tmp_path, 3, {"mass_flow_gain": 0.25})) == ()


@pytest.mark.parametrize("signal", ["extension_2", "valve_command_3"])
def test_the_sign_of_one_leg_is_said(signal: str, tmp_path: Path) -> None:
    turned = {"extension_2": 0.4, "valve_command_3": 10.0}[signal]
    rig = write_platform(tmp_path, 4, {}, 2.2)
    (finding,) = found(rig, lambda x: {signal: turned - x[signal]})
    assert finding.signal == signal
    assert "write scale = -1" in finding.remedy


def test_a_loop_whose_pressures_are_gauge_is_said_too(tmp_path: Path) -> None:
    path = write_bench(tmp_path, 3, {}, in_loop=True)
    (finding,) = found(path, lambda x: {LOWER: x[LOWER] - AMBIENT, UPPER: x[UPPER] - AMBIENT})
    assert "gauge = true" in finding.remedy


@pytest.mark.parametrize(("bore", "warned"), [("100 mm", False), ("63 mm", True)])
def test_the_rig_file_of_another_machine_is_said(healthy: Path, bore: str, warned: bool) -> None:
    text = healthy.read_text().replace(
        "[parameters]\n", f'[parameters]\nbore_diameter = "{bore}"\n'
    )
    path = healthy.with_name(f"{bore}.toml")
    path.write_text(text)
    rig = load_rig(path)
    data = make_data(rig, read_and_check(rig)[0])
    findings = of_another_machine(data, baseline_hypothesis(data, effects_of(rig)).start)
    assert [f.severity for f in findings] == ["warning"] * warned
    assert all("bore_diameter" in f.remedy for f in findings)
