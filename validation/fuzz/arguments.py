"""Arguments that are right: of the shape the docstring asks for, within what a machine does, with names that exist.

The argument's name says what it is, as everywhere in the project; a table of quantities gives its range. What a new
function calls by a new name is drawn between one and two, and the table at the end of a run lists the function if that
never got an answer.
"""

from __future__ import annotations

import ast
import ctypes
import re
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from validation.fuzz.mutations import Random, pick
from validation.fuzz.signatures import Function

Array = NDArray[np.float64]
Values = dict[str, Any]

QUANTITIES = (  # the first that is found in an argument's name
    ("pressure|^supply$", 1.5e5, 6e5), ("temperature|cold_junction", 285.0, 305.0), ("extension_rate", -0.1, 0.1),
    ("extension_acceleration|acceleration|qddot", -1.0, 1.0), ("extension|setpoint|length", 0.12, 0.28),
    ("velocity_gain", 0.2, 1.0), ("natural_frequency", 20.0, 60.0), ("damping_ratio", 0.2, 0.9),
    ("velocity", -0.1, 0.1), ("voltage|command|opening", 3.5, 6.5), ("conductance", 1e-9, 1e-8),
    ("critical_ratio", 0.2, 0.5), ("area", 1e-6, 1e-5), ("spool|position$", -5e-4, 5e-4),
    ("flow|inflow|drawn", -5e-3, 5e-3), ("height", 0.49, 0.51),
    ("roll|pitch|qdot|twist|error|noise$|draws|deflection", -2e-2, 2e-2), ("drive|rod_force|load", -50.0, 50.0),
    ("force", 100.0, 200.0), ("stiffness", 1e3, 1e4), ("damping$", 10.0, 100.0), ("wrench|moment", -5.0, 5.0),
)  # fmt: skip
NUMBERS = {
    "tolerance": (1e-5, 1e-4), "window": (0.1, 0.3), "longest_step": (1e-3, 2.5e-3),
    "longest_step_elsewhere": (2e-3, 5e-3),
    "huber": (0.0, 3.0), "limit": (1.0, 5.0), "characteristic_length": (0.0, 1.0), "mean_pressure": (3e5, 3.5e5),
    "load_force": (-10.0, 10.0), "position_noise": (0.0, 1.0), "pressure_noise": (0.0, 1.0), "noise": (0.0, 1e-3),
}  # fmt: skip
COUNTS = {
    "masses": 4, "reset_cause": 3, "periods": 6, "leg": 3, "status": 5, "converted": 4096, "window": 1,
    "identifier": 0x200, "challenge": 256, "missed_ticks": 3, "length_is": 1, "seed": 2**16,
    "nonce": 2**63, "counter": 2**31,
}  # fmt: skip
SIZES = {"converted": 10, "length_is": 6, "fixed_length": 6, "frames": 2, "records": 1,
         "states": 2, "rates": 2, "inputs": 1, "outputs": 1}  # fmt: skip
SHAPES = {  # what a docstring does not say in front of "->"
    "BenchSimulation.advance": {"setpoint": 1, "noise": 1, "load": 1},
    "TankSimulation.advance": {"setpoint": 1, "noise": 1, "load": 1},
    "PlatformSimulation.advance": {"setpoint": 3, "noise": 3, "load": 6},
    "ParallelMechanism()": {"base": 3, "platform": 3, "normal": 3},
    "PlatformBody()": {"inertia": 3},
    "PoseProblem()": {"extension": 3, "pose": 6},
} | {f"FmuCalls.{name}": {"x": 2, "u": 1}
     for name in ("rates", "readings", "rate_slopes", "reading_slopes")}  # fmt: skip
VALVE = ("iso_0_4_mpa", "iso_0_2_mpa", "classic")
FRICTION = ("acceleration_dependent", "two_branch", "stribeck", "dahl", "lugre")
CHAMBER = ("polytropic", "energy")
WORDS = {
    "valve": VALVE, "valve_law": VALVE, "law": VALVE[:2], "friction": FRICTION, "friction_law": FRICTION,
    "chambers": CHAMBER, "chamber_law": CHAMBER, "heat": CHAMBER, "chamber": ("lower", "upper"),
    "control": ("open_loop", "pid", "state_feedback"), "hold": ("linear", "previous", "stepped"),
    "rounding": ("nearest", "down"),
    "characters": ("", "status\r", "?"), "message": ("a sentence of its own",),
}  # fmt: skip
FAULTS = ("sensor_broken", "sensor_stuck", "sensor_jump", "valve_stuck", "supply_lost", "enable_open",
          "bus_off", "loop_overrun", "hang")  # fmt: skip
LAWS = {  # where "law" is another one
    "CylinderProblem": FRICTION, "force_balance": FRICTION, "TankProblem": ("iso", "classic"),
    "SpoolProblem": ("cubic", "linear"), "BenchLoopProblem": ("pid", "state_feedback"),
    "PlatformLoopProblem": ("pid", "state_feedback"),
}  # fmt: skip
FRAMES = ("Status", "Event", "Extension", "Attitude", "LinkStatistics", "ParameterConfirm", "CaptureStatus",
          "SessionNonce", "ModeRequest")  # fmt: skip
FREE = ("mass_flow_gain", "coulomb_force", "viscous_friction", "tank_volume", "bore_diameter", "valve_frequency",
        "component_conductance", "spool_cubic_1", "command_delay", "sensor_lag_extension")  # fmt: skip
JOINTS = ("base_joint_1_x", "platform_joint_2_z", "actuator_length_offset_1", "base_joint_4_z")
NOISE = {"extension": 1e-3, "chamber_pressure_lower": 1e3, "chamber_pressure_upper": 1e3, "supply_pressure": 1e3,
         "roll": 1e-3, "pitch": 1e-3, "tank_pressure": 1e3, "tank_temperature": 0.5, "valve_command": 0.1}  # fmt: skip
ADDRESSES = ("instance", "set_states", "set_values", "get_rates", "get_values", "get_directional")
"""Of functions, as an FMU gives them: whoever hands on a wrong one asks for what it does. Never spoilt."""
SLOW = ("control_period",)
"""Parameters that are left as they are: at their least, a millionth of a second, a call takes minutes, as it must."""
LARGE = 25_000  #: rows, which more than one thread shares (rows.hpp)


_OF_AN_FMU = ctypes.CFUNCTYPE(ctypes.c_int)(lambda: 0)
"""Stands for each function of one: its status is OK, whatever it was given."""


class Arguments:
    """What functions are called with, drawn by one generator."""

    def __init__(self, core: ModuleType, functions: Iterable[Function], random: Random) -> None:
        self.core, self.random = core, random
        self.makers: dict[str, list[Function]] = defaultdict(list)
        self.spoil: Callable[[Function, Values], None] | None = None
        """What may be done to the arguments of an object that is one itself; it is made anew where that is refused."""
        for function in functions:
            for name in function.returns:
                for base in getattr(core, name).__mro__:
                    if base.__module__ == core.Params.__module__:
                        self.makers[base.__name__].append(function)

    def of(self, function: Function, rows: int | None = None) -> Values:
        """Arguments by their names, those with a default not always. rows: of every array, drawn if None."""
        return _Call(self, function, rows).values()

    def instance(self, name: str, depth: int = 0) -> Any:
        """An object of the class `name`."""
        if name in ("Params", "LegParams"):
            return self.machine(name)
        makers = self.makers[name]
        direct = [m for m in makers if m.kind == "make"]
        maker = pick(direct or makers, self.random)
        if maker.kind == "read":
            given = [
                getattr(self.instance(maker.owner or "", depth + 1), a) for a in maker.attributes
            ]
            found = [one for one in _flat(given) if isinstance(one, getattr(self.core, name))]
            if not found:
                raise ValueError(f"this {maker.owner} holds no {name}")
            return pick(found, self.random)
        for _ in range(3):
            values = self.of(maker)
            if self.spoil is not None and self.random.uniform() < 0.15:
                self.spoil(maker, values)
            with suppress(Exception):
                return next(_flat(self.call(maker, values, depth)))
        return next(_flat(self.call(maker, self.of(maker), depth)))

    def call(self, function: Function, values: Values, depth: int = 0) -> Any:
        """What a function gives, of a fresh object if it is a method."""
        if function.kind == "make":
            return called(getattr(self.core, function.owner or ""), function, values)
        owner = self.core if function.owner is None else self.instance(function.owner, depth + 1)
        return called(getattr(owner, function.name), function, values)

    def machine(self, name: str) -> Any:
        """Parameters, up to three of them anywhere within their bounds, or at one."""
        params = self.core.Params()
        table = self.core.parameter_table()
        for _ in range(max(0, int(self.random.integers(-2, 4)))):
            info = pick([one for one in table if one.name not in SLOW], self.random)
            share = pick((0.0, 1.0, self.random.uniform()), self.random)
            params[info.name] = min(info.upper, info.lower + share * (info.upper - info.lower))
        return self.core.LegParams(params) if name == "LegParams" else params


class _Call:
    """The arguments of one call, which have their number of rows and their step of time in common."""

    def __init__(self, of: Arguments, function: Function, rows: int | None) -> None:
        self.of, self.function, self.random = of, function, of.random
        record = function.kind == "make"
        self.rows = int(self.random.integers(20, 60) if record else self.random.integers(0, 9))
        self.rows = self.rows if rows is None else rows
        self.step = float(pick((1e-3, 5e-3), self.random))
        self.frame = FRAMES[0]
        in_front, arrow, _ = function.doc.partition("->")
        self.widths = re.findall(r"\([nk](?:, (\w+))?,?\)", in_front) if arrow else []

    def values(self) -> Values:
        with_signals = (
            self.random.uniform() < 0.7
        )  # all that a record may have, or what it must have
        return {
            a.name: self.value(a.type, a.name)
            for a in self.function.arguments
            if not a.has_default
            or (with_signals if "ArrayLike" in ast.unparse(a.type) else self.random.integers(2))
        }

    def value(  # noqa: PLR0912 (a case a type)
        self, kind: ast.expr, name: str
    ) -> Any:
        match kind:
            case ast.Name("float"):
                return self.number(name)
            case ast.Name("int"):
                return self.count(name)
            case ast.Name("bool"):
                return bool(self.random.integers(2))
            case ast.Name("str"):
                return self.word(name)
            case ast.Name("bytes"):
                return self.random.bytes(int(pick((0, 16), self.random)) if name == "key" else 8)
            case ast.Name("kwargs"):
                return {"coulomb_force": 20.0}
            case ast.Name("dict"):
                return self.of.core.unpack_frame(self.frame, bytes(8)) or {}
            case ast.Attribute(attr=owner):
                return self.of.instance(owner)
            case ast.BinOp() if name == "state":
                another = self.random.uniform() < 0.3
                return self.of.instance(self.function.owner or "").state if another else None
            case ast.BinOp(left=other):
                return None if self.random.integers(2) else self.value(other, name)
            case ast.Subscript(slice=ast.Tuple(elts=[ast.Attribute(attr="ArrayLike"), *rest])):
                form = next((str(r.value) for r in rest if isinstance(r, ast.Constant)), "")
                return self.array(name, form)
            case ast.Subscript(slice=ast.Tuple(elts=[ast.Subscript() as inner, ast.Constant()])):
                return self.sequence(inner, name)
            case ast.Subscript(value=ast.Attribute(attr="Sequence")):
                return self.sequence(kind, name)
            case ast.Subscript(value=ast.Attribute(attr="Mapping")):
                return self.mapping(name)
            case ast.Subscript(value=ast.Name("tuple"), slice=ast.Tuple(elts=parts)):
                return tuple(self.value(part, name) for part in parts)
        raise NotImplementedError(f"{self.function.label}: {name} is {ast.unparse(kind)}")

    def sequence(self, kind: ast.Subscript, name: str) -> list[Any]:
        if name == "free":
            return self.free(isinstance(kind.slice, ast.Subscript))
        if name == "driven":
            return [0, 1, 2, 3, 4, 5]
        if name == "q":
            return [0.0, 0.0, self.number("height")]
        if name == "channels":
            readings = self.of.instance(self.function.owner or "").readings
            return [
                self.of.instance(kind.slice.attr)
                for _ in readings
                if isinstance(kind.slice, ast.Attribute)
            ]
        return [self.value(kind.slice, name) for _ in range(SIZES.get(name, 3))]

    def free(self, with_bounds: bool) -> list[Any]:
        names = JOINTS if self.function.name == "calibrate" else FREE
        chosen = [str(n) for n in self.random.choice(names, 2, replace=False)]
        table = {info.name: info for info in self.of.core.parameter_table()}
        return [(n, table[n].lower, table[n].upper, 0.0) for n in chosen] if with_bounds else chosen

    def number(self, name: str) -> float:
        if name in ("step", "dt"):
            return self.step
        low, high = NUMBERS.get(name) or next(
            ((low, high) for pattern, low, high in QUANTITIES if re.search(pattern, name)),
            (1.0, 2.0),
        )
        return float(self.random.uniform(low, high))

    def count(self, name: str) -> int:
        if name in ADDRESSES:
            return int(ctypes.cast(_OF_AN_FMU, ctypes.c_void_p).value or 0)
        if name in ("version", "knots", "threads"):
            return int(self.random.integers(1 if name == "threads" else 2, 4))
        return int(self.random.integers(COUNTS.get(name, 3)))

    def word(self, name: str) -> str:
        label, owner = self.function.label, self.function.owner
        if name == "law":
            return str(pick(LAWS.get(owner or label, VALVE[:2]), self.random))
        if label.endswith("_frame"):
            self.frame = pick(FRAMES, self.random)
            return self.frame
        if label.endswith("_fault"):
            return pick(FAULTS, self.random)
        return str(pick(WORDS.get(name, FREE[:3]), self.random))

    def mapping(self, name: str) -> dict[str, float]:
        if name == "noise":
            legs = {f"{key}_{leg}": size for key, size in NOISE.items() for leg in (1, 2, 3)}
            return NOISE | legs
        if name == "settings":
            settings = self.of.core.firmware_settings()
            return {one.name: one.default for one in settings[: int(self.random.integers(3))]}
        return pick(({}, {"supply_pressure": 1e3}, {"payload_mass": 0.5}), self.random)

    def array(self, name: str, form: str) -> Array:
        """form: as pybind11 writes the shape of an Eigen matrix, or nothing for an array of any shape."""
        if self.function.owner == "ParallelMechanism" and self.function.kind == "make":
            return self.joints(name)
        if name == "tolerance":
            return np.full(2, 1e-3)
        if name.endswith("_marks"):
            return np.zeros((0, 3))
        if name.endswith("_noise"):
            return np.full(3 if name.startswith("extension") else 6, 1e-3)
        if name == "weight" and self.random.integers(4):
            return np.zeros(0)
        if name == "time":
            return self.step * np.arange(float(self.rows))
        if name == "inertia":
            return 0.1 * np.eye(3)
        return self.drawn(name, self.shape(name, form))

    def shape(self, name: str, form: str) -> tuple[int, ...]:
        if form == "[m, 1]":
            return (self.rows,)
        if self.function.name == "record":
            simulation = self.of.instance(self.function.owner or "")
            return (self.rows, len(simulation.columns if name == "rows" else simulation.readings))
        if self.function.label in SHAPES:
            return (self.rows, SHAPES[self.function.label].get(name, 3))
        if form:
            return (self.rows, 3)
        if self.widths:
            arrays = [a.name for a in self.function.arguments if "ArrayLike" in ast.unparse(a.type)]
            k = min(arrays.index(name), len(self.widths) - 1)
            width = self.widths[k]
            return (self.rows, int(width) if width.isdigit() else 6) if width else (self.rows,)
        any_shape = re.search(r"\(n,\)", self.function.doc) is None and self.random.integers(4) == 0
        return () if any_shape else (self.rows,)

    def drawn(self, name: str, shape: tuple[int, ...]) -> Array:
        if name in ("pose", "coordinates", "start", "q", "at_rest", "rectangle", "direction"):
            centre = np.array({"q": [0.0, 0.0, 0.5], "rectangle": [0.5, 0.1, 0.1], "at_rest": [0.1, 0.1, 0.5],
                               "direction": [0.5, 1.0, 0.0]}.get(name, [0.0, 0.0, 0.5, 0.0, 0.0, 0.0]))  # fmt: skip
            size = 0.01 if name != "direction" else 0.0
            return centre + self.random.uniform(-size, size, (self.rows, centre.size))
        low, high = next(
            ((low, high) for pattern, low, high in QUANTITIES if re.search(pattern, name)),
            (1.0, 2.0),
        )
        return np.asarray(self.random.uniform(low, high, shape))

    def joints(self, name: str) -> Array:
        """A hexapod's, m; no leg lies in a plane."""
        angle = np.deg2rad([0.0, 60.0, 120.0, 180.0, 240.0, 300.0])
        if name == "normal":
            return np.full((6, 3), np.nan)
        radius, turn, height = (0.6, 0.2, 0.0) if name == "base" else (0.3, -0.2, 0.0)
        turned = angle + turn * (-1.0) ** np.arange(6)
        return np.column_stack(
            [radius * np.cos(turned), radius * np.sin(turned), np.full(6, height)]
        )


def called(thing: Callable[..., Any], function: Function, values: Values) -> Any:
    """The call itself: arguments without a name by their place."""
    by_place = [values[a.name] for a in function.arguments if a.positional and a.name in values]
    named = {n: v for n, v in values.items() if not re.fullmatch(r"arg\d+|kwargs", n)}
    more = values.get("kwargs", {})
    return thing(*by_place, **named, **(more if isinstance(more, dict) else {"more": more}))


def _flat(given: Any) -> Iterator[Any]:
    """The objects in lists and tuples."""
    if isinstance(given, list | tuple):
        for one in given:
            yield from _flat(one)
    else:
        yield given
