"""Which of the source's coefficients of the actuator can be read off the source's own kind of test?

The published machine (actuator_twin.py) is moved as in section 7.2 of the source, unloaded, by a sine of 0.54 V and
0.328 Hz with a jump of 0.5 V over the dead band; beside it, by a multisine and by steps. Extension and both pressures
are read. No fit is made: the exact derivatives at the printed values say how well each coefficient would be known with
the noise of the sensors, with all others known and with all others unknown.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from sms import Params, _core
from sms.parameters import PARAMETERS
from sms.units_display import format_quantity, words

from validation.twins.actuator import move
from validation.twins.air import Array
from validation.twins.bench import Plan
from validation.twins.bench_rig import BenchRig
from validation.twins.instruments import CHANNELS
from validation.twins.measured import sample_times

COEFFICIENTS = (
    "moving_mass",
    "dead_volume_lower",
    "dead_volume_upper",
    "mass_flow_gain",
    "inflow_heat_ratio",
    "outflow_heat_ratio",
    "compression_heat_ratio",
    "valve_centre",
    "valve_frequency",
    "coulomb_force",
    "viscous_friction",
    "stiction_force",
    "stribeck_velocity",
    "stribeck_exponent",
    "stribeck_acceleration_factor",
    "stiction_velocity",
)
KNOWN = {"supply_pressure": 2e3, "ambient_pressure": 300.0, "air_temperature": 2.0}
"""Beside them, within half widths, SI."""
TOLD = 0.1  #: relative standard error up to which a coefficient counts as identifiable
CENTRE_TOLD = 0.01  #: V
DURATION = 20.0  #: s
TESTS = ("the source's sine", "multisine and steps")


def plans(test: str) -> list[Plan]:
    """The runs of one kind of test."""
    rig = BenchRig()
    rig.duration = DURATION if test == TESTS[0] else 0.5 * DURATION
    time = sample_times(rig.duration, rig.sample_step)
    if test == TESTS[0]:
        wave = np.sin(2.0 * np.pi * 0.328 * time)
        # A hint of a position loop holds the drift that the source took out by an offset.
        return [Plan(0.54 * wave + 0.5 * np.sign(wave), np.full(time.size, 0.2), 0.2, 0.17)]
    rng = np.random.default_rng(1)
    return [rig.plan("multisine", rng), rig.plan("steps", rng)]


def expected_errors(test: str) -> dict[str, tuple[float, float]]:
    """Coefficient -> standard error with all others known, and with all unknown; SI."""
    sample = BenchRig().sample_step
    records = []
    for plan in plans(test):
        commands, signals = move(Params(), plan, sample, np.zeros(plan.setpoint.size))
        records.append(
            _core.BenchRecord(
                step=sample,
                command=commands,
                extension=signals["extension"],
                pressure_lower=signals["chamber_pressure_lower"],
                pressure_upper=signals["chamber_pressure_upper"],
            )
        )
    noise = {name: CHANNELS[name].deviation for name in CHANNELS}
    problem = _core.BenchProblem(records=records, noise=noise)
    names = [*COEFFICIENTS, *KNOWN]
    _, jacobian = problem.evaluate(Params(), names)
    return _errors(jacobian)


def _errors(jacobian: Array) -> dict[str, tuple[float, float]]:
    """From the information of white noise; infinite along what the records do not hold."""
    size = np.array([abs(PARAMETERS[n].default) for n in (*COEFFICIENTS, *KNOWN)])
    j = jacobian * size
    prior = [0.0] * len(COEFFICIENTS) + [
        size[-3 + i] / (u / 3**0.5) for i, u in enumerate(KNOWN.values())
    ]
    normal = j.T @ j + np.diag(np.square(prior))
    values, vectors = np.linalg.eigh(normal)
    held = values > 1e-4  # a direction known to a hundred times its size is not known
    together = np.sqrt(np.sum(vectors[:, held] ** 2 / values[held], axis=1))
    together[np.any(np.abs(vectors[:, ~held]) > 1e-3, axis=1)] = np.inf
    alone = 1.0 / np.sqrt(np.maximum(np.diag(normal), 1e-12))
    return {
        n: (float(a * s), float(t * s))
        for n, a, t, s in zip(COEFFICIENTS, alone, together, size, strict=False)
    }


def table() -> list[str]:
    """Markdown: each printed coefficient, and how well either kind of test would know it."""
    by_test = [expected_errors(test) for test in TESTS]
    head = " | ".join(f"{t}: alone | with all others" for t in TESTS)
    lines = [f"| coefficient | printed | {head} |", "|---|---|" + "---|---|" * len(TESTS)]
    for name in COEFFICIENTS:
        value = PARAMETERS[name].default
        cells = [words(name), format_quantity(value, PARAMETERS[name].unit, name)]
        for errors in by_test:
            cells += [_cell(name, value, error) for error in errors[name]]
        lines.append(f"| {' | '.join(cells)} |")
    return lines


def _cell(name: str, value: float, error: float) -> str:
    if not np.isfinite(error) or error > 10.0 * abs(value):
        return "not identifiable"
    unit = PARAMETERS[name].unit
    limit = CENTRE_TOLD if name == "valve_centre" else TOLD * abs(value)
    text = f"± {format_quantity(error, unit, name, 2)}"
    return text if error <= limit else f"**no** ({text})"


def untold(tests: Sequence[str] = TESTS) -> list[str]:
    """A sentence for each test: what it cannot tell when everything is unknown."""
    said = []
    for test in tests:
        names = [
            words(n)
            for n, (_, e) in expected_errors(test).items()
            if e > (CENTRE_TOLD if n == "valve_centre" else TOLD * abs(PARAMETERS[n].default))
        ]
        said.append(f"not identifiable from {test}: {', '.join(names)}")
    return said
