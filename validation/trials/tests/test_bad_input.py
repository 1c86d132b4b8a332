"""Bad input of issue 6, on virtual machines: a data fault or a named finding, never a confident wrong cause."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest
from sms.diagnosis import Diagnosis, diagnose

from validation.trials import bad_input as bad

SEED = 7


Healthy = Callable[[str, Path], Path]


@pytest.fixture(scope="module")
def healthy(tmp_path_factory: pytest.TempPathFactory) -> Healthy:
    """(kind, folder) -> the folder with records of a machine with nothing wrong; each kind is drawn once."""
    drawn: dict[str, Path] = {}

    def of(kind: str, folder: Path) -> Path:
        if kind not in drawn:
            drawn[kind] = bad.healthy(kind, SEED, tmp_path_factory.mktemp("drawn") / kind)
        return Path(shutil.copytree(drawn[kind], folder))

    return of


def answer(folder: Path) -> Diagnosis:
    return diagnose(folder / "rig.toml")


def errors(found: Diagnosis) -> str:
    return "; ".join(f.message for f in found.findings if f.severity == "error")


@pytest.mark.parametrize(
    ("kind", "signal"),
    [
        ("tank", "tank_pressure"),
        ("bench", "chamber_pressure_upper"),
        ("bench", "extension"),
        pytest.param("platform", "chamber_pressure_lower_2", marks=pytest.mark.full),
    ],
)
@pytest.mark.parametrize("noise", [0.0, 1.0])
def test_a_dead_channel_is_a_data_fault(
    healthy: Healthy, tmp_path: Path, kind: str, signal: str, noise: float
) -> None:
    folder = healthy(kind, tmp_path / "run")
    bad.dead(folder, signal, noise * (1e-4 if signal.startswith("extension") else 250.0))
    found = answer(folder)
    assert (found.verdict, found.causes) == ("data-fault", ())
    assert any(f.signal == signal for f in found.findings if f.severity == "error")


@pytest.mark.parametrize(
    ("kind", "signal"),
    [("tank", "tank_pressure"), ("bench", "chamber_pressure_upper"), ("bench", "extension")],
)
def test_saturation_through_half_the_run_is_said_and_names_no_cause(
    healthy: Healthy, tmp_path: Path, kind: str, signal: str
) -> None:
    """What is clipped is compared with nothing; where too little is left it is a data fault."""
    folder = healthy(kind, tmp_path / "run")
    bad.saturated(folder, signal)
    found = answer(folder)
    assert found.causes == ()
    assert found.verdict in ("data-fault", "no-evidence")
    said = [f.message for f in found.findings if f.signal == signal]
    assert any("the end of its range" in text or "holds one value" in text for text in said)


@pytest.mark.parametrize(
    ("kind", "effect", "multiple"),
    [
        ("tank", "supply_setpoint", 60.0),
        pytest.param("bench", "supply_setpoint", 12.0, marks=pytest.mark.full),
    ],
)
@pytest.mark.parametrize("record", [0, pytest.param(3, marks=pytest.mark.full)])
def test_a_record_of_another_machine_is_said_to_contradict_the_rest(
    healthy: Healthy, tmp_path: Path, kind: str, effect: str, multiple: float, record: int
) -> None:
    folder = healthy(kind, tmp_path / "run")
    bad.contradict(kind, SEED, folder, effect, record, multiple)
    found = answer(folder)
    assert (found.verdict, found.causes) == ("data-fault", ())
    assert "records are inconsistent" in errors(found)
    assert bad.records(folder)[record].stem in errors(found)


@pytest.mark.full
@pytest.mark.parametrize(("kind", "signal"), [("tank", "tank_pressure"), ("bench", "extension")])
def test_a_late_clock_is_a_cause(healthy: Healthy, tmp_path: Path, kind: str, signal: str) -> None:
    folder = healthy(kind, tmp_path / "same")
    bad.late_clock(folder, signal, [0.12] * 4)
    found = answer(folder)
    assert found.verdict in ("cause", "class")
    named = {c.effect for c in found.causes} | {m for c in found.causes for m in c.members}
    assert named & {"clock_skew", "command_delay"}
    assert found.causes[0].parameters[0].value == pytest.approx(0.12, abs=0.01)


@pytest.mark.parametrize(
    ("kind", "signal"),
    [("tank", "tank_pressure"), pytest.param("bench", "extension", marks=pytest.mark.full)],
)
def test_a_clock_that_is_late_otherwise_in_each_record_is_a_fault_of_the_records(
    healthy: Healthy, tmp_path: Path, kind: str, signal: str
) -> None:
    folder = healthy(kind, tmp_path / "each")
    bad.late_clock(folder, signal, [0.12, -0.06, 0.03, -0.10])
    found = answer(folder)
    assert (found.verdict, found.causes) == ("data-fault", ())
    assert "records are inconsistent" in errors(found)


@pytest.mark.parametrize(
    ("kind", "parameter", "effect"),
    [
        ("tank", "tank_volume", "dead_volume"),
        pytest.param("bench", "moving_mass", "moving_mass", marks=pytest.mark.full),
    ],
)
@pytest.mark.parametrize("factor", [10.0, pytest.param(0.1, marks=pytest.mark.full)])
def test_a_rig_file_that_is_wrong_by_ten_is_named_with_the_right_value(
    healthy: Healthy, tmp_path: Path, kind: str, parameter: str, effect: str, factor: float
) -> None:
    folder = healthy(kind, tmp_path / "run")
    meant: dict[str, float] = {"tank_volume": 5e-3, "moving_mass": 3.639}
    bad.declare(folder, parameter, factor)
    found = answer(folder)
    assert found.verdict in ("cause", "class")
    assert len(found.causes) == 1
    cause = found.causes[0]
    members = {cause.effect: cause.parameters[0].value} | {
        m.effect: m.parameters[0].value for m in cause.alternatives
    }
    assert members[effect] == pytest.approx(meant[parameter], rel=0.1)


@pytest.mark.full
@pytest.mark.parametrize("leg", [1, 2])
def test_a_leg_of_a_platform_described_as_a_bench_is_given_no_cause_of_a_sensor(
    tmp_path: Path, leg: int
) -> None:
    """What carries a platform is not a bench: its weight once was a zero error of 1.4 bar."""
    found = answer(bad.leg_as_bench(SEED, leg, tmp_path / "run"))
    assert found.verdict in ("unknown", "data-fault"), found.sentence
    assert found.causes == ()
