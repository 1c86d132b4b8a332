"""An exported FMU in fmpy, by the names of its variables: one face for FMI 2.0 and 3.0."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from ctypes import byref
from pathlib import Path
from typing import Any

import fmpy
import numpy as np
from fmpy import fmi2, fmi3
from fmpy.fmi1 import FMICallException
from fmpy.logging import addLoggerProxy
from numpy.typing import NDArray
from sms.fmi import variables_of
from sms.simulation import Run

Array = NDArray[np.float64]

PERIOD = 1e-3
SAME = 1e-9
"""Of the range."""
RANGES = {"m": 0.4, "Pa": 5e5, "m/s": 0.5, "rad": 0.2, "rad/s": 1.0, "K": 300.0, "kg/s": 0.05}
RANGES |= {"m/s^2": 10.0, "N": 1e3, "V": 10.0, "V/s": 1e3, "rad/s^2": 10.0}
TOLERANCE = 1e-7
"""What `sms simulate` asks for, and the FMU."""

TIME = PERIOD * np.arange(800)

SAID: list[str] = []
"""The log of all instances: fmpy leads what FMUs of FMI 2.0 say to the logger that was made last."""


def _hear(*parts: Any) -> None:
    """The message comes last."""
    SAID.append(parts[-1].decode())


CALLBACKS = fmi2.fmi2CallbackFunctions()
CALLBACKS.logger = fmi2.fmi2CallbackLoggerTYPE(_hear)
CALLBACKS.allocateMemory = fmi2.fmi2CallbackAllocateMemoryTYPE(fmi2.calloc)
CALLBACKS.freeMemory = fmi2.fmi2CallbackFreeMemoryTYPE(fmi2.free)
addLoggerProxy(byref(CALLBACKS))


class Slave:
    """One instance. A refused call raises FMICallException, and the last of SAID says why."""

    def __init__(self, file: Path, folder: Path, token: str | None = None) -> None:
        self.description = fmpy.read_model_description(str(file))
        if not folder.exists():
            fmpy.extract(str(file), str(folder))
        self.is_2 = self.description.fmiVersion == "2.0"
        self._variables = {v.name: v for v in self.description.modelVariables}
        made = fmi2.FMU2Slave if self.is_2 else fmi3.FMU3Slave
        self.fmu: Any = made(
            guid=token or self.description.guid,
            unzipDirectory=str(folder),
            modelIdentifier=self.description.coSimulation.modelIdentifier,
            instanceName="one",
        )
        if self.is_2:
            self.fmu.instantiate(callbacks=CALLBACKS)
        else:
            self.fmu.instantiate(logMessage=_hear)
        self.time = 0.0

    def set(self, **values: float) -> None:
        """Variables by name; a dot is written as two underscores."""
        for name, value in values.items():
            variable = self._variables[name.replace("__", ".")]
            kind = "Real" if variable.type in ("Real", "Float64") else variable.type
            if kind == "Enumeration":
                kind = "Integer" if self.is_2 else "Int64"
            elif not self.is_2 and kind == "Real":
                kind = "Float64"
            getattr(self.fmu, f"set{kind}")([variable.valueReference], [value])

    def get(self, *names: str) -> list[float]:
        """Values of real variables."""
        places = [self._variables[name].valueReference for name in names]
        read = self.fmu.getReal if self.is_2 else self.fmu.getFloat64
        return [float(x) for x in read(places)]

    def begin(self, start: float = 0.0, **values: float) -> None:
        """Parameters and first inputs, then the end of initialization."""
        self.time = start
        if self.is_2:
            self.fmu.setupExperiment(startTime=start)
            self.fmu.enterInitializationMode()
        else:
            self.fmu.enterInitializationMode(startTime=start)
        self.set(**values)
        self.fmu.exitInitializationMode()

    def step(self, size: float) -> None:
        self.fmu.doStep(currentCommunicationPoint=self.time, communicationStepSize=size)
        self.time += size

    def state(self) -> bytes:
        """Serialised."""
        if self.is_2:
            state = self.fmu.getFMUstate()
            octets = self.fmu.serializeFMUstate(state)
            self.fmu.freeFMUstate(state)
        else:
            state = self.fmu.getFMUState()
            octets = self.fmu.serializeFMUState(state)
            self.fmu.freeFMUState(state)
        return bytes(octets)

    def go_to(self, octets: bytes, time: float) -> None:
        if self.is_2:
            self.fmu.setFMUstate(self.fmu.deSerializeFMUstate(octets))
        else:
            self.fmu.setFMUState(self.fmu.deserializeFMUState(octets))
        self.time = time

    def refused(self, call: Any) -> str:
        """The sentence with which a call is refused."""
        before = len(SAID)
        try:
            call()
        except FMICallException:
            assert len(SAID) == before + 1
            return SAID[-1]
        raise AssertionError("the call was not refused")


def simulated(
    file: Path,
    period: float,
    inputs: Mapping[str, Array],
    outputs: Sequence[str],
    starts: Mapping[str, float] | None = None,
) -> dict[str, Array]:
    """fmpy.simulate_fmu with one row of inputs a step; the outputs at the beginning of each step, (n,)."""
    count = len(next(iter(inputs.values())))
    time = period * np.arange(count)
    table = np.zeros(count, dtype=[("time", "f8"), *((name, "f8") for name in inputs)])
    table["time"] = time
    for name, values in inputs.items():
        table[name] = values
    result = fmpy.simulate_fmu(
        str(file),
        start_time=0.0,
        stop_time=float(time[-1]),
        output_interval=period,
        start_values=dict(starts or {}),
        input=table,
        output=list(outputs),
        fmi_type="CoSimulation",
    )
    return {name: np.asarray(result[name], dtype=np.float64) for name in outputs}


def unit_of(name: str, kind: str) -> str:
    return next(v.unit for v in variables_of(kind) if v.name == name)


def same(found: dict[str, Array], run: Run, kind: str) -> None:
    """Every output of the FMU is that column of the run, to 1e-9 of its range."""
    assert found
    for name, values in found.items():
        column = name.replace("reservoir_pressure", "supply_pressure")
        off = np.abs(values - run[column][: len(values)]).max()
        assert off <= SAME * RANGES[unit_of(name, kind)], (name, off)


def outputs_of(kind: str) -> list[str]:
    return [v.name for v in variables_of(kind) if v.causality in ("output", "local")]
