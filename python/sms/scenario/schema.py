"""The scenario file's tables and keys. docs/simulation.md explains each; scenario.py gives them SI."""

from __future__ import annotations

from typing import Any, Literal

from pydantic import Field

from sms.io.schema import Table, TextOrNumber

Axis = Literal["roll", "pitch", "heave", "actuators"]


class ScenarioTable(Table):
    """[scenario]: what is simulated."""

    title: str = ""
    notes: str = ""
    plant: Literal["platform", "bench", "tank"] = "platform"
    duration: TextOrNumber | None = None


class RigTable(Table):
    """[rig]: a rig file whose [parameters] are taken over, such as extended.toml of `sms diagnose`."""

    file: str


class ModelTable(Table):
    """[model]: which laws the plant follows, and how exactly it is integrated."""

    valve_law: Literal["iso_0_4_mpa", "iso_0_2_mpa", "classic"] = "iso_0_4_mpa"
    friction_law: Literal["acceleration_dependent", "two_branch", "stribeck", "dahl", "lugre"] = (
        "acceleration_dependent"
    )
    chamber_law: Literal["polytropic", "energy"] = "polytropic"
    masses: Literal["corrected", "table"] = "corrected"
    electronics: bool = False
    tolerance: float = Field(default=1e-7)


class ControllerTable(Table):
    """[controller]: what drives the valves; its gains are parameters. A tank's valve has none."""

    kind: Literal["state_feedback", "pid", "open_loop"] = "pid"
    compensated: bool = True


class StartTable(Table):
    """[start]: the pose in which the platform rests at time 0, or the bench's extension."""

    height: TextOrNumber | None = None
    extension: TextOrNumber | None = None
    load_force: TextOrNumber | None = None


class ExcitationTable(Table):
    """What every [excitation] has."""

    axis: Axis = "heave"
    amplitude: TextOrNumber | list[str]
    delay: TextOrNumber = "0 s"


class SineTable(ExcitationTable):
    """[excitation] kind = "sine"."""

    kind: Literal["sine"]
    frequency: TextOrNumber
    offset: TextOrNumber | None = None
    jump: TextOrNumber | None = None


class ChirpTable(ExcitationTable):
    """[excitation] kind = "chirp" (eq. 7.3)."""

    kind: Literal["chirp"]
    first: TextOrNumber
    last: TextOrNumber
    sweep: TextOrNumber | None = None


class AprbsTable(ExcitationTable):
    """[excitation] kind = "aprbs"."""

    kind: Literal["aprbs"]
    shortest: TextOrNumber
    longest: TextOrNumber
    seed: int = Field(default=1, ge=0)


class StepsTable(ExcitationTable):
    """[excitation] kind = "steps"."""

    kind: Literal["steps"]
    levels: list[float] = Field(min_length=1)
    hold: TextOrNumber


EXCITATIONS: dict[str, type[ExcitationTable]] = {
    "sine": SineTable,
    "chirp": ChirpTable,
    "aprbs": AprbsTable,
    "steps": StepsTable,
}


class DeckMotionTable(Table):
    """[deck_motion]: a record of a deck's attitude as the platform's command."""

    file: str
    delimiter: Literal["comma", "semicolon", "tab", "whitespace"] = "comma"
    time: str
    roll: str | None = None
    pitch: str | None = None
    heave: str | None = None
    time_unit: str | None = None
    roll_unit: str | None = None
    pitch_unit: str | None = None
    heave_unit: str | None = None
    scale: float = 1.0
    first: TextOrNumber | None = None
    last: TextOrNumber | None = None
    band_low: TextOrNumber = "0 Hz"
    band_high: TextOrNumber = "1 Hz"
    fade: TextOrNumber = "5 s"
    clearance: TextOrNumber | None = None
    beyond: Literal["refuse", "clip", "scale"] = "refuse"


class SeaTable(Table):
    """[sea]: a synthetic deck motion."""

    state: float
    seed: int = Field(default=1, ge=0)
    heave: bool = False
    fade: TextOrNumber = "5 s"
    clearance: TextOrNumber | None = None
    beyond: Literal["refuse", "clip", "scale"] = "refuse"


class OutputTable(Table):
    """[output]: the run's file."""

    format: Literal["csv", "parquet"] = "csv"
    every: TextOrNumber = "10 ms"


class ScenarioFile(Table):
    """The whole scenario file."""

    scenario: ScenarioTable = ScenarioTable()
    rig: RigTable | None = None
    parameters: dict[str, TextOrNumber] = Field(default_factory=dict)
    model: ModelTable = ModelTable()
    controller: ControllerTable = ControllerTable()
    start: StartTable = StartTable()
    excitation: dict[str, Any] | None = None
    deck_motion: DeckMotionTable | None = None
    sea: SeaTable | None = None
    output: OutputTable = OutputTable()
