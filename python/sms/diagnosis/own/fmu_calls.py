"""An FMU (FMI 2.0 or 3.0) as fmpy opens it: what it declares, and instances with given values of parameters.

A parameter of an FMU can be set before its initialisation only, so that each set of values has an instance, of which
the last ones are kept. Refused with a sentence: an FMU without a binary for this machine, and one whose states jump.
"""

from __future__ import annotations

import ctypes
import importlib
import tempfile
import weakref
import zipfile
from collections import OrderedDict
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Generic, Literal, TypeVar
from xml.etree import ElementTree

import numpy as np

from sms import _core
from sms.arrays import Array, Index
from sms.errors import InputError, did_you_mean

Interface = Literal["model_exchange", "co_simulation"]
MOST_INSTANCES = 64
"""Kept at a time: as many sets of values as a fit asks about together. Run time."""
FLOATS = ("Real", "Float64")
NEVER = 1e12
"""s: what some tools say where no event is planned is later still. Numerics."""
Kept = TypeVar("Kept")


@dataclass(frozen=True)
class Names:
    """Variables of the FMU by what they are for the model, in the model's order."""

    states: Sequence[str]
    inputs: Sequence[str]
    outputs: Sequence[str]
    parameters: Sequence[str]


class Fmu:
    """An FMU that is unpacked, and how it is used. InputError for what cannot be."""

    def __init__(self, file: Path, interface: Interface | None = None) -> None:
        self.file = file
        self.fmpy = _fmpy()
        try:
            self.description = self.fmpy.read_model_description(str(file))
        except OSError as problem:
            raise InputError(f"{file}: cannot be read ({problem.strerror or problem})") from None
        except Exception as problem:  # fmpy, lxml and zipfile have errors of their own
            said = " ".join(str(problem).split())[:300] or type(problem).__name__
            raise InputError(f"{file}: not a readable FMU ({said}); export it again") from None
        self.version = self.description.fmiVersion[:1]
        if self.version not in ("2", "3"):
            raise InputError(
                f"{file}: FMI {self.description.fmiVersion} is not read; export it as 2.0 or 3.0"
            )
        self._folder = tempfile.TemporaryDirectory(prefix="sms-fmu-")
        weakref.finalize(self, self._folder.cleanup)
        self.fmpy.extract(str(file), self._folder.name)
        self.interface = self._interface(interface)
        self._refuse_events()
        library = Path(self._folder.name) / "binaries"
        here = self.fmpy.platform if self.version == "2" else self.fmpy.platform_tuple
        if not (library / here).is_dir():
            there = ", ".join(sorted(p.name for p in library.glob("*"))) or "none"
            raise InputError(
                f"{file}: there is no binary for {here} in it ({there}); export it for this machine"
            )
        self.variables = {v.name: v for v in self.description.modelVariables}

    def _interface(self, wanted: Interface | None) -> Interface:
        d = self.description
        has: list[Interface] = []
        if d.modelExchange is not None:
            has.append("model_exchange")
        if d.coSimulation is not None:
            has.append("co_simulation")
        if not has:
            raise InputError(
                f"{self.file}: it has neither model exchange nor co-simulation; export one of them"
            )
        if wanted is not None and wanted not in has:
            raise InputError(f"{self.file}: it has no {wanted}; it has {' and '.join(has)}")
        return wanted or has[0]

    def _refuse_events(self) -> None:
        d = self.description
        if (d.numberOfEventIndicators or 0) > 0 or d.eventIndicators:
            raise InputError(
                f"{self.file}: {d.modelName} has events, at which its states may jump; a window that is simulated from "
                "its best initial state has none. Export a model without events (smooth functions in their place)"
            )

    @property
    def part(self) -> Any:
        """What the description says of the interface."""
        d = self.description
        return d.modelExchange if self.interface == "model_exchange" else d.coSimulation

    @property
    def directional(self) -> bool:
        """Whether it has directional derivatives. fmpy does not say so of FMI 3.0."""
        if self.version == "2":
            return bool(self.part.providesDirectionalDerivative)
        with zipfile.ZipFile(self.file) as archive, archive.open("modelDescription.xml") as text:
            root = ElementTree.parse(text).getroot()
        found = root.find("ModelExchange" if self.interface == "model_exchange" else "CoSimulation")
        return found is not None and found.get("providesDirectionalDerivatives") in ("true", "1")

    def variable(self, name: str, what: str) -> Any:
        """A variable of floating-point numbers; InputError for another, or none."""
        if name not in self.variables:
            raise InputError(
                f"{self.file}: there is no variable '{name}' ({what}); {did_you_mean(name, self.variables)}"
            )
        found = self.variables[name]
        if found.type not in FLOATS or found.dimensions:
            raise InputError(f"{self.file}: '{name}' ({what}) is no single floating-point number")
        return found

    def unit(self, name: str) -> str:
        """As the FMU declares it; "1" where it declares none."""
        v = self.variables[name]
        declared = v.unit or (v.declaredType.unit if v.declaredType is not None else None)
        return declared or "1"

    def rates_of(self, states: Sequence[str]) -> list[str]:
        """The rates of all continuous states in their order; InputError unless these are `states`."""
        rates = [unknown.variable for unknown in self.description.derivatives]
        own = [r.derivative.name for r in rates]
        if sorted(own) != sorted(states):
            raise InputError(
                f"{self.file}: its continuous states are {', '.join(own) or 'none'}, and [states] has "
                f"{', '.join(states) or 'none'}; write all of them"
            )
        return [rates[own.index(name)].name for name in states]

    def references(self, names: Sequence[str], what: str) -> list[int]:
        return [int(self.variable(n, what).valueReference) for n in names]

    def instance(self) -> Any:
        """A new one, not initialised, that writes nothing to the terminal."""
        part, d = self.part, self.description
        exchange = self.interface == "model_exchange"
        module = importlib.import_module(f"fmpy.fmi{self.version}")
        make = getattr(module, f"FMU{self.version}{'Model' if exchange else 'Slave'}")
        found = make(
            guid=d.instantiationToken if hasattr(d, "instantiationToken") else d.guid,
            unzipDirectory=self._folder.name,
            modelIdentifier=part.modelIdentifier,
            instanceName=d.modelName,
        )
        if self.version == "2":
            callbacks = module.fmi2CallbackFunctions()
            callbacks.logger = module.fmi2CallbackLoggerTYPE(_quiet)
            callbacks.allocateMemory = module.fmi2CallbackAllocateMemoryTYPE(self.fmpy.calloc)
            callbacks.freeMemory = module.fmi2CallbackFreeMemoryTYPE(self.fmpy.free)
            found.instantiate(callbacks=callbacks)
        else:
            found.instantiate(logMessage=_quiet)
        return found

    def initialised(self, instance: Any, values: Mapping[int, float]) -> None:
        """Start again with these values by reference, at time 0, ready for states and inputs."""
        references, numbers = list(values), list(values.values())
        instance.reset()
        if self.version == "2":
            if references:
                instance.setReal(references, numbers)
            instance.setupExperiment(startTime=0.0)
            instance.enterInitializationMode()
            instance.exitInitializationMode()
        else:
            if references:
                instance.setFloat64(references, numbers)
            instance.enterInitializationMode(startTime=0.0)
            instance.exitInitializationMode()
        if self.interface == "model_exchange":
            for _ in range(10):
                again = (
                    instance.newDiscreteStates()
                    if self.version == "2"
                    else instance.updateDiscreteStates()
                )
                if not again[0]:
                    break
            *_, planned, at = again
            if planned and at < NEVER:
                raise InputError(
                    f"{self.file}: {self.description.modelName} has an event at {at:g} s, and a window begins anywhere "
                    "in a record. Export a model without events at given times, and give what changes then as an input"
                )
            instance.enterContinuousTimeMode()

    @property
    def most_instances(self) -> int:
        return (
            1
            if getattr(self.part, "canBeInstantiatedOnlyOncePerProcess", False)
            else MOST_INSTANCES
        )


def _fmpy() -> Any:
    try:
        return importlib.import_module("fmpy")
    except ImportError:
        raise InputError('FMUs need one more package; pip install "sms[fmi]"') from None


def _quiet(*_: Any) -> None:
    """What an FMU would print, it says by its status too."""


class Pool(Generic[Kept]):
    """Something for each set of parameter values: made or made anew by `configure(old, values)`."""

    def __init__(self, most: int, configure: Callable[[Kept | None, Array], Kept]) -> None:
        self._most, self._configure = most, configure
        self._kept: OrderedDict[bytes, Kept] = OrderedDict()

    def __call__(self, values: Array) -> Kept:
        """(parameters,)"""
        key = values.tobytes()
        if key in self._kept:
            self._kept.move_to_end(key)
        else:
            old = self._kept.popitem(last=False)[1] if len(self._kept) >= self._most else None
            self._kept[key] = self._configure(old, values)
        return self._kept[key]


def native_calls(fmu: Fmu, instance: Any, names: Names) -> _core.FmuCalls:
    """The functions of an instance for model exchange, called for many states at once."""

    def address(function: str) -> int:
        pointer = ctypes.cast(getattr(instance.dll, function), ctypes.c_void_p)
        return int(pointer.value or 0)

    two = fmu.version == "2"
    component = instance.component
    rates = fmu.rates_of(names.states)
    return _core.FmuCalls(
        version=int(fmu.version),
        instance=int(component if isinstance(component, int) else component.value),
        set_states=address(f"fmi{fmu.version}SetContinuousStates"),
        set_values=address("fmi2SetReal" if two else "fmi3SetFloat64"),
        get_rates=address("fmi2GetDerivatives" if two else "fmi3GetContinuousStateDerivatives"),
        get_values=address("fmi2GetReal" if two else "fmi3GetFloat64"),
        get_directional=address(f"fmi{fmu.version}GetDirectionalDerivative")
        if fmu.directional
        else 0,
        states=fmu.references(names.states, "state"),
        rates=fmu.references(rates, "rate"),
        inputs=fmu.references(names.inputs, "input"),
        outputs=fmu.references(names.outputs, "output"),
    )


def in_sets(numbers: Array) -> list[tuple[Array, Index]]:
    """The columns of (parameters, n) that have the same values: (values (parameters,), their numbers)."""
    if numbers.shape[1] == 0 or bool(np.all(numbers == numbers[:, :1])):
        return (
            [(np.ascontiguousarray(numbers[:, 0]), np.arange(numbers.shape[1]))]
            if numbers.size
            else []
        )
    different, which = np.unique(numbers, axis=1, return_inverse=True)
    which = which.ravel()
    return [
        (np.ascontiguousarray(different[:, k]), np.flatnonzero(which == k))
        for k in range(different.shape[1])
    ]
