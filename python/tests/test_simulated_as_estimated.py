"""Every effect of the catalogue is the same effect in simulation and in estimation.

A machine with the effect is simulated through the public functions, and what its sensors say is its record, without
noise. The estimation's problem predicts that record from the same parameters: what is left at the best initial state
has to be rounding, whatever the effect, its further parameters switched on too. Without the effect, or with one of its
parameters as it was, it is not.

Such an agreement needs that both take the same steps, and that nothing is unknown where the window begins:

- The machine rests until then: what an estimation takes from the time before (spool, commands on their way, filters of
  sensors and controllers) is then exact.
- The simulation takes the stiff steps of the estimation (stiff=True), as long as a control period; a recorded command
  is held. Where nothing happens that asks for short ones the estimation would take longer steps: here it does not, and
  what they change is held against the noise by itself.
- A delay is a whole number of steps: within one the simulation stops, the estimation takes the mean. A late clock is
  late by whole samples: the rest counts to first order.
- Where a controller is simulated, the record has each of its samples, and there are no electronics: the estimation
  leaves out the steps of their converters, which are noise to it. Their filters agree as far as the finest converters
  let them.
- Friction sets in softly, so that the search for the initial state is not caught at its kink.

Under a platform it is no rounding: the estimation evaluates the mechanism along the measured path (measured_path.hpp),
whose curvature it smooths away, and to first order beside it: a few millionths of the range, far below what any effect
does.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
import pytest
import sms.rigs.bench
import sms.rigs.platform
import sms.rigs.tank
from _pytest.mark import ParameterSet
from numpy.typing import NDArray
from sms import Params, _core, simulate_bench, simulate_platform, simulate_tank
from sms.diagnosis.effects.catalogue import Effect, catalogue
from sms.estimation.run import Run
from sms.estimation.windows import Runs
from sms.io import load_rig, write_record
from sms.io.rig import Rig
from sms.io.signals import KINDS, of_legs, without_leg
from sms.parameters import common_parameter, is_of_leg
from sms.rigs.kinds import kind_of
from sms.simulation import Run as Simulated

pytestmark = pytest.mark.skipif(not _core.has_estimation, reason="built without Ceres")
Array = NDArray[np.float64]
Machine = Params | _core.LegParams

RANGE = {
    "extension": 0.4,
    "roll": 0.4,
    "pitch": 0.4,
    "tank_temperature": 300.0,
    "valve_command": 10.0,
}
PRESSURES = 5e5
NOISE = 1e-11
"""Of the range: as declared, so that the search for the initial state goes on until nothing is left."""
REST, MOVES = 0.2, 0.8
"""s: at rest, of which the first 0.1 s are before the window and the rest in it; then in motion."""


@pytest.fixture
def one_step_everywhere(monkeypatch: pytest.MonkeyPatch) -> None:
    for rig in (sms.rigs.tank, sms.rigs.bench):
        monkeypatch.setattr(rig, "LONGEST_STEP_ELSEWHERE", rig.LONGEST_STEP)


LONGEST_STEPS = {
    "tank": sms.rigs.tank.LONGEST_STEP,
    "bench": sms.rigs.bench.LONGEST_STEP,
    "platform": sms.rigs.platform.LONGEST_STEP,
}


@dataclass(frozen=True)
class Setting:
    """One rig, its valves driven by a recorded command or by a simulated controller."""

    kind: str
    law: str | None
    """Of the controller; None: the command is recorded."""
    electronics: bool = False

    @property
    def period(self) -> float:
        """s, of the controller and of the integration: the longest step that the estimation takes."""
        return LONGEST_STEPS[self.kind]

    @property
    def every(self) -> int:
        """Control periods in a sample of the record."""
        if self.law is not None:
            return 1
        return round(0.01 / self.period)

    @property
    def same(self) -> float:
        """What may be left, of the range."""
        return 3e-5 if self.kind == "platform" else 1e-9

    @property
    def share(self) -> float:
        """What may be left, of what the effect does."""
        return 0.1 if self.kind == "platform" else 1e-4

    def time(self) -> Array:
        """s from the beginning of the motion, a sample each; below zero at rest."""
        step = self.every * self.period
        return np.asarray(step * np.arange(round((REST + MOVES) / step)) - REST)


SETTINGS = (
    Setting("tank", None),
    Setting("bench", None),
    Setting("bench", "pid"),
    Setting("bench", "state_feedback"),
    Setting("platform", None),
    Setting("platform", "pid"),
    Setting("platform", "state_feedback"),
)


# ---- machines ------------------------------------------------------------------------------------


def healthy(setting: Setting) -> Machine:
    """The machine without any effect, but for the supply's line, which is felt."""
    gentle = setting.kind == "platform"
    params = Params(
        stiction_velocity=0.05,
        supply_line_resistance=1e6,
        tank_initial_pressure=2e5,
        control_period=setting.period,
        dead_band_sharpness=10.0 if gentle else 100.0,
        proportional_gain=10.0 if gentle else 20.0,
        integral_gain=2.0,
        derivative_gain=0.02,
        position_gain=15.0 if gentle else 40.0,
        velocity_gain=0.5 if gentle else 1.0,
        acceleration_gain=-0.002 if gentle else -0.005,
    )
    return _core.LegParams(params) if setting.kind == "platform" else params


SOUND = float(np.sqrt(1.4 * 288.0 * 293.0))
"""m/s, in air of 20 degrees."""
FIRST = {
    "command_delay": 0.03,
    "tube_length": 0.01 * SOUND,
    "clock_skew_extension": 0.02,
    "clock_skew_chamber_pressure": -0.03,
    "clock_skew_attitude": 0.03,
    "clock_skew_tank": -0.03,
    "supply_line_resistance": 1e8,
    "exponential_friction_force": 5.0,
    "moving_mass": 6.0,
    "tank_volume": 6e-3,
    "polytropic_index": 1.1,
    "compression_heat_ratio": 1.3,
    "sensor_lag_extension": 0.02,
    "sensor_offset_extension": 2.5e-3,
    "pressure_friction": 5e-5,
    "piston_leakage": 3e-9,
    "chamber_leakage_lower": 3e-9,
    "chamber_leakage_upper": 3e-9,
    "frame_compliance": 1e-6,
    "proportional_gain": 14.0,
    "integral_gain": 4.0,
    "derivative_gain": 0.03,
    "position_gain": 20.0,
    "velocity_gain": 0.7,
    "acceleration_gain": -0.003,
    "dead_band_step": 0.7,
}
"""Where a tenth of the way to the largest plausible value is no size to compare at: delays of whole steps, clocks of
whole samples; what would drive a piston into its end, or hardly be felt. A platform's mount
yields a micrometre a newton: by as much as it yields, the mechanism is evaluated beside its place."""
FURTHER = {
    "leakage_critical_ratio": 0.3,
    "leakage_index": 1.3,
    "piston_leakage_index": 0.7,
    "chamber_leakage_index_lower": 0.7,
    "chamber_leakage_index_upper": 0.7,
    "tube_diameter": 5e-3,
    "tube_loss_factor": 2.0,
    "heat_transfer_coefficient": 60.0,
    "bristle_stiffness": 2e5,
    "pressure_stiction": 2e-6,
    "outflow_heat_ratio": 1.1,
    "supply_line_turbulence": 1e13,
    "payload_cog_y": 0.03,
}
"""The parameters that an effect has beside its size."""


def sized(effect: Effect, machine: Machine) -> dict[str, float]:
    """Values for each of the effect's parameters, none as it was."""
    name = effect.parameters[0]
    reference = float(machine[common_parameter(name)])
    own = 0.0 if is_of_leg(name) else reference
    _, high = effect.plausible_range(reference)
    values = {name: own + 0.1 * (high - own)}
    if common_parameter(name) in FIRST:
        values[name] = FIRST[common_parameter(name)] - (reference - own)
    for other in effect.parameters[1:]:
        common = float(machine[common_parameter(other)])
        values[other] = FURTHER[common_parameter(other)] - (common if is_of_leg(other) else 0.0)
    return values


def changed(machine: Machine, values: Mapping[str, float]) -> Machine:
    out = machine.copy()
    for name, value in values.items():
        assert out[name] != value, name
        out[name] = value
    return out


# ---- records -------------------------------------------------------------------------------------


def ramped(time: Array, frequency: float) -> Array:
    """A sine that sets in gently, rad/s; zero at rest."""
    moving = np.maximum(time, 0.0)
    return np.asarray(np.sin(frequency * moving) * np.minimum(1.0, 5.0 * moving))


def tank(setting: Setting, machine: Machine, chambers: str) -> tuple[Simulated, Array]:
    volts = 5.0 + 1.6 * ramped(setting.time(), 12.0)
    command = np.repeat(volts, setting.every)
    run = simulate_tank(
        command, params=machine, chamber_law=chambers, step=setting.period, stiff=True
    )
    return run, volts


def bench(setting: Setting, machine: Machine, chambers: str) -> tuple[Simulated, Array]:
    """From an end cushion, out of it and into it again."""
    time = setting.time()

    def run(command: Array) -> Simulated:
        return simulate_bench(
            command,
            controller=setting.law or "open_loop",
            electronics=setting.electronics,
            extension=0.03,
            params=machine,
            chamber_law=chambers,
            step=setting.period,
            stiff=True,
        )

    if setting.law is None:
        volts = 5.0 + 0.9 * ramped(time, 9.0) + 0.5 * ramped(time, 23.0)
        return run(np.repeat(volts, setting.every)), volts
    at_rest = run(np.zeros(1)).reading("extension")[0]
    jumps = np.sign(np.sin(9.0 * np.maximum(time, 0.0)))
    setpoint = at_rest + 0.015 * ramped(time, 12.0) + 0.005 * jumps
    return run(setpoint), setpoint


def platform(setting: Setting, machine: Machine, chambers: str) -> tuple[Simulated, Array]:
    """Gently, each leg another way; the cushions are felt where it stands low."""
    assert isinstance(machine, _core.LegParams)
    low = any(leg.cushion_damping > 0.0 for leg in machine.legs)

    def run(command: Array) -> Simulated:
        return simulate_platform(
            command,
            controller=setting.law or "open_loop",
            electronics=setting.electronics,
            pose=(0.0, 0.0, 0.315 if low else 0.5),
            params=machine.legs,
            chamber_law=chambers,
            step=setting.period,
            stiff=True,
        )

    time = setting.time()
    waves = np.column_stack(
        [sign * ramped(time, f) for sign, f in ((1.0, 8.0), (-1.0, 9.0), (1.0, 10.0))]
    )
    if setting.law is None:
        volts = 5.0 + waves * np.array([0.62, 0.65, 0.68])
        return run(np.repeat(volts, setting.every, axis=0)), volts
    one = run(np.zeros((1, 3)))
    at_rest = np.array([one.reading(s)[0] for s in of_legs("extension")])
    setpoint = at_rest + 0.01 * waves
    return run(setpoint), setpoint


SIMULATE = {"tank": tank, "bench": bench, "platform": platform}


@cache
def rig_of(folder: Path, setting: Setting, chambers: str) -> Rig:
    """A rig file with every signal that such a rig can have."""
    names = [s for s in KINDS[setting.kind].signals if s not in ("rod_force", "spool_position")]
    if setting.law is None:
        names = [s for s in names if without_leg(s) != "setpoint"]
    text = f'[rig]\nkind = "{setting.kind}"\ntitle = "A rig"\n\n[signals]\n'
    text += "".join(f'{s} = "{s}"\n' for s in names) + f'\n[model]\nchambers = "{chambers}"\n'
    if setting.law is not None:
        text += f'\n[control]\nloop = "closed"\ncontroller = "simulated"\nlaw = "{setting.law}"\n'
        text += f"electronics = {str(setting.electronics).lower()}\n"
    text += f'\n[parameters]\ncontrol_period = "{setting.period} s"\n'
    text += '\n[[records]]\nfile = "run.csv"\nrole = "identify"\n'
    write_record(folder / "run.csv", {"time": np.arange(3.0)})
    (folder / "rig.toml").write_text(text)
    return load_rig(folder / "rig.toml")


def noise_of(signal: str) -> float:
    return NOISE * RANGE.get(without_leg(signal), PRESSURES)


def estimated(setting: Setting, run: Simulated, driven_by: Array, rig: Rig) -> Runs:
    """The simulated run as a record that estimation takes."""
    kind = kind_of(rig)
    signals = {}
    for name in rig.signals:
        if without_leg(name) == "setpoint":
            column = driven_by if driven_by.ndim == 1 else driven_by[:, int(name[-1]) - 1]
            signals[name] = np.ascontiguousarray(column)
        elif name != "time":
            is_command = without_leg(name) == "valve_command"
            values = run[name] if is_command else run.reading(name)
            signals[name] = np.ascontiguousarray(values[:: setting.every])
    time = np.ascontiguousarray(run.time[:: setting.every])
    record = Run("run", "identify", time, signals, frozenset(), {}, hold="previous")
    return Runs(rig, (record,), {s: noise_of(s) for s in kind.outputs}, kind)


def left(runs: Runs, machine: Machine) -> float:
    """Of the range: the largest difference between what these parameters predict and the record."""
    problem, most = runs.simulation, np.inf
    assert [w.record for w in problem.windows] == [0]
    for _ in range(3):  # each search for the initial state goes on where the last one ended
        residual, _ = problem.evaluate(machine, ["coulomb_force"])
        before, most = most, NOISE * float(np.max(np.abs(residual)))
        if not most < 0.5 * before:
            break
    return most


# ---- the tests -----------------------------------------------------------------------------------


def of_one_leg(effect: Effect) -> bool:
    """One that all legs may have, in one of them."""
    return (effect.signal or "").rpartition(", ")[2].startswith("leg ")


def applies(setting: Setting, effect: Effect) -> bool:
    """Whether there is anything to compare.

    A controller that is not simulated predicts nothing. What one leg has alone reaches its controller by the same way
    as what all legs have: once, with the command recorded, is enough.
    """
    return effect.controller in (None, setting.law) and not (of_one_leg(effect) and setting.law)


CASES = [(s, e) for s in SETTINGS for e in catalogue(s.kind) if applies(s, e)]


def name_of(setting: Setting, effect: Effect) -> str:
    laws = f" ({effect.chambers})" if effect.chambers else ""
    return f"{setting.kind}-{setting.law or 'recorded'}-{effect.key}{laws}"


IN_LEG_2 = {
    common_parameter(e.parameters[0])
    for e in catalogue("platform")
    if is_of_leg(e.parameters[0]) and (e.signal or "").endswith("leg 2")
}
"""What a platform may have in its second leg alone."""


def case(setting: Setting, effect: Effect) -> ParameterSet:
    """Heavy where it has been shown of another controller, in another leg, or of one leg where all have it: what all
    have and what a leg has more are added before anything is worked out (test_diagnosis_platform.py)."""
    known = (setting.kind, setting.law) in (
        ("bench", "state_feedback"),
        ("platform", "pid"),
        ("platform", "state_feedback"),
    )
    first_or_third = bool(re.search(r"(_|leg )[13]$", effect.signal or ""))
    every_leg = setting.kind == "platform" and effect.parameters[0] in IN_LEG_2
    heavy = (known or first_or_third or every_leg) and effect.controller is None
    marks = [pytest.mark.full] if heavy else []
    return pytest.param(setting, effect, id=name_of(setting, effect), marks=marks)


def test_only_controllers_that_are_not_simulated_are_left_out() -> None:
    compared = {(s.kind, e) for s, e in CASES}
    for kind in SIMULATE:
        omitted = {e for e in catalogue(kind) if (kind, e) not in compared}
        assert {e.controller for e in omitted} <= {"recorded"}


@pytest.mark.usefixtures("one_step_everywhere")
@pytest.mark.parametrize(("setting", "effect"), [case(s, e) for s, e in CASES])
def test_a_simulated_effect_is_predicted_by_the_estimation(
    setting: Setting, effect: Effect, tmp_path_factory: pytest.TempPathFactory
) -> None:
    chambers = effect.chambers or (
        "energy" if effect.signal == "tank_temperature" else "polytropic"
    )
    base = healthy(setting)
    values = sized(effect, base)
    machine = changed(base, values)
    run, driven_by = SIMULATE[setting.kind](setting, machine, chambers)
    rig = rig_of(tmp_path_factory.getbasetemp(), setting, chambers)
    runs = estimated(setting, run, driven_by, rig)
    difference = left(runs, machine)
    assert difference < setting.same
    # What one leg alone does is little: with all of its parameters. Each of them counts where all legs have it.
    for names in [list(values)] if of_one_leg(effect) else [[name] for name in values]:
        without = changed(machine, {name: base[name] for name in names})
        assert difference < setting.share * left(runs, without), names


def test_longer_steps_in_motion_change_far_less_than_a_good_sensor_s_noise(
    tmp_path: Path,
) -> None:
    setting = Setting("bench", None)
    machine = healthy(setting)
    run, driven_by = SIMULATE["bench"](setting, machine, "polytropic")
    rig = rig_of(tmp_path, setting, "polytropic")
    problem = estimated(setting, run, driven_by, rig).simulation
    for _ in range(3):  # each search for the initial state goes on where the last one ended
        residual, _ = problem.evaluate(machine, ["coulomb_force"])
    (window,) = problem.windows
    off = NOISE * np.sqrt(np.mean(residual.reshape(window.samples, -1) ** 2, axis=0))
    good = 1e-4  # of the range: 0.04 mm, 50 Pa
    assert 0.0 < np.max(off) < 0.5 * good


@pytest.mark.parametrize("law", ["pid", "state_feedback"])
@pytest.mark.parametrize("kind", ["bench", "platform"])
def test_filters_of_the_electronics_are_those_of_the_estimation(
    kind: str, law: str, tmp_path: Path
) -> None:
    setting, plain = Setting(kind, law, electronics=True), Setting(kind, law)
    machine = changed(healthy(setting), {"adc_bits": 24.0, "pwm_steps": 1e9})
    run, driven_by = SIMULATE[kind](setting, machine, "polytropic")
    as_it_is = estimated(setting, run, driven_by, rig_of(tmp_path, setting, "polytropic"))
    without = estimated(plain, run, driven_by, rig_of(tmp_path, plain, "polytropic"))
    difference = left(as_it_is, machine)
    assert difference < 1e-5
    assert difference < 0.01 * left(without, machine)
