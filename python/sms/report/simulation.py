"""A simulated run as one HTML page: what came out, the platform moving, then every signal."""

from __future__ import annotations

from typing import Any

import numpy as np

from sms import _core
from sms.arrays import Array
from sms.parameters import LEG_PARAMETERS
from sms.report.markup import esc, section, table
from sms.report.page import asset, page, plots
from sms.report.plots import Figure, Line, figures_html, payload
from sms.report.scene import LONGEST, scene_of
from sms.report.tank import tank_figures
from sms.requirements.table import ACCURACY
from sms.scenario.findings import Findings
from sms.scenario.load import Scenario
from sms.scenario.record import Record
from sms.scenario.sent import Command
from sms.scenario.tank import TankFindings, TankRecord
from sms.units_display import format_quantity, words

_COLOURS = ("extended", "baseline", "good")


def simulation_html(
    scenario: Scenario,
    command: Command,
    record: Record | TankRecord,
    findings: Findings | TankFindings,
) -> str:
    """The whole page, of which plotly.js is 2 MB."""
    if isinstance(record, TankRecord):
        figures, scene = tank_figures(scenario, record), None
    else:
        figures = [*_attitude(command, record), *_actuators(scenario, record)]
        scene = scene_of(record, scenario.params)
    data: dict[str, Any] = payload(figures)
    if scene is not None:
        data["scene"] = scene
    listed = "".join(f"<li>{esc(text)}</li>" for text in findings.sentences)
    body = (
        f"<main><h1>{esc(scenario.title)}</h1>"
        + (f"<p class='lead'>{esc(scenario.notes)}</p>" if scenario.notes else "")
        + (
            f"<p class='decide'><b>Partial run.</b> {esc(record.ended)}</p>"
            if not record.complete
            else ""
        )
        + f"<ul class='findings-list'>{listed}</ul>"
        + (_scene_section(record.time) if scene is not None else "")
        + section("signals", "Signals", figures_html(figures))
        + section("setup", "What was simulated", _setup(scenario, command))
        + f"<p class='small'>sms {_core.__version__}; {esc(scenario.path.name)}</p></main>"
    )
    return page(scenario.title, body, plots(data, "plots.js", "scene.js"), asset("plots.css"))


def _scene_section(time: Array) -> str:
    lead = "Drag to turn it. The legs' colour is the pressure in the lower chamber."
    if time[-1] > LONGEST:
        lead += f" Shown are the {LONGEST:.0f} s around the largest tilt."
    place = "<div id='scene' role='img' aria-label='The platform moving in three dimensions'></div>"
    return section("motion", "The platform moving", f"<figure class='wide'>{place}</figure>", lead)


def _attitude(command: Command, record: Record) -> list[Figure]:
    """Roll, pitch and height as far as they move, each with its error."""
    if record.pose is None:
        return []
    figures = []
    for column, (axis, factor, unit) in enumerate(
        (("roll", 180.0 / np.pi, "°"), ("pitch", 180.0 / np.pi, "°"), ("height", 1e3, "mm"))
    ):
        reached = factor * record.pose[:, column]
        lines = [Line("reached", record.time, reached, "extended")]
        if record.asked is not None:
            asked = factor * record.asked[:, column]
            if np.ptp(asked) < 1e-9 and np.ptp(reached) < (0.05 if unit == "°" else 1.0):
                continue
            lines.insert(0, Line("commanded", record.time, asked, "measured"))
            lines[:0] = _before_cuts(command, axis, factor)
        figures.append(
            Figure(
                axis,
                axis.capitalize(),
                "time in s",
                f"{axis} in {unit}",
                lines,
                wide=True,
                height=340,
            )
        )
        if record.asked is not None and unit == "°":
            limit = ACCURACY * factor
            error = reached - factor * record.asked[:, column]
            figures.append(
                Figure(
                    f"{axis}-error",
                    f"{axis.capitalize()}: error",
                    "time in s",
                    f"error in {unit}",
                    [Line("", record.time, error, "baseline")],
                    f"Reached less commanded; dotted ±{limit:g}° of Table 2.1.",
                    marks=({"y": limit}, {"y": -limit}),
                    wide=True,
                    height=240,
                )
            )
    return figures


def _before_cuts(command: Command, axis: str, factor: float) -> list[Line]:
    """What was asked before anything was cut, when something was."""
    if command.motion is None or not command.motion.cuts or axis == "height":
        return []
    asked = command.motion.asked
    return [Line("asked before cuts", asked.time, factor * asked.axis(axis), "floor", "dot")]


def _actuators(scenario: Scenario, record: Record) -> list[Figure]:
    def each(values: Array, factor: float, dash: str = "") -> list[Line]:
        count = values.shape[1]
        return [
            Line(
                f"actuator {i + 1}" if not dash else "",
                record.time,
                factor * values[:, i],
                _COLOURS[i],
                dash,
            )
            for i in range(count)
        ]

    stroke = 1e3 * scenario.params.stroke
    extension = each(record.extension, 1e3)
    note = f"The stroke is 0 to {stroke:g} mm."
    if record.unit == "m":
        extension += each(record.setpoint, 1e3, "dot")
        note += " Dotted: set-points."
    return [
        Figure("extension", "Extension", "time in s", "extension in mm", extension, note, wide=True),
        Figure("velocity", "Speed", "time in s", "speed in mm/s", each(record.velocity, 1e3)),
        Figure(
            "valve", "Valve command", "time in s", "command in V", each(record.valve_command, 1.0),
            f"Closed at {scenario.params.valve_centre:g} V.",
        ),
        Figure(
            "lower", "Lower chambers", "time in s", "pressure in bar absolute",
            each(record.chamber_pressure_lower, 1e-5),
        ),
        Figure(
            "upper", "Upper chambers", "time in s", "pressure in bar absolute",
            each(record.chamber_pressure_upper, 1e-5),
        ),
    ]  # fmt: skip


def _setup(scenario: Scenario, command: Command) -> str:
    model = scenario.model
    laws = f"valve {words(model.valve_law)}, air {model.chamber_law}"
    if scenario.plant != "tank":
        laws += f", friction {words(model.friction_law)}, masses {model.masses}"
    rows = [
        ("motion", " ".join(command.words)),
        ("plant", scenario.plant),
        (
            "controller",
            words(scenario.controller) + (", compensated" if scenario.compensated else ""),
        ),
        ("laws", laws),
        ("tolerance", f"{model.tolerance:g} a step, controller every {1e3 * scenario.period:g} ms"),
    ]
    rows += [
        (f"parameter {words(name)}", format_quantity(value, LEG_PARAMETERS[name].unit, name))
        for name, value in scenario.changed.items()
    ]
    cells = [[esc(name), esc(text)] for name, text in rows]
    return table(
        "Parameters not listed have their default values.", ("what", "value"), cells, "wide-last"
    )
