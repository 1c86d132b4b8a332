"""How often the stated 95 percent intervals hold the truth, over seeded repeats of the test matrix.

    python -m validation.trials.identify_flow [--repeats 200] [--seed 1] [--colour 0.0]

Each repeat is a new test: another moment of opening, other noise. The tank's volume, temperature
and pressures are known exactly, so that C is judged on the fit's own error.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from sms.identification.flow import fit_record
from sms.identification.flow_problem import COMPONENT, SYMBOL
from sms.identification.flow_record import FlowRecord
from sms.io.declarations import Declaration
from sms.parameters import PARAMETERS

from validation.twins.flow_test import (
    FLOOR,
    Charging,
    Sensor,
    delayed,
    duration_of,
    read,
    simulate,
    true_component,
)

CASES = tuple(
    (spool, charge, supply)
    for supply in (286e3, 486e3)
    for charge in (True, False)
    for spool in (0.3e-3, 1.0e-3)
)


def declared(name: str) -> Declaration:
    """What the virtual rig's owner knows: everything but the supply pressure, which is within 2 kPa."""
    return Declaration(PARAMETERS[name].default, 2e3 if name == "supply_pressure" else 0.0)


def one_test(
    spool: float, charge: bool, supply: float, rng: np.random.Generator, colour: float = 0.0
) -> tuple[FlowRecord, Charging]:
    """A record of the matrix and what made it."""
    component = true_component(spool, charge)
    test = delayed(Charging(component, charge, supply, duration=duration_of(spool)), rng)
    time, pressure = simulate(test)
    sensor = replace(Sensor(floor=0.0 if charge else FLOOR), colour=colour)
    reading = read(pressure, sensor, rng)
    name = f"{'charge' if charge else 'discharge'} {1e-5 * supply:.2f} bar {1e3 * spool:.2f} mm"
    return FlowRecord(name, time, reading, None, None, spool, supply, test.ambient), test


@dataclass(frozen=True)
class Coverage:
    """One case over all repeats."""

    case: str
    covered: dict[str, float]
    """Share of the intervals of C, b, m that hold the truth."""
    error: dict[str, float]
    """Root mean square of estimate less truth; of C relative."""
    identifiable: dict[str, float]


def truth_of(test: Charging) -> dict[str, float]:
    """C, b, m by the name of their parameter."""
    c = test.component
    return dict(zip(COMPONENT, (c.conductance, c.ratio, c.index), strict=True))


def cover(
    case: tuple[float, bool, float], repeats: int, seed: int, colour: float = 0.0
) -> Coverage:
    """Fit `repeats` tests of one case."""
    rng = np.random.default_rng([seed, int(1e6 * case[0]), int(case[1]), int(case[2])])
    made = [one_test(*case, rng, colour) for _ in range(repeats)]
    with ThreadPoolExecutor() as pool:
        fits = list(
            pool.map(partial(fit_record, declared=declared), [record for record, _ in made])
        )
    covered, error, told = {}, {}, {}
    for name in COMPONENT:
        true = np.array([truth_of(test)[name] for _, test in made])
        value = np.array([fit.known[name].value for fit in fits])
        low, high = np.array([(fit.known[name].lower, fit.known[name].upper) for fit in fits]).T
        scale = true if name == COMPONENT[0] else 1.0
        covered[name] = float(np.mean((low <= true) & (true <= high)))
        told_rows = np.array([fit.known[name].identifiable for fit in fits])
        told[name] = float(np.mean(told_rows))
        error[name] = float(np.sqrt(np.mean(((value - true) / scale) ** 2)))
    return Coverage(made[0][0].name, covered, error, told)


def run(
    repeats: int, seed: int, colour: float = 0.0, cases: Sequence[tuple[float, bool, float]] = CASES
) -> Iterator[Coverage]:
    """Every case, one after the other."""
    for case in cases:
        yield cover(case, repeats, seed, colour)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(prog="python -m validation.trials.identify_flow")
    parser.add_argument("--repeats", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument(
        "--colour", type=float, default=0.0, help="correlation of the noise from sample to sample"
    )
    options = parser.parse_args()
    symbols = [SYMBOL[name] for name in COMPONENT]
    print(f"{options.repeats} repeats, seed {options.seed}, colour {options.colour:g}\n")
    print("| test | " + " | ".join(f"{s} covered" for s in symbols)
          + " | C error | b error | m error | b identifiable | m identifiable |")  # fmt: skip
    print("|---|" + "---|" * 8)
    for c in run(options.repeats, options.seed, options.colour):
        cells = [f"{100 * c.covered[n]:.1f} %" for n in COMPONENT]
        cells += [f"{100 * c.error[COMPONENT[0]]:.2f} %"]
        cells += [f"{c.error[n]:.3f}" for n in COMPONENT[1:]]
        cells += [f"{100 * c.identifiable[n]:.0f} %" for n in COMPONENT[1:]]
        print(f"| {c.case} | {' | '.join(cells)} |", flush=True)


if __name__ == "__main__":
    main()
