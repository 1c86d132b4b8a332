"""`sms identify actuator`: mass, dead volumes, mass-flow gain, heat ratios and friction from runs of the bench.

Every record is predicted window by window (multiple shooting: libsms/estimation/shooting.hpp, bench_plant.hpp) from
its command alone, and all parameters are fitted together to extension and pressures. See bench_fit.py for what is
asked of the records first, and for the errors.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from sms.callbacks import Progress
from sms.identification.bench_fit import BenchFit, fit_bench
from sms.identification.bench_records import load_bench
from sms.io.rig import Rig
from sms.views import Shown

ACTUATOR = (
    "moving_mass",
    "dead_volume_lower",
    "dead_volume_upper",
    "mass_flow_gain",
    "discharge_coefficient",
    "inflow_heat_ratio",
    "outflow_heat_ratio",
    "compression_heat_ratio",
    "valve_centre",
    "coulomb_force",
    "viscous_friction",
    "stiction_force",
    "stribeck_acceleration_factor",
)
"""What is identified, unless the rig file states it without doubt."""


@dataclass(frozen=True)
class BenchResult(Shown):
    """The answer of a fit of the bench, for a page and for files."""

    subject: str
    """What was asked for: "actuator" or "spool"."""
    title: str
    rig: str
    fit: BenchFit
    asked: tuple[str, ...]
    """The parameters that the question is about; others were fitted beside them."""


def identify_actuator(
    path: Path,
    huber: float = 0.0,
    starts: int = 1,
    progress: Progress = lambda text, done: None,
) -> BenchResult:
    """Fit the actuator to a rig of kind "bench". InputError says what is wrong with it."""
    records = load_bench(path, "actuator")
    wanted = wanted_of(records.rig)
    fit = fit_bench(records, wanted, huber, starts, progress)
    return BenchResult("actuator", records.rig.title, path.name, fit, wanted)


def wanted_of(rig: Rig) -> tuple[str, ...]:
    """What of ACTUATOR the rig's valve law has, and what the rig file asks for beside it."""
    other = "mass_flow_gain" if rig.model.valve == "classic" else "discharge_coefficient"
    asked = [n for n, d in rig.parameters.items() if d.fit and n not in ACTUATOR]
    return (*(n for n in ACTUATOR if n != other), *asked)
