"""How long a diagnosis of a plant of one's own takes: 3 states, 10 effects, 5,000 samples.

    .venv/bin/python -m validation.speed.own_model            the goal: 30 s on two cores
    .venv/bin/python -m validation.speed.own_model --profile  where the time goes

Three tanks in a row, a pump into the first, all levels measured. A leak of the second is hidden, a spill over the rim
of the first (for which there is no effect), or nothing; each is diagnosed with its curve measured, the longest way.
"""

from __future__ import annotations

import argparse
import cProfile
import importlib
import pstats
import time
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
from sms.arrays import Array
from sms.diagnosis import own
from sms.diagnosis.own.integrate import Batch, simulate

ROLES: tuple[own.Role, ...] = ("identify", "identify", "validate", "validate", "test")
NOISE, STEP, WINDOW = 0.4e-3, 1.0, 50.0
GOAL = 30.0
"""s"""
CASES = {"healthy": {}, "leak": {"leak_2": 1.5e-6}, "spill": {"spill": 4e-3}}


def derivative(
    p: Any, x: Any, u: Any, sqrt: Any = np.sqrt, most: Any = np.maximum
) -> Sequence[Any]:
    """Rates of the levels, m/s; sqrt, most: of numpy, or of CasADi."""
    first, second, third = (sqrt(19.62 * most(x[k], 1e-6)) for k in range(3))
    pumped = p.pump_gain * most(u[0] - p.dead_band, 0.0)
    spilled = p.spill * most(x[0] - 0.08, 0.0)
    return (
        (pumped - (p.outlet_1 + p.leak_1) * first - spilled) / 15.5e-4,
        (p.outlet_1 * first - (p.outlet_2 + p.leak_2) * second) / 15.5e-4,
        (p.outlet_2 * second - (p.outlet_3 + p.leak_3) * third) / 15.5e-4,
    )


def with_casadi(plant: own.Model) -> own.Model:
    """The same plant with exact derivatives."""
    casadi: Any = importlib.import_module("casadi")
    parts = ("states", "inputs", "outputs", "parameters", "effects", "title")
    given: dict[str, Any] = {name: getattr(plant, name) for name in parts}
    return own.Model.from_casadi(
        derivative=partial(derivative, sqrt=casadi.sqrt, most=casadi.fmax), output=output, **given
    )


def output(p: Any, x: Any, u: Any) -> Sequence[Any]:
    """The gauges, m."""
    return [x[0] + p.zero_1, x[1] + p.zero_2, x[2]]


def model() -> own.Model:
    """Ten effects: outlets, leaks, pump, dead band, zeros."""
    known = [own.Parameter(f"outlet_{k}", "m^2", 5e-6, 17.8e-6, 40e-6, 0.2e-6) for k in (1, 2, 3)]
    known.append(own.Parameter("pump_gain", "m^3/(s V)", 1e-6, 3.3e-6, 6e-6, 0.05e-6))
    missing = [own.Parameter(f"leak_{k}", "m^2", 0.0, 0.0, 10e-6) for k in (1, 2, 3)]
    missing.append(own.Parameter("dead_band", "V", 0.0, 0.0, 3.0))
    missing += [own.Parameter(f"zero_{k}", "m", -0.05, 0.0, 0.05) for k in (1, 2)]
    return own.Model(
        title="Three tanks",
        states=[
            own.State(f"level_{k}", "m", scale=0.01, equation=f"balance of tank {k}")
            for k in (1, 2, 3)
        ],
        inputs=[own.Input("pump", "V", held=True)],
        outputs=[own.Output(f"level_{k}", "m", noise=NOISE) for k in (1, 2, 3)],
        parameters=[*known, *missing, own.Parameter("spill", "m^2/s", 0.0, 0.0, 1.0)],
        derivative=derivative,
        output=output,
        effects=[
            own.Effect(p.name, p.name, f"another {p.name}", "It is another than declared.")
            for p in (*known, *missing)
        ],
    )


def records(plant: own.Model, case: str, samples: int) -> list[own.Record]:
    """Five records of one length, `samples` in all."""
    rng, out = np.random.default_rng([1, list(CASES).index(case)]), []
    values = plant.with_values(CASES[case]).values()
    each = samples // len(ROLES)
    for number, role in enumerate(ROLES):
        volts = np.repeat(rng.uniform(0.0, 9.0, each // 30 + 1), 30)[:each]
        batch = Batch(np.array([STEP]), volts[:, None, None], rng.uniform(0.02, 0.1, (3, 1)))
        levels = simulate(replace(plant, longest_step=0.05), values, batch)[..., 0]
        levels = levels + rng.normal(0.0, NOISE, levels.shape)
        signals: dict[str, Array] = {"time": STEP * np.arange(float(each)), "pump": volts}
        signals |= {f"level_{k + 1}": levels[:, k] for k in range(3)}
        out.append(own.Record(f"run {number}", role, signals))
    return out


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--samples", type=int, default=5000, help="of all records together")
    parser.add_argument("--case", choices=CASES, action="append")
    parser.add_argument("--profile", action="store_true", help="print where the time goes")
    parser.add_argument("--casadi", action="store_true", help="the plant with exact derivatives")
    options = parser.parse_args()
    plain, worst = model(), 0.0
    plant = with_casadi(plain) if options.casadi else plain
    for case in options.case or CASES:
        given = records(plain, case, options.samples)
        profile = cProfile.Profile() if options.profile else None
        wall, cpu = time.perf_counter(), time.process_time()
        if profile is not None:
            profile.enable()
        answer = own.diagnose_model(plant, given, WINDOW, empirical=True)
        if profile is not None:
            profile.disable()
        wall, cpu = time.perf_counter() - wall, time.process_time() - cpu
        worst = max(worst, wall)
        named = ", ".join(m for c in answer.causes for m in c.members)
        print(f"{case}: {answer.verdict} {named}, {wall:.1f} s, of a processor {cpu:.1f} s")
        if profile is not None:
            pstats.Stats(profile).sort_stats("cumulative").print_stats(45)
    print(f"the longest {worst:.1f} s; the goal is {GOAL:.0f} s for 5,000 samples")


if __name__ == "__main__":
    main()
