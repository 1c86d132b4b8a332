"""What can be hidden, where it sits and how large it may get.

Three sorts:
- an extra term, zero on a healthy machine: it gets `multiple` times its detection limit;
- a declared number that is off: it is moved beyond its declared half width by as much;
- a term that has no small size (a seal that bends, a wall that heats): it is drawn from a range.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from validation.twins.truth import Truth

RIGS = ("bench", "platform", "tank")
AXIS = ("bench", "platform")
ALL = RIGS


@dataclass(frozen=True)
class Effect:
    """One drawable effect."""

    id: str  #: the catalogue's
    names: tuple[str, ...]  #: numbers of the truth that carry it, all with the same value
    unit: str
    rigs: tuple[str, ...]
    largest: float  #: beyond it the machine is broken, not ill
    target: str | None = None  #: a signal or a side
    signed: bool = False  #: either sign is physical; without it the value is positive
    falls: bool = False  #: the value is negative
    shifts: bool = False  #: a declared number is off
    drawn_from: tuple[float, float] | None = None  #: no small size
    first_step: float = 0.0  #: size with which its limit is looked for

    @property
    def key(self) -> str:
        """Unique name: the id, with its target after a colon."""
        return self.id if self.target is None else f"{self.id}:{self.target}"

    @property
    def sense(self) -> float:
        """Sign of a value whose sign is not free."""
        return -1.0 if self.falls else 1.0

    def hidden_in(self, truth: Truth, value: float) -> Truth:
        """The truth with this effect of a signed size; a shift is added, a term set."""
        values = {name: value + (truth.value(name) if self.shifts else 0.0) for name in self.names}
        return truth.having(**values)


NONE = Effect("none", (), "1", ALL, 0.0)


def _term(
    id_: str, name: str, unit: str, largest: float, first_step: float, **more: object
) -> Effect:
    options = {"rigs": AXIS, **more}
    return Effect(id_, (name,), unit, largest=largest, first_step=first_step, **options)  # type: ignore[arg-type]


def _shift(
    id_: str, name: str, unit: str, largest: float, first_step: float, **more: object
) -> Effect:
    options = {"signed": True, **more}
    return _term(id_, name, unit, largest, first_step, shifts=True, **options)


def _sensors(id_: str, field: str, unit_of: Callable[[str], str], **sizes: float) -> list[Effect]:
    """One effect a signal; `sizes` maps signal to its first step, a thirtieth of the largest."""
    found = []
    for signal, step in sizes.items():
        rigs = tuple(rig for rig in RIGS if signal in SIGNALS[rig])
        found.append(
            Effect(
                id_,
                (f"{signal}.{field}",),
                unit_of(signal),
                rigs,
                30.0 * step,
                target=signal,
                signed=field in ("gain", "offset"),
                first_step=step,
            )
        )
    return found


SIGNALS = {
    "bench": (
        "extension",
        "chamber_pressure_lower",
        "chamber_pressure_upper",
        "supply_pressure",
    ),
    "platform": (
        *(f"extension_{i}" for i in (1, 2, 3)),
        *(f"chamber_pressure_lower_{i}" for i in (1, 2, 3)),
        *(f"chamber_pressure_upper_{i}" for i in (1, 2, 3)),
        "supply_pressure",
        "roll",
        "pitch",
    ),
    "tank": ("tank_pressure", "tank_temperature", "supply_pressure"),
}
UNITS = {"ex": "m", "ch": "Pa", "su": "Pa", "ro": "rad", "pi": "rad"}


def unit_of(signal: str) -> str:
    """SI unit of a signal."""
    return {"tank_pressure": "Pa", "tank_temperature": "K"}.get(signal, UNITS.get(signal[:2], "1"))


def _dimensionless(_signal: str) -> str:
    return "1"


def _seconds(_signal: str) -> str:
    return "s"


CATALOGUE: tuple[Effect, ...] = (
    _term("presliding", "bristle_compliance", "m/N", 5e-5, 5e-6, drawn_from=(4e-6, 2.5e-5)),
    _term("valve_leakage", "valve_leakage", "m^3/(s Pa)", 2e-9, 2e-11, rigs=ALL),
    _term("piston_leakage", "piston_leakage", "kg/(s Pa)", 2e-8, 2e-10),
    _term(
        "fitting_leakage",
        "fitting_leakage_lower",
        "kg/(s Pa)",
        1e-8,
        1e-10,
        rigs=ALL,
        target="lower",
    ),
    _term("fitting_leakage", "fitting_leakage_upper", "kg/(s Pa)", 1e-8, 1e-10, target="upper"),
    _shift("spool_lag", "valve_frequency", "Hz", 45.0, 5.0, signed=False, falls=True),
    _term("command_delay", "command_delay", "s", 0.05, 5e-4, rigs=ALL),
    _term("dead_band_width", "dead_band_change", "V", 0.3, 0.01, rigs=ALL, signed=True),
    _shift("valve_centre_offset", "valve_centre", "V", 0.4, 0.01, rigs=ALL),
    _shift("flow_conductance", "mass_flow_gain", "1", 0.8, 0.01, rigs=ALL),
    _term("exhaust_restriction", "exhaust_flow_change", "1", 0.6, 0.01, rigs=ALL, signed=True),
    _term("supply_droop", "supply_line_resistance", "Pa s/kg", 1e7, 1e5, rigs=ALL),
    _shift("supply_setpoint", "supply_pressure", "Pa", 80e3, 1e3, rigs=ALL),
    _shift("dead_volume", "dead_volume_lower", "m^3", 4e-4, 2e-6, target="lower", signed=False),
    _shift("dead_volume", "dead_volume_upper", "m^3", 4e-4, 2e-6, target="upper", signed=False),
    _shift(
        "dead_volume", "tank_volume", "m^3", 2e-3, 2e-5, rigs=("tank",), target="tank", signed=False
    ),
    _term("tube", "tube_length", "m", 10.0, 0.05),
    _shift("polytropic_index", "compression_heat_ratio", "1", 0.17, 5e-3),
    _term(
        "heat_transfer",
        "heat_transfer_coefficient",
        "W/(m^2 K)",
        200.0,
        30.0,
        rigs=ALL,
        drawn_from=(10.0, 80.0),
    ),
    _term("pressure_dependent_friction", "pressure_friction", "N/Pa", 4e-4, 2e-6, signed=True),
    _term("direction_dependent_friction", "direction_friction", "N", 30.0, 0.5, signed=True),
    _term("friction_lag", "friction_lag", "s", 0.2, 2e-3),
    _term("position_dependent_friction", "position_friction", "1/m", 10.0, 0.1, signed=True),
    _shift("viscous_friction", "viscous_friction", "N s/m", 450.0, 10.0),
    _shift("coulomb_friction", "coulomb_force", "N", 34.0, 1.0),
    _term("exponential_friction", "exponential_friction_force", "N", 60.0, 0.3),
    _term("end_cushioning", "cushion_damping", "N s/m", 3e4, 50.0),
    _shift("moving_mass", "moving_mass", "kg", 40.0, 0.3, rigs=("bench",), signed=False),
    _shift("moving_mass", "payload_mass", "kg", 60.0, 2.0, rigs=("platform",)),
    _shift("centre_of_gravity", "payload_cog_x", "m", 0.3, 3e-3, rigs=("platform",), target="x"),
    _shift("centre_of_gravity", "payload_cog_y", "m", 0.3, 3e-3, rigs=("platform",), target="y"),
    _shift("centre_of_gravity", "payload_cog_z", "m", 0.5, 2e-2, rigs=("platform",), target="z"),
    _term("panhard_friction", "panhard_friction", "N m s/rad", 1e3, 20.0, rigs=("platform",)),
    _term("backlash", "backlash", "m", 5e-3, 1e-4),
    _term("frame_compliance", "frame_compliance", "m/N", 1e-5, 1e-7),
    _shift("ambient_pressure", "ambient_pressure", "Pa", 16e3, 300.0, rigs=ALL),
    *_sensors(
        "sensor_gain",
        "gain",
        _dimensionless,
        extension=2e-3,
        chamber_pressure_lower=2e-3,
        chamber_pressure_upper=2e-3,
        tank_pressure=1e-3,
        extension_1=2e-3,
        chamber_pressure_lower_2=2e-3,
        roll=3e-3,
    ),
    *_sensors(
        "sensor_offset",
        "offset",
        unit_of,
        extension=1e-4,
        chamber_pressure_lower=300.0,
        chamber_pressure_upper=300.0,
        tank_pressure=300.0,
        tank_temperature=0.2,
        extension_2=1e-4,
        chamber_pressure_upper_3=300.0,
        pitch=3e-4,
    ),
    *_sensors(
        "sensor_lag",
        "lag",
        _seconds,
        extension=1e-3,
        chamber_pressure_lower=1e-3,
        chamber_pressure_upper=1e-3,
        tank_pressure=2e-3,
        tank_temperature=2e-2,
        extension_3=1e-3,
        roll=2e-3,
    ),
    Effect(
        "clock_skew",
        ("extension.skew",),
        "s",
        ("bench",),
        0.3,
        target="extension",
        signed=True,
        first_step=1e-3,
    ),
    Effect(
        "clock_skew",
        ("chamber_pressure_lower.skew", "chamber_pressure_upper.skew", "supply_pressure.skew"),
        "s",
        ("bench",),
        0.3,
        target="chamber_pressure",
        signed=True,
        first_step=1e-3,
    ),
    Effect(
        "clock_skew",
        tuple(f"extension_{i}.skew" for i in (1, 2, 3)),
        "s",
        ("platform",),
        0.3,
        target="extension",
        signed=True,
        first_step=1e-3,
    ),
    Effect(
        "clock_skew",
        ("roll.skew", "pitch.skew"),
        "s",
        ("platform",),
        0.3,
        target="attitude",
        signed=True,
        first_step=1e-3,
    ),
)
"""What a trial draws from, beside `NONE`."""

OUT_OF_CATALOGUE: tuple[Effect, ...] = (
    _term("clogging_silencer", "clogging_silencer", "1", 0.8, 0.02, rigs=ALL),
    _term("bent_rod", "bent_rod", "N", 150.0, 1.0),
    _term("scratched_bore", "scratched_bore", "N", 200.0, 2.0),
    _term("warming_grease", "warming_grease", "N", 150.0, 2.0),
    _term("pulsating_supply", "pulsating_supply", "Pa", 60e3, 500.0, rigs=ALL),
    _term("sticky_spool", "sticky_spool", "V", 0.3, 0.01, rigs=ALL),
    _term("dragging_cable", "dragging_cable", "N/m", 2e3, 10.0),
    _term("check_valve_leak", "check_valve_leak", "kg/(s Pa)", 5e-8, 5e-10, rigs=ALL),
)
"""No catalogue entry describes these: the right verdict is `unknown`."""

GEOMETRY: tuple[Effect, ...] = (
    *(
        _shift(
            "joint_position",
            f"{joint}_error",
            "m",
            0.02,
            1e-3,
            rigs=("platform",),
            target=joint,
            drawn_from=(0.012, 0.02),  # below it, a machine 2 percent off hides it
        )
        for joint in ("base_joint_2_y", "platform_joint_1_x", "base_joint_5_z")
    ),
    *(
        _shift("link_length", name, "m", 0.01, 1e-3, rigs=("platform",), target=target)
        for name, target in (
            ("actuator_3_length_error", "actuator_length_offset_3"),
            ("panhard_2_length_error", "panhard_length_offset_2"),
        )
    ),
)
"""Of the catalogue, but drawn on request only, so that the seeds of CATALOGUE stay what they are."""

EVERY = (NONE, *CATALOGUE, *GEOMETRY, *OUT_OF_CATALOGUE)


def on(rig: str, effects: tuple[Effect, ...] = EVERY) -> list[Effect]:
    """Those that a rig can have."""
    return [effect for effect in effects if rig in effect.rigs]


def find(rig: str, name: str) -> list[Effect]:
    """All effects of a rig called `name` (id, or id:target); raises `ValueError` for none."""
    found = [effect for effect in on(rig) if name in (effect.id, effect.key)]
    if not found:
        names = ", ".join(sorted({effect.id for effect in on(rig)}))
        raise ValueError(f"a {rig} has no effect '{name}' to hide; choose one of: {names}")
    return found
