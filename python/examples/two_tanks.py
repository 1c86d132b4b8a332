"""A plant of one's own, diagnosed: two tanks in a row, a pump into the upper one, both levels measured.

    .venv/bin/python python/examples/two_tanks.py                 all cases, one line each
    .venv/bin/python python/examples/two_tanks.py leak --out report

The laboratory exercise that the cascaded-tanks benchmark made known (Schoukens, Mattsson, Wigren, Noel 2016). What is
"measured" here comes from `measured`, which shares nothing with `MODEL`: its own equations, an adaptive integrator,
noise and a converter. docs/own_model.md explains it step by step.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from sms.arrays import Array
from sms.diagnosis import Diagnosis, own

GRAVITY = 9.81
"""m/s^2"""
CROSS_SECTION = 15.5e-4
"""m^2, of either tank"""

# ---- the model -----------------------------------------------------------------------------------


def derivative(p: own.Values, x: Array, u: Array) -> Sequence[Array]:
    """Rates of both levels, m/s: what comes in less what goes out, over the cross-section (Torricelli)."""
    upper, lower = (np.sqrt(2.0 * GRAVITY * np.maximum(level, 1e-6)) for level in x)
    pumped = p.pump_gain * np.maximum(u[0] - p.pump_dead_band, 0.0)
    passed = p.outlet_upper * upper
    return (
        (pumped - passed - p.leak_upper * upper) / CROSS_SECTION,
        (passed - p.outlet_lower * lower - p.leak_lower * lower) / CROSS_SECTION,
    )


def output(p: own.Values, x: Array, u: Array) -> Sequence[Array]:
    """Both gauges, m."""
    return (
        (1.0 + p.gain_upper) * x[0] + p.offset_upper,
        (1.0 + p.gain_lower) * x[1] + p.offset_lower,
    )


AREA, UPPER, LOWER = "m^2", "balance of the upper tank", "balance of the lower tank"
MODEL = own.Model(
    title="Two tanks in a row",
    states=[
        own.State("level_upper", "m", scale=0.01, equation=UPPER),
        own.State("level_lower", "m", scale=0.01, equation=LOWER),
    ],
    inputs=[own.Input("pump_voltage", "V", held=True)],
    outputs=[
        own.Output("level_upper", "m", noise=0.4e-3),
        own.Output("level_lower", "m", noise=0.4e-3),
    ],
    parameters=[
        own.Parameter("pump_gain", "m^3/(s V)", 1e-6, 3.3e-6, 6e-6, uncertainty=0.05e-6),
        own.Parameter("outlet_upper", AREA, 5e-6, 17.8e-6, 40e-6, uncertainty=0.2e-6),
        own.Parameter("outlet_lower", AREA, 5e-6, 17.8e-6, 40e-6, uncertainty=0.2e-6),
        own.Parameter("pump_dead_band", "V", 0.0, 0.0, 3.0),
        own.Parameter("leak_upper", AREA, 0.0, 0.0, 10e-6),
        own.Parameter("leak_lower", AREA, 0.0, 0.0, 10e-6),
        own.Parameter("gain_upper", "1", -0.2, 0.0, 0.2),
        own.Parameter("gain_lower", "1", -0.2, 0.0, 0.2),
        own.Parameter("offset_upper", "m", -0.05, 0.0, 0.05),
        own.Parameter("offset_lower", "m", -0.05, 0.0, 0.05),
    ],
    derivative=derivative,
    output=output,
    effects=[
        own.Effect(
            "leak_upper",
            "leak_upper",
            "a leak of the upper tank",
            "Water leaves the upper tank beside its outlet and does not reach the lower one.",
            equation=UPPER,
            separated_by="Close the outlet and watch the level.",
        ),
        own.Effect(
            "leak_lower",
            "leak_lower",
            "a leak of the lower tank",
            "Water leaves the lower tank beside its outlet.",
            equation=LOWER,
            separated_by="Close the outlet and watch the level.",
        ),
        own.Effect(
            "outlet_upper",
            "outlet_upper",
            "another outlet of the upper tank",
            "The orifice is worn or clogged: another area than declared.",
            plausible=(9e-6, 27e-6),
            equation=UPPER,
            separated_by="Gauge the orifice.",
        ),
        own.Effect(
            "outlet_lower",
            "outlet_lower",
            "another outlet of the lower tank",
            "The orifice is worn or clogged: another area than declared.",
            plausible=(9e-6, 27e-6),
            equation=LOWER,
            separated_by="Gauge the orifice.",
        ),
        own.Effect(
            "pump_gain",
            "pump_gain",
            "another flow of the pump",
            "The pump delivers another flow for its voltage than declared.",
            plausible=(2e-6, 4.5e-6),
            equation=UPPER,
            separated_by="Collect the pump's flow in a measuring jug.",
        ),
        own.Effect(
            "pump_dead_band",
            "pump_dead_band",
            "a dead band of the pump",
            "Below some voltage the pump does not turn.",
            plausible=(0.0, 2.0),
            equation=UPPER,
            separated_by="Raise the voltage from zero until water comes.",
        ),
        *(
            own.Effect(
                f"{what}_{tank}",
                f"{what}_{tank}",
                f"a wrong {said} of the {tank} gauge",
                f"The {tank} level's gauge has another {said} than its calibration says.",
                equation=f"reading of level_{tank}",
                separated_by="Read both gauges at two known levels.",
            )
            for what, said in (("gain", "gain"), ("offset", "zero"))
            for tank in ("upper", "lower")
        ),
    ],
)

# ---- the measurements ----------------------------------------------------------------------------

CASES = ("healthy", "leak", "overflow", "worn_outlet")
"""What can be wrong with the real tanks. No effect of MODEL describes an overflow."""
LEAK, WORN, RIM = 1.5e-6, 19.6e-6, 0.08
"""m^2, m^2 and m: as they really are where they act."""
STEP, HOLD = 1.0, 30.0
"""s between samples, and s for which the voltage is held"""


def measured(case: str, seed: int) -> list[own.Record]:
    """Five records of the real tanks: two to identify with, two to validate, one that decides nothing."""
    rng = np.random.default_rng([seed, CASES.index(case)])
    roles: tuple[own.Role, ...] = ("identify", "identify", "validate", "validate", "test")
    return [_record(case, f"run {i}", role, rng) for i, role in enumerate(roles, 1)]


def _record(case: str, name: str, role: own.Role, rng: np.random.Generator) -> own.Record:
    held = rng.uniform(3.0, 9.0, 20)
    held[2::4] = 0.0  # the pump is off now and then: what leaks does not ask the pump
    outlet_lower = WORN if case == "worn_outlet" else 17.7e-6
    leak = LEAK if case == "leak" else 0.0

    def rates(t: float, levels: NDArray[np.float64], volts: float) -> tuple[float, float]:
        first, second = np.sqrt(2.0 * GRAVITY * np.maximum(levels, 0.0))
        spilled = 0.4 * max(levels[0] - RIM, 0.0) ** 1.5 if case == "overflow" else 0.0
        gained = 3.32e-6 * volts - (17.9e-6 + leak) * first - spilled
        return gained / 15.5e-4, (17.9e-6 * first - outlet_lower * second) / 15.5e-4

    at, parts = rng.uniform(0.02, 0.1, 2), []
    for volts in held:  # one level of the voltage after the other, since it jumps
        instants = np.arange(0.0, HOLD + STEP, STEP)
        found = solve_ivp(
            rates, (0.0, HOLD), at, t_eval=instants, args=(volts,), rtol=1e-8, atol=1e-10
        )
        parts.append(found.y[:, :-1].T)
        at = found.y[:, -1]
    levels = np.concatenate(parts)
    noisy = levels + rng.normal(0.0, 0.4e-3, levels.shape)
    upper, lower = np.round(noisy / 1e-4).T * 1e-4  # the converter's step is 0.1 mm
    signals = {
        "time": STEP * np.arange(len(upper)),
        "pump_voltage": np.repeat(held, round(HOLD / STEP)),
        "level_upper": upper,
        "level_lower": lower,
    }
    return own.Record(name, role, signals)


def diagnose(case: str, seed: int = 1, empirical: bool = False) -> Diagnosis:
    """The whole thing: simulate the tanks, hand the records over, get the answer."""
    return own.diagnose_model(MODEL, measured(case, seed), 60.0, seed, empirical=empirical)


def main() -> None:
    parser = argparse.ArgumentParser(description="Two tanks in a row, diagnosed.")
    parser.add_argument("case", nargs="?", choices=CASES, help="all of them if left out")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--out", type=Path, help="folder for report.html and diagnosis.json")
    parser.add_argument("--empirical", action="store_true", help="carry an unknown's curve along")
    parser.add_argument("--picture", type=Path, help="file for the picture, which needs matplotlib")
    options = parser.parse_args()
    for case in (options.case,) if options.case else CASES:
        answer = diagnose(case, options.seed, options.empirical)
        print(f"{case}: {answer.verdict}. {answer.sentence}")
        for g in answer.gain if answer.causes else ():
            print(f"    {g.record} ({g.role}), {g.signal}: {-100.0 * g.reduction:+.0f} % error")
        for r in answer.free_run if answer.causes else ():
            if r.role == "test":
                sizes = f"{1e3 * r.baseline_rms:.2f} mm, now {1e3 * r.extended_rms:.2f} mm"
                print(f"    {r.record}, whole, {r.signal}: {sizes}")
        for p in answer.refitted:
            print(f"    beside it {p.name}: {p.old_value:.3g} -> {p.value:.4g} {p.unit}")
        for g in answer.empirical.gain if answer.empirical else ():
            print(
                f"    {g.record} ({g.role}), {g.signal}: {-100.0 * g.reduction:+.0f} % with the curve"
            )
        if options.out is not None:
            own.write_diagnosis(answer, options.out / case)
        if options.picture is not None:
            draw(answer, options.picture)


def draw(answer: Diagnosis, picture: Path) -> None:
    """The error of both levels on a record that was not fitted, as declared and with the causes."""
    import matplotlib.pyplot as plt  # noqa: PLC0415 (needed for the picture alone)

    shown = [s for s in answer.series if s.role == "validate"][:2]
    figure, axes = plt.subplots(len(shown), 1, figsize=(8, 5), sharex=True, layout="constrained")
    for axis, series in zip(axes, shown, strict=True):
        for label, model in (("as declared", series.baseline), ("extended", series.extended)):
            axis.plot(series.time, 1e3 * (series.measured - model), label=label)
        axis.set(ylabel=f"{series.signal}, error [mm]", title=f"{series.record}, not fitted")
    axes[0].legend()
    axes[-1].set(xlabel="time [s]")
    figure.savefig(picture)


if __name__ == "__main__":
    main()
