"""The record of a run: its signals over time, as they are written and drawn. SI units."""

from __future__ import annotations

from dataclasses import dataclass, replace

from sms.arrays import Array
from sms.io.signals import with_units

PER_ACTUATOR = (
    *with_units("setpoint", "extension"),
    ("velocity", "m/s"),
    *with_units(
        "chamber_pressure_lower", "chamber_pressure_upper", "supply_pressure", "valve_command"
    ),
)
POSE = (
    *with_units("roll", "pitch"),
    ("height", "m"),
    ("yaw", "rad"),
    ("x", "m"),
    ("y", "m"),
)


@dataclass(frozen=True)
class Record:
    """Signals of a run: (n,), or (n, m) with one column an actuator."""

    time: Array  #: s
    setpoint: Array  #: m, or V when `unit` is "V", what was commanded
    unit: str
    extension: Array  #: m
    velocity: Array  #: m/s
    chamber_pressure_lower: Array  #: Pa, absolute
    chamber_pressure_upper: Array  #: Pa
    supply_pressure: Array  #: Pa, at the valve
    valve_command: Array  #: V
    pose: Array | None  #: (n, 6) roll, pitch, height, yaw, x, y; None on the bench
    asked: Array | None  #: (n, 3) roll, pitch, height commanded; None in an open loop
    planned: float  #: s, how long it was to be
    ended: str = ""  #: why it ended early, in words; "" when it is complete

    @property
    def complete(self) -> bool:
        """Whether it ran to its end."""
        return not self.ended

    def every(self, step: int) -> Record:
        """Each `step`-th sample."""
        return self._taken(slice(None, None, max(1, step)))

    def columns(self) -> dict[str, Array]:
        """ "name [unit]" and values (n,), as they are written; actuators are numbered from 1."""
        columns = {"time [s]": self.time}
        for name, unit in PER_ACTUATOR:
            values: Array = getattr(self, name)
            label, shown = (name, unit) if name != "setpoint" else ("setpoint", self.unit)
            for number in range(values.shape[1]):
                columns[f"{label}_{number + 1} [{shown}]"] = values[:, number]
        if self.pose is not None:
            for (name, unit), values in zip(POSE, self.pose.T, strict=True):
                columns[f"{name} [{unit}]"] = values
        if self.asked is not None:
            for (name, unit), values in zip(POSE[:3], self.asked.T, strict=True):
                columns[f"{name}_command [{unit}]"] = values
        return columns

    def _taken(self, cut: slice) -> Record:
        return replace(
            self,
            time=self.time[cut],
            setpoint=self.setpoint[cut],
            extension=self.extension[cut],
            velocity=self.velocity[cut],
            chamber_pressure_lower=self.chamber_pressure_lower[cut],
            chamber_pressure_upper=self.chamber_pressure_upper[cut],
            supply_pressure=self.supply_pressure[cut],
            valve_command=self.valve_command[cut],
            pose=None if self.pose is None else self.pose[cut],
            asked=None if self.asked is None else self.asked[cut],
        )
