"""A ventilator breathes into a test lung: the plant as a model of one's own (docs/own_model.md), and its records.

A test lung is a bellows against a spring, its compliance C set by the spring's place, behind a resistor of a set
number. Flow goes through the resistor, whose drop is linear plus quadratic in it; what has gone in loads the spring:

    dV/dt = flow(airway pressure - V / C)        drop = D (share (q/q0) + (1 - share) (q/q0) |q/q0|),  q0 = 0.5 l/s

Pressures are above the end-expiratory one, which is the lower set point, and V is counted from there. The ventilator's
volume is its flow reading, integrated: it holds what compresses in the hoses, drifts with the zero of that reading, and
begins each breath where it is put. So its zero is a second state, free at the start of every window; an end-expiratory
pressure that is off by a little is the same shift. The records are text files of the RespiraWorks project: time [s],
set point and pressure [cmH2O], volume [ml].
"""

from __future__ import annotations

import gzip
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from sms.arrays import Array
from sms.diagnosis import own
from sms.errors import InputError

CMH2O, ML = 98.0665, 1e-6
"""Pa, m^3"""
ML_PER_CMH2O = ML / CMH2O
"""m^3/Pa"""
REFERENCE_FLOW = 0.5e-3
"""m^3/s, at which a resistor's drop is stated: half a litre a second, mid-range in these tests."""
WINDOW = 1.6
"""s: four to a quarter; two to thirty time constants of lung and resistor, a third to a half of a breath."""
STRETCHES: tuple[own.Role, ...] = ("identify", "validate", "identify", "validate")
"""Of a record's quarters: a few breaths each, so that what drifts reaches both roles. Initial states are free, so a cut
within a breath costs nothing."""
SPRING, RESISTOR, READING = "spring of the lung", "flow through the resistor", "reading of volume"


@dataclass(frozen=True)
class Setting:
    """What is set at a test lung by hand."""

    compliance: float
    """ml/cmH2O"""
    resistor: int
    """The maker's number, about cmH2O s/l."""

    def __str__(self) -> str:
        return f"C {self.compliance:g}, R {self.resistor}"


@dataclass(frozen=True)
class Known:
    """A number of the rig as it is known before a record is judged: value and half width. SI."""

    value: float
    half_width: float


TESTS = {
    1: Setting(50, 5),
    2: Setting(50, 20),
    3: Setting(20, 5),
    4: Setting(20, 20),
    5: Setting(20, 20),
    6: Setting(20, 50),
    7: Setting(10, 50),
    8: Setting(10, 10),
}
"""Number of the test -> what its protocol sets."""
RUN_OTHERWISE = {"wrong_resistor_pc_4": Setting(20, 5)}
"""Records whose folder says that the protocol was not kept."""


@dataclass(frozen=True, eq=False)
class Test:
    """One record of the test lung, and how the lung was really set."""

    name: str
    """As the file: air1_pc_4."""
    day: str
    truth: Setting
    time: Array
    """s"""
    set_point: Array
    """Pa"""
    pressure: Array
    """Pa, at the airway"""
    volume: Array
    """m^3, as the ventilator has it"""

    @property
    def records(self) -> list[own.Record]:
        """Quarters by role, in turn."""
        edges = [k * len(self.time) // len(STRETCHES) for k in range(len(STRETCHES) + 1)]
        return [
            own.Record(
                f"{self.name} {self.time[a]:.0f} to {self.time[b - 1]:.0f} s",
                role,
                {n: v[a:b] for n, v in self._signals.items()},
            )
            for role, a, b in zip(STRETCHES, edges[:-1], edges[1:], strict=True)
        ]

    @property
    def whole(self) -> own.Record:
        """All of it as one record."""
        return own.Record(self.name, "test", self._signals)

    @property
    def _signals(self) -> dict[str, Array]:
        lower = float(self.set_point.min())
        return {
            "time": self.time,
            "airway_pressure": self.pressure - lower,
            "volume": self.volume,
        }


def read_tests(folder: Path) -> list[Test]:
    """Every DAY_pc_N.dat.gz of a folder. InputError for a file that is none."""
    return [_read(path) for path in sorted(folder.glob("*_pc_*.dat.gz"))]


def _read(path: Path) -> Test:
    name = path.name.removesuffix(".dat.gz")
    found = re.fullmatch(r"(.+)_pc_(\d+)", name)
    if found is None or int(found[2]) not in TESTS:
        raise InputError(f"{path}: its name is none of DAY_pc_N.dat.gz with N from 1 to 8")
    try:
        with gzip.open(path, "rt", encoding="utf-8") as lines:
            rows = [line.split() for line in lines if line.strip() and not line.startswith("#")]
        table = np.array(rows[1:], dtype=np.float64).T
    except (OSError, ValueError) as problem:
        raise InputError(f"{path}: this is no record of the test lung ({problem})") from None
    if not rows or rows[0] != ["time(sec)", "pc_setpoint", "pressure", "volume"]:
        raise InputError(
            f"{path}: the columns are not time(sec), pc_setpoint, pressure and volume; check the file"
        )
    time, set_point, pressure, volume = table
    even = np.linspace(time[0], time[-1], len(time))
    truth = RUN_OTHERWISE.get(name, TESTS[int(found[2])])
    return Test(name, found[1], truth, even, CMH2O * set_point, CMH2O * pressure, ML * volume)


# ---- the equations ---------------------------------------------------------------------------------


def derivative(p: own.Values, x: Array, u: Array) -> Sequence[Array]:
    """Rates of the lung's volume and of the volume reading's zero, m^3/s."""
    recoil = x[0] / p.compliance
    drop = (u[0] - recoil) / p.resistor_drop
    share = p.linear_share
    flow = 2.0 * drop / (share + np.sqrt(share**2 + 4.0 * (1.0 - share) * np.abs(drop)))
    leak = p.leak * recoil
    return REFERENCE_FLOW * flow - leak, leak + p.flow_zero


def output(p: own.Values, x: Array, u: Array) -> Sequence[Array]:
    """The ventilator's volume, m^3."""
    return [(1.0 + p.volume_gain) * (x[0] + x[1] + p.circuit_compliance * u[0])]


EFFECTS = (
    own.Effect(
        "compliance",
        "compliance",
        "another compliance of the test lung",
        "The spring is set to another compliance than declared.",
        equation=SPRING,
        separated_by="Hold a pressure until the flow has ceased, and read the volume.",
    ),
    own.Effect(
        "resistor",
        "resistor_drop",
        "another resistor",
        "The resistor has another drop than the declared one: another one was put in.",
        equation=RESISTOR,
        separated_by="Measure the drop at a constant flow.",
    ),
    own.Effect(
        "leak",
        "leak",
        "a leak of the lung",
        "Gas leaves the lung behind the resistor, in proportion to its pressure.",
        equation=RESISTOR,
        separated_by="Hold a pressure and watch the flow that remains.",
    ),
    own.Effect(
        "volume_gain",
        "volume_gain",
        "a wrong gain of the volume",
        "The ventilator's flow sensor has another gain than its calibration says.",
        equation=READING,
        separated_by="Give a known volume with a calibration syringe.",
    ),
    own.Effect(
        "circuit_compliance",
        "circuit_compliance",
        "another compliance of the hoses",
        "More or less gas than declared is compressed in the hoses between flow sensor and resistor.",
        equation=READING,
        separated_by="Close the hose before the resistor and give a known volume.",
    ),
)


def model(known: Mapping[str, Known], noise: float) -> own.Model:
    """The test lung as it is declared: `known` has every parameter but those that are neutral unless they are named."""

    def declared(name: str, unit: str, lower: float, upper: float) -> own.Parameter:
        k = known.get(name, Known(0.0, 0.0))
        value = float(np.clip(k.value, lower, upper))
        return own.Parameter(name, unit, lower, value, upper, uncertainty=k.half_width)

    volume = 20.0 * ML
    return own.Model(
        title="Test lung",
        states=[
            own.State("lung_volume", "m^3", scale=volume, equation=RESISTOR),
            own.State("volume_zero", "m^3", scale=volume),
        ],
        inputs=[own.Input("airway_pressure", "Pa")],
        outputs=[own.Output("volume", "m^3", noise=noise)],
        parameters=[
            declared("compliance", "m^3/Pa", 2.0 * ML_PER_CMH2O, 200.0 * ML_PER_CMH2O),
            declared("resistor_drop", "Pa", 0.3 * CMH2O, 100.0 * CMH2O),
            declared("linear_share", "1", 0.02, 0.98),
            declared("circuit_compliance", "m^3/Pa", -1.0 * ML_PER_CMH2O, 5.0 * ML_PER_CMH2O),
            declared("flow_zero", "m^3/s", -100.0 * ML, 100.0 * ML),
            declared("leak", "m^3/(s Pa)", 0.0, 10.0 * ML_PER_CMH2O),
            declared("volume_gain", "1", -0.3, 0.3),
        ],
        derivative=derivative,
        output=output,
        effects=EFFECTS,
        guess=lambda signals: {"lung_volume": signals["volume"]},
    )
