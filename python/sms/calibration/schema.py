"""The structure of a rig file of kind "poses"."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import AfterValidator, Field

from sms.io.toml_tables import Table, TextOrNumber


class MeasuredTable(Table):
    """[rig]: what was measured."""

    kind: Literal["poses"]
    """What tells this file from other rig files."""
    name: str = ""
    """Title of the report; without it, the file's name."""
    poses: str
    """CSV file, one row a pose, a unit in every header."""
    validation: str | None = None
    """CSV file of the poses on which the result is judged; without it every fifth pose is one."""


class NoiseTable(Table):
    """[noise]: standard deviations of what is read, for each column that the poses have."""

    extension: TextOrNumber
    """Of each position sensor, a length."""
    roll: TextOrNumber | None = None
    """Of roll, an angle."""
    pitch: TextOrNumber | None = None
    """Of pitch, an angle."""
    height: TextOrNumber | None = None
    """Of the height of the platform's reference point, a length."""
    yaw: TextOrNumber | None = None
    """Of yaw, an angle."""
    x: TextOrNumber | None = None
    """Of x of the reference point, a length."""
    y: TextOrNumber | None = None
    """Of y of the reference point, a length."""


class TolerancesTable(Table):
    """[tolerances]: half widths on the drawing, two standard deviations."""

    joint: TextOrNumber = "5 mm"
    """Each coordinate of each joint."""
    length: TextOrNumber = "5 mm"
    """Link, less the distance of its joints at rest."""
    sensor_gain: TextOrNumber = 0.005
    """Relative gain error of each position sensor."""
    extension_zero: TextOrNumber = "1 mm"
    """Zero error of each position sensor, a length."""
    attitude_zero: TextOrNumber = "2 mrad"
    """Zero error of the sensor of roll and of that of pitch, an angle."""


def _x_y_z(value: list[str | float]) -> list[str | float]:
    if len(value) != 3:
        raise ValueError('must be x, y and z, like ["1.2 m", "0 m", "-0.1 m"]')
    return value


Place = Annotated[
    list[TextOrNumber],
    AfterValidator(_x_y_z),
    Field(json_schema_extra={"minItems": 3, "maxItems": 3}),
]


class DistanceTable(Table):
    """[distances.NAME]: what the column distance_NAME is. Places are x, y and z in the axes of the joints, with the
    platform at rest.
    """

    ground: Place
    """Of the mark on the ground."""
    platform: Place
    """Of the mark on the platform."""
    noise: TextOrNumber
    """Standard deviation of a reading, and of what is not known of the marks."""


class PosesFile(Table):
    """The whole file."""

    rig: MeasuredTable
    noise: NoiseTable
    tolerances: TolerancesTable = TolerancesTable()
    distances: dict[str, DistanceTable] = Field(default_factory=dict)
