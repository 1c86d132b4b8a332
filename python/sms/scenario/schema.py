"""The scenario file's tables and keys. docs/simulation.md explains each; scenario.py gives them SI."""

from __future__ import annotations

from typing import Any, Literal

from pydantic import Field

from sms.io.toml_tables import Table, TextOrNumber

Axis = Literal["roll", "pitch", "heave", "actuators"]


class ScenarioTable(Table):
    """[scenario]: what is simulated."""

    title: str = ""
    """Title of the report; without it, the file's name."""
    notes: str = ""
    """Text below the title of the report."""
    plant: Literal["platform", "bench", "tank"] = "platform"
    """`platform`: on three actuators, each with its valve; `bench`: one of these; `tank`: that of the flow test,
    charged and vented by the valve.
    """
    duration: TextOrNumber | None = None
    """Length of the run, needed with [excitation] or [sea]; of [deck_motion] the most that is used, without it all."""


class RigTable(Table):
    """[rig]: a rig file whose [parameters] are taken over, such as extended.toml of `sms diagnose`."""

    file: str
    """Rig file or parameter file, relative to this file; its records need not be there."""


class ModelTable(Table):
    """[model]: which laws the plant follows, and how exactly it is integrated."""

    valve_law: Literal["iso_0_4_mpa", "iso_0_2_mpa", "classic"] = "iso_0_4_mpa"
    """Flow law of the valve: ISO 6358 with the table measured at 0.4 or 0.2 MPa gauge; `classic`, orifice area and
    discharge coefficient.
    """
    friction_law: Literal["acceleration_dependent", "two_branch", "stribeck", "dahl", "lugre"] = (
        "acceleration_dependent"
    )
    """Friction law of the actuators: `acceleration_dependent` (eq. 6.5), `two_branch` (eq. 6.2), `stribeck` (eq. 6.1);
    `dahl` and `lugre` have the deflection of the seals as a state.
    """
    chamber_law: Literal["polytropic", "energy"] = "polytropic"
    """`polytropic`: temperature constant, a heat ratio for each term (eq. 4.30); `energy`: temperature a state, heat
    through the wall.
    """
    masses: Literal["corrected", "table"] = "corrected"
    """Centres of gravity and inertias of the platform's links: those of Table 3.1 as corrected in
    libsms/include/sms/bodies.hpp, or as printed.
    """
    electronics: bool = False
    """Whether converter, anti-alias filter and the filter of the pulse width are simulated (section 7.3.3)."""
    tolerance: float = Field(default=1e-7)
    """Relative error of an integrator step, 1e-12 to 1e-2."""


class ControllerTable(Table):
    """[controller]: what drives the valves; its gains are parameters. A tank's valve has none."""

    kind: Literal["state_feedback", "pid", "open_loop"] = "pid"
    """Position controller of each actuator, `pid` (eq. 7.4) or `state_feedback` (Figure 8.3); `open_loop`: none, the
    excitation goes to the valves.
    """
    compensated: bool = True
    """Whether the controller's output steps over the valve's dead band (eq. 7.5)."""


class StartTable(Table):
    """[start]: where the platform or the bench's actuator rests, and about which it moves."""

    height: TextOrNumber | None = None
    """Height of the level platform; without it, 0.5 m."""
    extension: TextOrNumber | None = None
    """Extension of the bench's actuator; without it, mid-stroke."""
    load_force: TextOrNumber | None = None
    """Force on the rod of the bench's actuator against extension, in the whole run; without it, 0 N."""


class ExcitationTable(Table):
    """What every [excitation] has."""

    axis: Axis = "heave"
    """What moves about its start: an axis of the platform's pose, or `actuators`, the extension of each or, in an open
    loop, the command of each valve. With a bench, a tank or an open loop `heave` is `actuators`.
    """
    amplitude: TextOrNumber | list[str]
    """An angle, a length or, in an open loop, a voltage about `command_offset`; with `actuators` of a platform, a list
    of three gives each its own.
    """
    delay: TextOrNumber = "0 s"
    """Time before it begins; until then it is 0."""


class SineTable(ExcitationTable):
    """[excitation] kind = "sine"."""

    kind: Literal["sine"]
    """A sine of one frequency."""
    frequency: TextOrNumber
    """Frequency of the sine."""
    offset: TextOrNumber | None = None
    """What is added to the sine, in the dimension of the amplitude; without it, 0."""
    jump: TextOrNumber | None = None
    """What is added with the sign of the sine, to step over the dead band (section 7.2); without it, 0."""


class ChirpTable(ExcitationTable):
    """[excitation] kind = "chirp" (eq. 7.3)."""

    kind: Literal["chirp"]
    """A sine whose frequency changes at a constant rate."""
    first: TextOrNumber
    """Frequency at the beginning."""
    last: TextOrNumber
    """Frequency at the end of the sweep; beyond, it goes on changing."""
    sweep: TextOrNumber | None = None
    """Duration of the sweep; without it, from the delay to the end of the run."""


class AprbsTable(ExcitationTable):
    """[excitation] kind = "aprbs"."""

    kind: Literal["aprbs"]
    """Amplitude-modulated pseudo-random binary signal (section 7.3): levels within the amplitude."""
    shortest: TextOrNumber
    """Shortest time for which a level is held."""
    longest: TextOrNumber
    """Longest time for which a level is held."""
    seed: int = Field(default=1, ge=0)
    """Of the random levels and times; the same seed gives the same signal."""


class StepsTable(ExcitationTable):
    """[excitation] kind = "steps"."""

    kind: Literal["steps"]
    """One level after the other."""
    levels: list[float] = Field(min_length=1)
    """Factors on the amplitude, in turn; the last one stays."""
    hold: TextOrNumber
    """Time for which each level is held."""


EXCITATIONS: dict[str, type[ExcitationTable]] = {
    "sine": SineTable,
    "chirp": ChirpTable,
    "aprbs": AprbsTable,
    "steps": StepsTable,
}


class MotionTable(Table):
    """What every motion of a deck has."""

    fade: TextOrNumber = "5 s"
    """Time over which the motion is led from rest at its start, and back to rest at its end."""
    clearance: TextOrNumber | None = None
    """Length kept free at both ends of the stroke; without it, the parameter `cushion_length`."""
    beyond: Literal["refuse", "clip", "scale"] = "refuse"
    """What is done with a motion that stroke or flow do not allow: `refuse` it, `clip` heave and tilt at the edge of
    the workspace and limit the speed, or `scale` all of it by one factor.
    """


class DeckMotionTable(MotionTable):
    """[deck_motion]: a record of a deck's attitude as the platform's command."""

    file: str
    """The record, looked up in the folder of the environment variable `SMS_DATA`, beside this file and in
    ../shared/data; docs/logs.md lists the formats.
    """
    delimiter: Literal["comma", "semicolon", "tab", "whitespace"] = "comma"
    """Between the columns of a text file."""
    time: str
    """Column of the time, with or without its unit in brackets."""
    roll: str | None = None
    """Column of roll; without it, roll stays 0. One of roll, pitch and heave is needed."""
    pitch: str | None = None
    """Column of pitch; without it, pitch stays 0."""
    heave: str | None = None
    """Column of heave, upwards, whose mean is taken off; without it, heave stays 0."""
    time_unit: str | None = None
    """Unit of the time; without it, the one in brackets in the column's name."""
    roll_unit: str | None = None
    """Unit of roll; without it, the one in brackets in the column's name."""
    pitch_unit: str | None = None
    """Unit of pitch; without it, the one in brackets in the column's name."""
    heave_unit: str | None = None
    """Unit of heave; without it, the one in brackets in the column's name."""
    scale: float = 1.0
    """Froude scale, 1e-3 to 1e4: heave times it, times times its root, angles as they are."""
    first: TextOrNumber | None = None
    """Time, after scaling, at which the part that is used begins; without it, 0 s."""
    last: TextOrNumber | None = None
    """Time, after scaling, at which that part ends; without it, the end of the record."""
    band_low: TextOrNumber = "0 Hz"
    """Lower cut-off frequency of the band-pass filter (Butterworth, zero phase); 0 Hz: only a low-pass filter."""
    band_high: TextOrNumber = "1 Hz"
    """Upper cut-off frequency of the filter."""


class SeaTable(MotionTable):
    """[sea]: a synthetic deck motion."""

    state: float
    """Sea state, 0 to 4; between whole ones by interpolation."""
    seed: int = Field(default=1, ge=0)
    """Of the random waves; the same seed gives the same motion."""
    heave: bool = False
    """Whether the platform heaves, too."""


class OutputTable(Table):
    """[output]: the run's file."""

    format: Literal["csv", "parquet"] = "csv"
    """Of the run's signals."""
    every: TextOrNumber = "10 ms"
    """Time between rows, rounded to control periods, one at least."""


class ScenarioFile(Table):
    """The whole scenario file."""

    scenario: ScenarioTable = ScenarioTable()
    rig: RigTable | None = None
    parameters: dict[str, TextOrNumber] = Field(default_factory=dict)
    """Values of the model's parameters, in place of those of [rig] and the defaults of docs/parameters.md."""
    model: ModelTable = ModelTable()
    controller: ControllerTable = ControllerTable()
    start: StartTable = StartTable()
    excitation: dict[str, Any] | None = None
    deck_motion: DeckMotionTable | None = None
    sea: SeaTable | None = None
    output: OutputTable = OutputTable()
