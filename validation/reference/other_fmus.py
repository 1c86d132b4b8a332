"""Other people's FMUs as plants: one line each, what it has, and a run held against fmpy's own, or why it is refused.

python -m validation.reference.other_fmus FILE.fmu ...

Those that docs/fmu_plants.md names are of the FMI project's reference set, built from its sources.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

import fmpy
import numpy as np
from sms.diagnosis.own.fmu_calls import Fmu, Interface, Names
from sms.diagnosis.own.fmu_plant import Exchange, Slave
from sms.errors import InputError

STEP, SAMPLES = 0.01, 501
"""s between samples, and how many."""


def run(file: Path, interface: Interface) -> str:
    """The states after 5 s from their start values, and how far fmpy's simulation is from them."""
    fmu = Fmu(file, interface)
    states = [u.variable.derivative.name for u in fmu.description.derivatives]
    if not states:
        raise InputError("it has no continuous states")
    for name in states:
        fmu.variable(name, "state")
    names = Names(states, [], states, [])
    plant = (Exchange if interface == "model_exchange" else Slave)(fmu, names, ())
    x = np.array([[float(fmu.variables[n].start)] for n in states])
    none, h, still = np.empty((0, 1)), np.full(1, STEP), np.zeros_like(x)
    path = [x]
    for _ in range(SAMPLES - 1):
        path.append(plant.advance(np.zeros((1, 1)), path[-1], (none, none), (still, still), h))
    found = np.hstack(path).T
    theirs = fmpy.simulate_fmu(
        str(file),
        stop_time=STEP * (SAMPLES - 1),
        output_interval=STEP,
        fmi_type="ModelExchange" if interface == "model_exchange" else "CoSimulation",
        relative_tolerance=1e-9,
        output=states,
    )
    wanted = np.column_stack([theirs[n] for n in states])
    off = float(np.abs(found - wanted).max() / np.ptp(wanted, axis=0).max())
    said = ", ".join(f"{n} {v:.4g}" for n, v in zip(states, found[-1], strict=True))
    slopes = " with directional derivatives" if fmu.directional else ""
    return f"FMI {fmu.description.fmiVersion} {interface}{slopes}: {said}; off fmpy's own by {off:.1e} of range"


def main(arguments: Sequence[str] | None = None) -> int:
    """Print one line for each FMU and interface."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("fmu", nargs="+", type=Path)
    interfaces: tuple[Interface, Interface] = ("model_exchange", "co_simulation")
    for file in parser.parse_args(arguments).fmu:
        for interface in interfaces:
            try:
                print(f"{file.stem}: {run(file, interface)}")
            except InputError as refused:
                print(
                    f"{file.stem}, {interface}: refused: {str(refused).removeprefix(f'{file}: ')}"
                )
    return 0


if __name__ == "__main__":
    sys.exit(main())
