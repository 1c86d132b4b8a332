"""What is true of one virtual rig: its axes, its platform, its sensors."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from validation.twins.imperfection import Imperfection
from validation.twins.instruments import Errors
from validation.twins.machine import Body, Machine
from validation.twins.maps import Maps


@dataclass(frozen=True)
class Truth:
    """Everything that decides a record but noise."""

    machine: Machine = field(default_factory=Machine)
    body: Body = field(default_factory=Body)
    errors: Errors = field(default_factory=Errors)
    imperfection: Imperfection | None = None
    """What no rig file can declare; None: a machine whose maps are the source's."""

    @property
    def maps(self) -> Maps | None:
        """Maps of its axes; None for the source's."""
        return None if self.imperfection is None else self.imperfection.maps

    @property
    def built(self) -> Machine:
        """The machine with that in its numbers which no rig file can declare."""
        off = self.imperfection
        if off is None:
            return self.machine
        return self.machine._replace(
            leak_critical_ratio=off.leak_critical_ratio, leak_exponent=off.leak_exponent
        )

    def value(self, name: str) -> float:
        """A number by name; "extension.gain" is a sensor's."""
        signal, _, field = name.partition(".")
        if field:
            return float(getattr(self.errors[signal], field))
        return float(getattr(self.body if name in Body._fields else self.machine, name))

    def having(self, **values: float) -> Truth:
        """The same with other numbers, by the names of `value`."""
        truth = self
        for name, value in values.items():
            signal, _, field = name.partition(".")
            if field:
                sensor = replace(truth.errors[signal], **{field: value})
                errors = Errors({**truth.errors.of, signal: sensor})
                truth = replace(truth, errors=errors)
            elif name in Machine._fields:
                truth = replace(truth, machine=truth.machine._replace(**{name: value}))
            elif name in Body._fields:
                truth = replace(truth, body=truth.body._replace(**{name: value}))
            else:
                raise ValueError(f"there is no number '{name}' on this rig")
        return truth
