"""Records of a bench actuator and of a platform made with the core itself: for tests of the method, not of its truth.

(Trials with an independent simulator are under validation/twins.)
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from sms import Params, _core, extensions_of, simulate_bench, simulate_platform
from sms.diagnosis.effects.catalogue import effects_of
from sms.diagnosis.fitting import fit
from sms.diagnosis.hypothesis import Data, Fitted, baseline_hypothesis
from sms.diagnosis.preparation import make_data
from sms.io import load_rig, write_record
from sms.io.records import load_record

Array = NDArray[np.float64]

LEAK = 1e-8
"""kg/(s Pa), past the piston of the bench whose diagnosis several tests read (conftest.py)."""
NOISE = {"extension": 7e-5, "chamber_pressure_lower": 300.0, "chamber_pressure_upper": 300.0}
LENGTH = 4.0
EVERY = 10
"""Control periods of 1 ms in a sample."""

RIG = """
[rig]
kind = "bench"
title = "A bench"

[signals]
time = "time"
valve_command = "valve_command"
extension = { noise = "0.07 mm" }
chamber_pressure_lower = { noise = "300 Pa" }
chamber_pressure_upper = { noise = "300 Pa" }

[parameters]
mass_flow_gain = { value = 1.5, uncertainty = 0.1 }
valve_centre = { value = "5 V", uncertainty = "0.02 V" }
sensor_offset_chamber_pressure_lower = { value = "0 Pa", uncertainty = "0 Pa" }
sensor_offset_chamber_pressure_upper = { value = "0 Pa", uncertainty = "0 Pa" }
sensor_gain_chamber_pressure_lower = { value = 0.0, uncertainty = 0.0 }
sensor_gain_chamber_pressure_upper = { value = 0.0, uncertainty = 0.0 }
"""


def setpoint(kind: int, time: Array) -> Array:
    """Extension, m: two kinds of motion for each role."""
    waves = (
        0.06 * np.sin(3.3 * time) + 0.03 * np.sin(9.1 * time),
        0.08 * np.sign(np.sin(1.7 * time)) * np.minimum(1.0, np.abs(3.0 * np.sin(1.7 * time))),
        0.07 * np.sin(2.1 * time + 1.0) + 0.02 * np.sin(12.0 * time),
        0.05 * np.sin(4.4 * time) * np.cos(0.7 * time),
    )
    return np.asarray(0.2 + waves[kind] - waves[kind][0])


IN_LOOP = """
[control]
loop = "closed"
controller = "simulated"

[parameters]
proportional_gain = "8 V/m"
"""


def write_bench(
    folder: Path,
    seed: int,
    truth: Mapping[str, float],
    *,
    in_loop: bool = False,
    command: bool = True,
    supply: bool = False,
) -> Path:
    """Two records to identify with and two to validate with, of a machine with these parameters.

    in_loop: the rig file asks for a simulated controller; command: whether its output is recorded; supply:
    whether there is a sensor of the supply's pressure.
    """
    random = np.random.default_rng(seed)
    noise = NOISE | ({"supply_pressure": 300.0} if supply else {})
    machine = Params(**({"proportional_gain": 8.0} | dict(truth)))
    text = RIG
    if supply:
        text = text.replace(
            "\n[parameters]\n", 'supply_pressure = { noise = "300 Pa" }\n\n[parameters]\n'
        )
    if in_loop:
        text = text.replace("\n[parameters]\n", 'setpoint = "setpoint"\n' + IN_LOOP)
    if not command:
        text = text.replace('valve_command = "valve_command"\n', "")
    for number, role in enumerate(("identify", "identify", "validate", "validate")):
        time = 1e-3 * np.arange(0.0, LENGTH / 1e-3)
        wanted = setpoint(number, time)
        run = simulate_bench(wanted, controller="pid", params=machine, tolerance=1e-6)
        signals = {"time": time[::EVERY], "valve_command": run["valve_command"][::EVERY]}
        if in_loop:
            signals["setpoint"] = wanted[::EVERY]
        for name, size in noise.items():
            clean = run.reading(name)[::EVERY]
            signals[name] = clean + random.normal(0.0, size, clean.size)
        write_record(folder / f"run{number}.csv", signals)
        text += f'\n[[records]]\nfile = "run{number}.csv"\nrole = "{role}"\n'
    (folder / "rig.toml").write_text(text)
    return folder / "rig.toml"


def with_known_map(path: Path) -> Path:
    """The rig file, its valve's map measured to 3 % at every opening."""
    text = path.read_text(encoding="utf-8")
    path.write_text(text + '\n[model]\nflow_map_uncertainty = "3 %"\n', encoding="utf-8")
    return path


def fitted_baseline(path: Path) -> tuple[Fitted, Data]:
    """What may move in the model of a rig file before any cause, fitted, and the records by role."""
    rig = load_rig(path)
    data = make_data(rig, [load_record(rig, source) for source in rig.records])
    return fit(baseline_hypothesis(data, effects_of(rig)), data.identify), data


# ---- platform ------------------------------------------------------------------------------------

PLATFORM_NOISE = {
    "extension": (7e-5, "0.07 mm"),
    "chamber_pressure_lower": (300.0, "300 Pa"),
    "chamber_pressure_upper": (300.0, "300 Pa"),
}
ATTITUDE = ("roll", "pitch")
PLATFORM_RIG = """
[rig]
kind = "platform"
title = "A platform"

[signals]
time = "time"
"""


def pose(kind: int, time: Array) -> Array:
    """Roll, pitch, rad, and height, m, (n, 3): a motion for each role."""
    waves = (
        (0.03 * np.sin(2.9 * time), 0.02 * np.sin(5.3 * time), 0.03 * np.sin(4.1 * time)),
        (0.02 * np.sin(6.1 * time), 0.03 * np.sin(3.7 * time), 0.03 * np.sin(2.3 * time)),
    )
    return np.column_stack(waves[kind]) + np.array([0.0, 0.0, 0.5])


def write_platform(
    folder: Path,
    seed: int,
    truth: Mapping[str, float],
    length: float,
    *,
    in_loop: bool = False,
    command: bool = True,
    attitude: bool = False,
) -> Path:
    """A record to identify with and one to validate with; truth: "name" of all legs, "name:2" of leg 2.

    in_loop: the rig file asks for simulated controllers; command: whether their outputs are recorded; attitude: whether
    an inclinometer is.
    """
    random = np.random.default_rng(seed)
    machine = _core.LegParams(Params(proportional_gain=8.0))
    for name, value in truth.items():
        machine[name] = value
    text = PLATFORM_RIG
    for signal in ("valve_command", *PLATFORM_NOISE):
        source = (
            f'{{ noise = "{PLATFORM_NOISE[signal][1]}" }}' if signal in PLATFORM_NOISE else "{}"
        )
        if command or signal != "valve_command":
            text += "".join(f"{signal}_{leg} = {source}\n" for leg in (1, 2, 3))
    if attitude:
        text += "".join(f'{name} = {{ noise = "0.15 mrad" }}\n' for name in ATTITUDE)
    if in_loop:
        text += "".join(f"setpoint_{leg} = {{}}\n" for leg in (1, 2, 3)) + IN_LOOP
    for number, role in enumerate(("identify", "validate")):
        time = 1e-3 * np.arange(0.0, length / 1e-3)
        wanted = pose(number, time)
        setpoints = extensions_of(*wanted.T)
        run = simulate_platform(setpoints, controller="pid", pose=wanted[0], params=machine.legs)
        signals = {"time": time[::EVERY]}
        for leg in (1, 2, 3):
            signals[f"valve_command_{leg}"] = run[f"valve_command_{leg}"][::EVERY]
            if in_loop:
                signals[f"setpoint_{leg}"] = setpoints[::EVERY, leg - 1]
            for name, (size, _) in PLATFORM_NOISE.items():
                clean = run.reading(f"{name}_{leg}")[::EVERY]
                signals[f"{name}_{leg}"] = clean + random.normal(0.0, size, clean.size)
        for name in ATTITUDE if attitude else ():
            clean = run.reading(name)[::EVERY]
            signals[name] = clean + random.normal(0.0, 1.5e-4, clean.size)
        write_record(folder / f"run{number}.csv", signals)
        text += f'\n[[records]]\nfile = "run{number}.csv"\nrole = "{role}"\n'
    (folder / "rig.toml").write_text(text)
    return folder / "rig.toml"
