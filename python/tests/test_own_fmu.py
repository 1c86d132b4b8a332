"""A plant given as an FMU: its functions against the native ones, the verdicts of the tanks, and what is refused."""

from __future__ import annotations

import runpy
import shutil
import tomllib
from functools import cache
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pandas as pd
import pytest
from cli_support import sms
from fmu_plants import PARAMETERS, tanks_fmu
from sms import _core
from sms.diagnosis import own
from sms.diagnosis.own.fmu_calls import Fmu, Names
from sms.diagnosis.own.fmu_file import diagnose_fmu, load_fmu_rig, write_fmu_diagnosis
from sms.diagnosis.own.fmu_plant import Exchange, Slave
from sms.errors import InputError

from validation.random_cases import draw

pytest.importorskip("fmpy")
pytestmark = pytest.mark.skipif(not _core.has_estimation, reason="built without Ceres")
EXAMPLE = Path(__file__).parents[1] / "examples" / "two_tanks.py"
tanks: Any = SimpleNamespace(**runpy.run_path(str(EXAMPLE)))
measured = cache(tanks.measured)
NAMES = Names(
    ["level_upper", "level_lower"],
    ["pump_voltage"],
    ["gauge_upper", "gauge_lower"],
    list(PARAMETERS),
)


def plant(folder: Path, version: int, directional: bool = True) -> Exchange:
    return Exchange(Fmu(tanks_fmu(folder, version, directional)), NAMES, tuple(PARAMETERS))


def rig_file(
    folder: Path,
    case: str,
    fmu: Path,
    interface: str = "",
    records: tuple[int, ...] = (0, 1, 2, 3, 4),
) -> Path:
    """The two tanks' records and their model as an FMU, in words of the native example."""
    model = tanks.MODEL
    lines = [
        "[rig]",
        'kind = "fmu"',
        'title = "Two tanks in a row"',
        "[fmu]",
        f'file = "{fmu.name}"',
        "window = 60.0",
    ]
    lines += [f'interface = "{interface}"'] if interface else []
    lines.append("[states]")
    lines += [
        f'{s.name} = {{ scale = {s.scale}, equation = "{s.equation}" }}' for s in model.states
    ]
    lines += ["[inputs]", 'pump_voltage = { held = true, unit = "V" }', "[outputs]"]
    lines += [
        f'{o.name} = {{ variable = "gauge_{o.name[6:]}", unit = "m", noise = {o.noise} }}'
        for o in model.outputs
    ]
    lines.append("[parameters]")
    lines += [
        f"{p.name} = {{ lower = {p.lower!r}, upper = {p.upper!r}, uncertainty = {p.uncertainty!r} }}"
        for p in model.parameters
    ]
    for e in model.effects:
        lines += [
            "[[effect]]",
            f'id = "{e.id}"',
            f'parameter = "{e.parameter}"',
            f'title = "{e.title}"',
        ]
        lines += [f'cause = "{e.cause}"', f'equation = "{e.equation}"']
        lines += [f"plausible = [{e.plausible[0]!r}, {e.plausible[1]!r}]"] if e.plausible else []
    for record in (measured(case, 1)[k] for k in records):
        file = f"{case}_{record.name.replace(' ', '_')}.csv"
        units = {"time": "s", "pump_voltage": "V", "level_upper": "m", "level_lower": "m"}
        table = {f"{n} [{units[n]}]": v for n, v in record.signals.items()}
        pd.DataFrame(table).to_csv(folder / file, index=False)
        lines += [
            "[[records]]",
            f'file = "{file}"',
            f'role = "{record.role}"',
            f'name = "{record.name}"',
        ]
    path = folder / "rig.toml"
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


# ---- its functions -------------------------------------------------------------------------------


@pytest.mark.parametrize("version", [2, 3])
def test_rates_and_readings_are_those_of_the_native_plant(tmp_path: Path, version: int) -> None:
    random = draw(f"FMU {version}")
    x, u = random.uniform(0.005, 0.1, (2, 30)), random.uniform(0.0, 9.0, (1, 30))
    p = tanks.MODEL.values()
    p["leak_upper"] = random.uniform(0.0, 3e-6, 30)  # an instance for each value
    p["gain_lower"] = np.repeat([0.0, 0.1], 15)
    exchange = plant(tmp_path, version)
    wanted = np.array(tanks.derivative(p, x, u))
    np.testing.assert_allclose(exchange.derivative(p, x, u), wanted, rtol=1e-12)
    np.testing.assert_allclose(
        exchange.output(p, x, u), np.array(tanks.output(p, x, u)), rtol=1e-12
    )


@pytest.mark.parametrize("version", [2, 3])
def test_a_step_and_its_slopes_by_the_state(tmp_path: Path, version: int) -> None:
    random = draw(f"FMU {version}, step")
    n, p = 20, tanks.MODEL.values()
    x, u = random.uniform(0.02, 0.1, (2, n)), random.uniform(0.0, 9.0, (1, n))
    exchange = plant(tmp_path, version)
    numbers, h, none = exchange.numbers(p, n), np.full(n, 0.7), np.zeros((2, n))
    after, slopes = exchange.step_slopes(numbers, x, (u, u + 0.1), h, by_parameters=False)
    np.testing.assert_allclose(exchange.advance(numbers, x, (u, u + 0.1), (none, none), h), after)
    for state in range(2):
        step = 1e-6 * np.eye(2)[:, [state]]
        up, down = (
            exchange.advance(numbers, x + s, (u, u + 0.1), (none, none), h) for s in (step, -step)
        )
        np.testing.assert_allclose(slopes[:, :, state].T, (up - down) / 2e-6, atol=1e-7)
    _, by_state = exchange.output_slopes(numbers, x, u, by_parameters=False)
    np.testing.assert_allclose(by_state, np.tile(np.eye(2), (n, 1, 1)))
    slave = Slave(Fmu(tanks_fmu(tmp_path, version), "co_simulation"), NAMES, tuple(PARAMETERS))
    mean = u + 0.05
    np.testing.assert_allclose(
        slave.advance(numbers, x, (u, u + 0.1), (none, none), h),
        exchange.advance(numbers, x, (mean, mean), (none, none), h),
        atol=2e-6,
    )
    np.testing.assert_allclose(slave.derivative(p, x, u), exchange.derivative(p, x, u), atol=1e-6)


def test_what_the_fmu_does_not_answer_is_no_number(tmp_path: Path) -> None:
    exchange, p = plant(tmp_path, 2), tanks.MODEL.values()
    u = np.array([[1.0, np.nan, 2.0]])
    found = exchange.derivative(p, np.full((2, 3), 0.05), u)
    assert np.isfinite(found[:, [0, 2]]).all() and np.isnan(found[:, 1]).all()
    p["pump_gain"] = np.array([3e-6, np.inf, 3e-6])  # refused when it is initialised
    found = exchange.derivative(p, np.full((2, 3), 0.05), np.ones((1, 3)))
    assert np.isfinite(found[:, [0, 2]]).all() and np.isnan(found[:, 1]).all()


# ---- the diagnosis -------------------------------------------------------------------------------


def same_answer(found: own.Answer, case: str) -> None:
    """Verdict and causes of the native plant, sizes within a standard error."""
    native = tanks.diagnose(case)
    assert found.verdict == native.verdict
    assert [c.members for c in found.causes] == [c.members for c in native.causes]
    for one, other in zip(found.causes, native.causes, strict=True):
        for p, q in zip(one.parameters, other.parameters, strict=True):
            assert abs(p.value - q.value) < q.standard_error, p.name


def test_the_leak_of_the_tanks_is_found_at_the_command_line(tmp_path: Path) -> None:
    fmu = tanks_fmu(tmp_path, 3)
    rig = rig_file(tmp_path, "leak", fmu, records=(0, 2))  # one of each role is enough of a leak
    text = rig.read_text(encoding="utf-8")  # and so are steps of a sample
    rig.write_text(text.replace("window = 60.0", "window = 60.0\nlongest_step = 1.0"), "utf-8")
    done = sms("diagnose", rig.name, "--out", "report", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "leak of the upper tank" in done.stdout
    extended = tomllib.loads((tmp_path / "report" / "extended.toml").read_text(encoding="utf-8"))
    assert extended["parameters"]["leak_upper"]["value"] == pytest.approx(tanks.LEAK, rel=0.1)
    assert load_fmu_rig(tmp_path / "report" / "extended.toml").model.parameter(
        "leak_upper"
    ).value == pytest.approx(tanks.LEAK, rel=0.1)


@pytest.mark.full
def test_the_extended_rig_file_leaves_nothing(tmp_path: Path) -> None:
    rig = rig_file(tmp_path, "leak", tanks_fmu(tmp_path, 3))
    found = diagnose_fmu(rig)
    extended = write_fmu_diagnosis(found, rig, tmp_path / "report")[2]
    again = diagnose_fmu(extended)
    assert again.verdict == "no-evidence"


@pytest.mark.full
@pytest.mark.parametrize("case", tanks.CASES)
@pytest.mark.parametrize(("version", "directional"), [(2, True), (2, False), (3, True)])
def test_model_exchange_gives_the_verdicts_of_the_native_plant(
    tmp_path: Path, case: str, version: int, directional: bool
) -> None:
    rig = rig_file(tmp_path, case, tanks_fmu(tmp_path, version, directional), "model_exchange")
    same_answer(diagnose_fmu(rig), case)


@pytest.mark.full
@pytest.mark.parametrize("case", ["healthy", "leak"])
@pytest.mark.parametrize("version", [2, 3])
def test_co_simulation_gives_the_verdicts_of_the_native_plant(
    tmp_path: Path, case: str, version: int
) -> None:
    rig = rig_file(tmp_path, case, tanks_fmu(tmp_path, version), "co_simulation")
    same_answer(diagnose_fmu(rig), case)


# ---- what is refused -----------------------------------------------------------------------------


@pytest.mark.parametrize("version", [2, 3])
def test_steps_of_its_own_that_are_longer_than_a_sample_are_said(
    tmp_path: Path, version: int
) -> None:
    fmu = Fmu(tanks_fmu(tmp_path, version, internal=0.5), "co_simulation")
    x, u, none = np.full((2, 1), 0.05), np.ones((1, 1)), np.zeros((2, 1))
    slave = Slave(fmu, NAMES, tuple(PARAMETERS))
    numbers = slave.numbers(tanks.MODEL.values(), 1)
    assert np.all(slave.advance(numbers, x, (u, u), (none, none), np.full(1, 0.5)) != x)
    slave = Slave(fmu, NAMES, tuple(PARAMETERS))
    with pytest.raises(InputError, match=r"moves in steps of 0\.5 s, and the samples are 0\.1 s"):
        slave.advance(numbers, x, (u, u), (none, none), np.full(1, 0.1))


@pytest.mark.parametrize("version", [2, 3])
def test_an_fmu_with_events_is_refused(tmp_path: Path, version: int) -> None:
    with pytest.raises(InputError, match="has events, at which its states may jump"):
        Fmu(tanks_fmu(tmp_path, version, events=1))


@pytest.mark.parametrize("version", [2, 3])
@pytest.mark.parametrize(
    ("made", "said"),
    [
        ({"rain": 1e-6}, "tanks follows time itself"),
        ({"planned": 30.0}, "tanks has an event at 30 s"),
    ],
)
def test_an_fmu_that_follows_time_itself_is_refused(
    tmp_path: Path, version: int, made: dict[str, float], said: str
) -> None:
    """Its rates were taken at 0 s wherever a window began."""
    fmu = tanks_fmu(tmp_path, version, rain=made.get("rain", 0.0), planned=made.get("planned", 0.0))
    rig = rig_file(tmp_path, "healthy", fmu, "model_exchange")
    with pytest.raises(InputError, match=said) as refused:
        load_fmu_rig(rig)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('variable = "gauge_upper"', 'variable = "gauge_uper"', "did you mean 'gauge_upper'"),
        (
            "level_lower = { scale",
            "level_x = { variable = 'rate_lower', scale",
            "continuous states are",
        ),
        ("lower = 1e-06, ", "", "says no bound of 'pump_gain'; write lower"),
        ("window = 60.0", "window = 0.0", "[fmu] window"),
        ("[[effect]]", "[[efect]]", "effect"),
        ('parameter = "leak_upper"', 'parameter = "leak_uper"', "did you mean 'leak_upper'"),
        ('interface = "model_exchange"', 'interface = "both"', "'both' is not known"),
        (
            ', unit = "V"',
            "",
            "the unit 'V' does not fit; no unit (a plain number) is expected here, or declare a unit",
        ),
    ],
)
def test_a_rig_file_that_does_not_fit_is_said(
    tmp_path: Path, old: str, new: str, said: str
) -> None:
    rig = rig_file(tmp_path, "healthy", tanks_fmu(tmp_path, 2), "model_exchange")
    text = rig.read_text(encoding="utf-8")
    assert old in text
    rig.write_text(text.replace(old, new), encoding="utf-8")
    with pytest.raises(InputError) as refused:
        load_fmu_rig(rig)
    assert said in str(refused.value)
    assert "\n" not in str(refused.value)


def test_files_that_are_no_fmu_are_said(tmp_path: Path) -> None:
    (tmp_path / "x.fmu").write_bytes(b"PK no zip")
    with pytest.raises(InputError, match="not a readable FMU"):
        Fmu(tmp_path / "x.fmu")
    elsewhere = tanks_fmu(tmp_path, 2)
    shutil.copy(elsewhere, tmp_path / "y.fmu")
    import zipfile  # noqa: PLC0415

    with zipfile.ZipFile(tmp_path / "y.fmu") as archive:
        description = archive.read("modelDescription.xml")
    with zipfile.ZipFile(tmp_path / "z.fmu", "w") as archive:
        archive.writestr("modelDescription.xml", description)
        archive.writestr("binaries/win64/tanks.dll", b"")
    with pytest.raises(InputError, match=r"no binary for linux64 in it \(win64\)"):
        Fmu(tmp_path / "z.fmu")
