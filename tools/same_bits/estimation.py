"""Residuals and derivatives of every problem of the estimation, on records of drawn machines."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from sms import (
    Params,
    _core,
    simulate_bench,
)
from sms.simulation import CHAMBER_LAWS, FRICTION_LAWS

from tools.same_bits.simulation import (
    Array,
    Case,
    machine,
    platform_run,
    platform_setpoints,
    tank_run,
)

EFFECTS = (
    {},
    {"supply_line_resistance": 1e6, "command_delay": 0.004},
    {"presliding_share": 0.5, "friction_lag": 0.02, "backlash": 5e-4},
    {"heat_share": 0.4, "sensor_lag_extension": 0.004, "clock_skew_chamber_pressure": 0.013},
)
"""Each lets another part of the estimation's plants work, and other numbers of an initial state be felt."""
FREE = (
    "mass_flow_gain",
    "coulomb_force",
    "viscous_friction",
    "dead_volume_lower",
    "supply_pressure",
    "command_delay",
    "presliding_share",
    "friction_lag",
    "heat_share",
    "sensor_gain_extension",
    "clock_skew_extension",
)
EVERY = 5
"""Control periods in a sample of a record."""


def noisy(values: Array, size: float, seed: int) -> Array:
    """A record's signal."""
    random = np.random.default_rng(seed)
    kept = values[::EVERY]
    return np.ascontiguousarray(kept + size * random.standard_normal(kept.shape))


def answers_of(problem: object, params: Params | _core.LegParams, free: list[str]) -> Array:
    """All that a problem is asked for, in the order in which a diagnosis asks."""
    parts = [*problem.evaluate(params), *problem.evaluate(params, free)]  # type: ignore[attr-defined]
    if hasattr(problem, "hidden"):
        problem.settle(params)  # type: ignore[attr-defined]
        parts += [problem.errors(params), problem.hidden(params, 3)]  # type: ignore[attr-defined]
    return np.concatenate([np.ravel(part) for part in parts])


def with_rates(values: Array, derivatives: int, step: float) -> Array:
    """(n, 1 + derivatives): a signal with its differences."""
    columns = [values]
    for _ in range(derivatives):
        columns.append(np.gradient(columns[-1], step))
    return np.column_stack(columns)


def bench_cases() -> Iterator[Case]:
    noise = {
        "extension": 1e-4,
        "chamber_pressure_lower": 500.0,
        "chamber_pressure_upper": 500.0,
        "supply_pressure": 500.0,
        "valve_command": 1e-2,
    }
    time = 1e-3 * np.arange(1200)
    setpoint = 0.2 + 0.05 * np.sin(6.0 * time)
    step = EVERY * 1e-3

    def record(number: int) -> dict[str, Array]:
        run = simulate_bench(setpoint, controller="pid", params=machine(number, EFFECTS[number]))
        return {
            "command": noisy(run["valve_command"], 0.0, 1),
            "extension": noisy(run["extension"], 1e-4, 2),
            "pressure_lower": noisy(run["chamber_pressure_lower"], 500.0, 3),
            "pressure_upper": noisy(run["chamber_pressure_upper"], 500.0, 4),
            "supply_pressure": noisy(run["supply_pressure"], 500.0, 5),
        }

    def problem(number: int, loop: bool, friction: str, chambers: str) -> Array:
        signals = record(number)
        if number == 3:
            del signals["supply_pressure"]
        said = machine(number + 10, EFFECTS[number])
        records = [
            _core.BenchRecord(step=step, setpoint=setpoint[::EVERY] if loop else [], **signals)
        ]
        laws = {"friction": friction, "chambers": chambers, "window": 0.5}
        made = (
            _core.BenchLoopProblem(
                records=records, noise=noise, said=said, electronics=bool(number % 2), **laws
            )
            if loop
            else _core.BenchProblem(records=records, noise=noise, **laws)
        )
        return answers_of(made, said, list(FREE) + ["proportional_gain"] * loop)

    def equations(number: int, friction: str) -> Array:
        s = record(number)
        made = _core.BenchEquations(
            step=step,
            command=s["command"],
            extension=with_rates(s["extension"], 2, step),
            pressure_lower=with_rates(s["pressure_lower"], 1, step),
            pressure_upper=with_rates(s["pressure_upper"], 1, step),
            friction=friction,
        )
        return answers_of(made, machine(number + 10, EFFECTS[number]), list(FREE))

    kinds = [(number, FRICTION_LAWS[0], CHAMBER_LAWS[0]) for number in range(len(EFFECTS))]
    kinds += [(0, friction, CHAMBER_LAWS[1]) for friction in FRICTION_LAWS[1:]]
    for number, friction, chambers in kinds:
        for loop in (False, True):
            yield (
                f"estimation bench{' loop' * loop} {number} {friction} {chambers}",
                lambda n=number, k=loop, f=friction, c=chambers: problem(n, k, f, c),
            )
        yield (
            f"equations bench {number} {friction} {chambers}",
            lambda n=number, f=friction: equations(n, f),
        )


def platform_cases() -> Iterator[Case]:
    noise = {"supply_pressure": 500.0, "roll": 3e-4, "pitch": 3e-4}
    for leg in (1, 2, 3):
        noise |= {f"extension_{leg}": 1e-4, f"valve_command_{leg}": 1e-2}
        noise |= {f"chamber_pressure_{c}_{leg}": 500.0 for c in ("lower", "upper")}
    step = EVERY * 1e-3
    free = [*FREE, "payload_mass", "coulomb_force:2", "chamber_leakage_lower:3", "panhard_friction"]

    def record(number: int) -> dict[str, Array]:
        run = platform_run(number, effects=EFFECTS[number], seconds=0.6)
        return {
            "command": noisy(run.legs("valve_command"), 0.0, 1),
            "extension": noisy(run.legs("extension"), 1e-4, 2),
            "pressure_lower": noisy(run.legs("chamber_pressure_lower"), 500.0, 3),
            "pressure_upper": noisy(run.legs("chamber_pressure_upper"), 500.0, 4),
            "supply_pressure": noisy(run["supply_pressure_1"], 500.0, 5),
            "roll": noisy(run["roll"], 3e-4, 6),
            "pitch": noisy(run["pitch"], 3e-4, 7),
        }

    def said(number: int) -> _core.LegParams:
        legs = _core.LegParams(machine(number + 10, EFFECTS[number]))
        legs["coulomb_force:2"] = 3.0
        return legs

    def problem(number: int, loop: bool, friction: str) -> Array:
        signals = record(number)
        if number == 3:
            del signals["roll"], signals["pitch"]
        setpoint = platform_setpoints(0.6)[::EVERY] if loop else np.zeros((0, 3))
        records = [_core.PlatformRecord(step=step, setpoint=setpoint, **signals)]
        laws = {"friction": friction, "window": 0.3}
        made = (
            _core.PlatformLoopProblem(records=records, noise=noise, said=said(number), **laws)
            if loop
            else _core.PlatformProblem(records=records, noise=noise, **laws)
        )
        return answers_of(made, said(number), free + ["proportional_gain:1"] * loop)

    def equations(number: int) -> Array:
        s = record(number)

        def of_legs(name: str, derivatives: int) -> list[Array]:
            return [with_rates(s[name][:, leg], derivatives, step) for leg in range(3)]

        made = _core.PlatformEquations(
            step=step,
            command=list(np.ascontiguousarray(s["command"].T)),
            extension=of_legs("extension", 2),
            pressure_lower=of_legs("pressure_lower", 1),
            pressure_upper=of_legs("pressure_upper", 1),
            roll=with_rates(s["roll"], 1, step),
            pitch=with_rates(s["pitch"], 1, step),
        )
        return answers_of(made, said(number), free)

    for number in range(len(EFFECTS)):
        friction = FRICTION_LAWS[0] if number != 1 else "lugre"
        for loop in (False, True):
            yield (
                f"estimation platform{' loop' * loop} {number} {friction}",
                lambda n=number, k=loop, f=friction: problem(n, k, f),
            )
        yield f"equations platform {number}", lambda n=number: equations(n)


def tank_cases() -> Iterator[Case]:
    free = ["mass_flow_gain", "tank_volume", "supply_pressure", "heat_share", "command_delay"]
    noise = {"tank_pressure": 300.0, "tank_temperature": 0.1, "supply_pressure": 300.0}
    step = EVERY * 1e-3

    def record(number: int) -> dict[str, Array]:
        run = tank_run(machine(number, EFFECTS[number]))
        return {
            "command": noisy(run["valve_command"], 0.0, 1),
            "pressure": noisy(run["tank_pressure"], 300.0, 2),
            "temperature": noisy(run["tank_temperature"], 0.1, 3),
            "supply_pressure": noisy(run["supply_pressure"], 300.0, 4),
        }

    def problem(number: int, chambers: str) -> Array:
        made = _core.TankPlantProblem(
            records=[_core.TankPlantRecord(step=step, **record(number))],
            noise=noise,
            chambers=chambers,
            window=0.5,
        )
        said = machine(number + 10, EFFECTS[number])
        said["mass_flow_gain"] *= 1.1
        return answers_of(made, said, free)

    def charge(number: int, heat: str) -> Array:
        s = record(number)
        rows = slice(0, 160)
        made = _core.TankProblem(
            time=step * np.arange(160.0), pressure=s["pressure"][rows], charge=True, heat=heat
        )
        return answers_of(made, machine(number + 10), free[:2])

    def equations(number: int) -> Array:
        s = record(number)
        made = _core.TankEquations(
            step=step,
            command=s["command"],
            pressure=with_rates(s["pressure"], 1, step),
            temperature=with_rates(s["temperature"], 1, step),
        )
        return answers_of(made, machine(number + 10, EFFECTS[number]), free)

    for number in range(len(EFFECTS)):
        for chambers in CHAMBER_LAWS:
            yield (
                f"estimation tank {number} {chambers}",
                lambda n=number, c=chambers: problem(n, c),
            )
            yield f"charge {number} {chambers}", lambda n=number, c=chambers: charge(n, c)
        yield f"equations tank {number}", lambda n=number: equations(n)


def other_cases() -> Iterator[Case]:
    time = 1e-3 * np.arange(600)

    def cylinder(number: int, law: str) -> Array:
        run = simulate_bench(5.0 + 0.8 * np.sin(12.0 * time), params=machine(number))
        made = _core.CylinderProblem(
            [
                _core.CylinderRecord(
                    extension=run["extension"],
                    velocity=run["velocity"],
                    acceleration=run["acceleration"],
                    pressure_lower=run["chamber_pressure_lower"],
                    pressure_upper=run["chamber_pressure_upper"],
                    rod_force=np.zeros(time.size),
                    time=time,
                )
            ],
            law,
        )
        return answers_of(
            made,
            machine(number + 10),
            [
                "coulomb_force",
                "viscous_friction",
                "pressure_friction",
                "moving_mass",
                "bore_diameter",
            ],
        )

    def spool(number: int, law: str) -> Array:
        run = simulate_bench(5.0 + 0.8 * np.sin(30.0 * time), params=machine(number))
        record = _core.SpoolRecord(
            step=1e-3,
            command=run["valve_command"],
            position=1e-3 * (run["spool_voltage"] - 5.0) ** 3 / 25.0,
        )
        return answers_of(
            _core.SpoolProblem([record], law),
            machine(number + 10),
            ["valve_frequency", "spool_cubic_1"],
        )

    for number, law in enumerate(FRICTION_LAWS):
        yield f"cylinder {law}", lambda n=number, k=law: cylinder(n, k)
    for number, law in enumerate(("cubic", "linear")):
        yield f"spool {law}", lambda n=number, k=law: spool(n, k)
