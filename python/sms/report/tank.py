"""The figures of a simulated flow test."""

from __future__ import annotations

from sms.arrays import Array
from sms.report.plots import Figure, Line
from sms.scenario.load import Scenario
from sms.scenario.tank import TankRecord


def tank_figures(scenario: Scenario, record: TankRecord) -> list[Figure]:
    """Pressure, flow, command, and temperature where it is a state."""
    p = scenario.params

    def over_time(
        name: str, title: str, y: str, values: Array, colour: str, note: str, wide: bool = False
    ) -> Figure:
        marks = ({"y": 1e-5 * p.supply_pressure}, {"y": 1e-5 * p.ambient_pressure})
        line = Line("", record.time, values, colour)
        return Figure(
            name, title, "time in s", y, [line], note, marks=marks if name == "pressure" else (),
            wide=wide,
        )  # fmt: skip

    figures = [
        over_time(
            "pressure", "Pressure in the tank", "pressure in bar absolute",
            1e-5 * record.tank_pressure, "extended",
            f"Dotted: supply, {1e-5 * p.supply_pressure:.2f} bar, and ambient, "
            f"{1e-5 * p.ambient_pressure:.2f} bar.", wide=True,
        ),
        over_time(
            "flow", "Mass flow", "flow in g/s", 1e3 * record.mass_flow, "baseline", "Into the tank."
        ),
        over_time(
            "valve", "Valve command", "command in V", record.valve_command, "good",
            f"Closed at {p.valve_centre:g} V; above it the supply feeds the tank, below it the tank "
            "is vented.",
        ),
    ]  # fmt: skip
    if scenario.model.chamber_law == "energy":
        note = f"The walls have {p.wall_temperature:g} K."
        figures.append(
            over_time(
                "temperature", "Air in the tank", "temperature in K", record.tank_temperature,
                "warn", note, wide=True,
            )
        )  # fmt: skip
    return figures
