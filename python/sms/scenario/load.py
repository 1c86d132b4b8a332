"""A scenario: what is simulated, in SI units, every value checked before anything runs."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from sms._core import LegParams, Params
from sms.errors import InputError
from sms.io.data_files import search_places
from sms.io.declarations import check_bounds, read_declarations
from sms.io.toml_tables import Table, TextOrNumber
from sms.io.units import to_si
from sms.kinematics import height_range
from sms.parameters import LEG_PARAMETERS, PARAMETERS, is_of_leg
from sms.scenario.schema import (
    EXCITATIONS,
    DeckMotionTable,
    ExcitationTable,
    ModelTable,
    OutputTable,
    ScenarioFile,
    SeaTable,
)
from sms.scenario.tables import checked, known_key, read_toml, within

LONGEST = 86400.0  #: s, of a run
HIGHEST_FREQUENCY = 1e3  #: Hz, of an excitation or a band
TOLERANCES = 1e-12, 1e-2


@dataclass(frozen=True)
class Scenario:
    """One simulation, ready to run."""

    path: Path
    title: str
    notes: str
    plant: str  #: "platform", "bench" or "tank"
    params: Params
    changed: Mapping[str, float]  #: parameters other than their defaults, SI
    model: ModelTable
    controller: str  #: "state_feedback", "pid" or "open_loop"
    compensated: bool  #: the controller steps over the valve's dead band
    height: float  #: of the platform at rest, m
    extension: float  #: of the bench's actuator at rest, m
    load_force: float  #: on the bench's rod, N
    duration: float | None  #: s; None: that of the motion
    excitation: ExcitationTable | None
    deck_motion: DeckMotionTable | None
    sea: SeaTable | None
    output: OutputTable
    every: float  #: s between rows of the output
    rig: Path | None = None  #: the rig file whose parameters it takes

    @property
    def files(self) -> tuple[Path, ...]:
        """Every file that is read with it: itself, and the rig and the deck motion that it names."""
        deck, where = self.deck_motion, self.where("deck_motion", "file")
        motion = None if deck is None else find_file(deck.file, self.path, where)
        return tuple(f for f in (self.path, self.rig, motion) if f is not None)

    @property
    def period(self) -> float:
        """Of the controller, s."""
        return self.params.control_period

    def where(self, table: str, key: str = "") -> str:
        """How an error names a place of this file."""
        return f"{self.path}, [{table}] {key}".rstrip()

    def number(self, table: str, key: str, value: TextOrNumber, unit: str) -> float:
        """A quantity of the file in SI units; InputError names the place."""
        return to_si(value, unit, self.where(table, key))


def load_scenario(path: Path, settings: Mapping[str, float] | None = None) -> Scenario:
    """Read and check a scenario file.

    `settings` are parameters (SI) that go before those of the file. InputError says file, table,
    key, value and what is allowed.
    """
    return scenario_from(read_toml(path, "scenario"), path, settings)


def scenario_from(
    tables: Mapping[str, Any], path: Path, settings: Mapping[str, float] | None = None
) -> Scenario:
    """As `load_scenario`, from the tables themselves; `path` is what errors name."""
    file = checked(ScenarioFile, tables, path)
    _check_one_motion(file, path)
    _check_plant(file, path)
    changed = {**_rig_parameters(file, path), **_parameters(file, path), **(settings or {})}
    params = _machine(file.scenario.plant, changed, path)
    duration = file.scenario.duration
    low, high = TOLERANCES
    if not low <= file.model.tolerance <= high:
        raise InputError(
            f"{path}, [model] tolerance: {file.model.tolerance:g} is outside the allowed range, "
            f"{low:g} to {high:g}"
        )
    height, extension, load_force = _start(file, params, path)
    controller = "open_loop" if file.scenario.plant == "tank" else file.controller.kind
    every = within(file.output.every, "s", 0.0, LONGEST, f"{path}, [output] every", above=True)
    return Scenario(
        path=path,
        title=file.scenario.title or path.stem,
        notes=file.scenario.notes,
        plant=file.scenario.plant,
        params=params,
        changed=changed,
        model=file.model,
        controller=controller,
        compensated=file.controller.compensated and controller != "open_loop",
        height=height,
        extension=extension,
        load_force=load_force,
        duration=None
        if duration is None
        else within(duration, "s", 0.0, LONGEST, f"{path}, [scenario] duration", above=True),
        excitation=_excitation(file, path),
        deck_motion=file.deck_motion,
        sea=file.sea,
        output=file.output,
        every=max(every, params.control_period),
        rig=_rig_file(file, path),
    )


def _machine(plant: str, changed: Mapping[str, float], path: Path) -> Params:
    """The published machine but for what is changed; of a platform each leg may have its own."""
    params = LegParams() if plant == "platform" else Params()
    for name, value in changed.items():
        if is_of_leg(name) and plant != "platform":
            raise InputError(
                f"{path}: {name} is of one leg of a platform, and this is a {plant}; leave it out"
            )
        params[name] = value
    return params


def parameter_value(name: str, value: TextOrNumber, where: str) -> float:
    """A parameter's value in SI, within its bounds; InputError names key, value and range."""
    if name not in LEG_PARAMETERS:
        raise InputError(f"{where}: there is no such parameter; {known_parameter(name)}")
    parameter = LEG_PARAMETERS[name]
    number = to_si(value, parameter.unit, where)
    check_bounds(parameter, number, where)
    return number


def known_parameter(name: str) -> str:
    """The remedy for an unknown parameter; all of them would be no help."""
    remedy = known_key(name, list(PARAMETERS))
    meant = remedy.partition("allowed are")[0]
    return f"{meant}docs/parameters.md lists all {len(PARAMETERS)}"


def find_file(name: str, path: Path, where: str) -> Path:
    """A file named in a scenario: under $SMS_DATA, beside the scenario, in ../shared/data."""
    named = Path(name).expanduser()
    places = [named] if named.is_absolute() else [p / named for p in search_places(path)]
    for candidate in places:
        if candidate.is_file():
            return candidate
    looked = ", ".join(str(place.parent.resolve()) for place in places)
    raise InputError(
        f"{where}: there is no file '{name}' (looked in: {looked}); check the name, or set SMS_DATA "
        "to the folder that holds it"
    )


PLANTS_WITH = {
    ("start", "height"): ("platform",),
    ("start", "extension"): ("bench",),
    ("start", "load_force"): ("bench",),
    ("model", "masses"): ("platform",),
    ("model", "friction_law"): ("platform", "bench"),
    ("model", "electronics"): ("platform", "bench"),
}
"""Keys that do not concern every plant."""


def _check_plant(file: ScenarioFile, path: Path) -> None:
    """InputError for a key that the plant has no use for: it would change nothing."""
    for (table, key), plants in PLANTS_WITH.items():
        given = key in getattr(file, table).model_fields_set
        if given and file.scenario.plant not in plants:
            raise InputError(
                f"{path}, [{table}] {key}: of a {' or a '.join(plants)}, and the plant is a "
                f"{file.scenario.plant}; leave it out, or correct [scenario] plant"
            )


def _check_one_motion(file: ScenarioFile, path: Path) -> None:
    motions = {"excitation": file.excitation, "deck_motion": file.deck_motion, "sea": file.sea}
    given = [name for name, table in motions.items() if table is not None]
    if len(given) > 1:
        raise InputError(f"{path}: [{given[0]}] and [{given[1]}] exclude each other; keep one")
    if not given:
        raise InputError(
            f"{path}: nothing moves; add one of {', '.join(f'[{name}]' for name in motions)}"
        )
    if given[0] == "excitation" and file.scenario.duration is None:
        raise InputError(f"{path}, [scenario]: the key 'duration' is missing; add \"20 s\" or so")
    if file.scenario.plant == "tank" and (
        given[0] != "excitation"
        or ("kind" in file.controller.model_fields_set and file.controller.kind != "open_loop")
    ):
        raise InputError(
            f"{path}, [scenario] plant: a tank's valve is opened by an [excitation] in volts and has "
            "no controller; leave [controller], [deck_motion] and [sea] out"
        )
    if given[0] != "excitation" and file.controller.kind == "open_loop":
        raise InputError(
            f"{path}, [controller] kind: 'open_loop' sends volts, a deck's motion is a pose; "
            "allowed here are state_feedback, pid"
        )
    if given[0] != "excitation" and file.scenario.plant == "bench":
        raise InputError(
            f"{path}, [scenario] plant: 'bench' is one actuator and has no deck; write "
            'plant = "platform", or an [excitation]'
        )
    if given[0] == "sea" and file.scenario.duration is None:
        raise InputError(f"{path}, [scenario]: the key 'duration' is missing; add \"300 s\" or so")


def _excitation(file: ScenarioFile, path: Path) -> ExcitationTable | None:
    if file.excitation is None:
        return None
    kind = str(file.excitation.get("kind", ""))
    if kind not in EXCITATIONS:
        problem = f"'{kind}' is not known" if kind else "the key 'kind' is missing"
        where = f"{path}, [excitation] kind" if kind else f"{path}, [excitation]"
        raise InputError(f"{where}: {problem}; {known_key(kind, list(EXCITATIONS))}")
    # The one table on its own, named as in the file.
    model = type("ExcitationFile", (Table,), {"__annotations__": {"excitation": EXCITATIONS[kind]}})
    table: ExcitationTable = checked(model, {"excitation": file.excitation}, path).excitation
    return table


def _parameters(file: ScenarioFile, path: Path) -> dict[str, float]:
    return {
        name: parameter_value(name, value, f"{path}, [parameters] {name}")
        for name, value in file.parameters.items()
    }


def _rig_file(file: ScenarioFile, path: Path) -> Path | None:
    if file.rig is None:
        return None
    return (path.parent / Path(file.rig.file).expanduser()).resolve()


def _rig_parameters(file: ScenarioFile, path: Path) -> dict[str, float]:
    """The values under [parameters] of a rig file; its records need not be there."""
    rig = _rig_file(file, path)
    if rig is None:
        return {}
    return {name: known.value for name, known in read_declarations(rig).items()}


def _start(file: ScenarioFile, params: Params, path: Path) -> tuple[float, float, float]:
    """Height of the platform, extension of the bench's actuator (m) and its load (N), at rest."""
    low, high = height_range(params)
    if not (math.isfinite(low) and math.isfinite(high)):
        raise InputError(f"{path}, [parameters]: with these the mechanism has no level pose")
    height, extension = 0.5, 0.5 * params.stroke
    if file.start.height is not None:
        height = within(file.start.height, "m", low, high, f"{path}, [start] height")
    if file.start.extension is not None:
        where = f"{path}, [start] extension"
        extension = within(file.start.extension, "m", 0.0, params.stroke, where)
    load = 0.0
    if file.start.load_force is not None:
        load = within(file.start.load_force, "N", -1e5, 1e5, f"{path}, [start] load_force")
    return height, extension, load
