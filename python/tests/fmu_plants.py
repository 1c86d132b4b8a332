"""The two tanks as FMUs, compiled here: both standards, both interfaces, with and without directional derivatives."""

from __future__ import annotations

import shutil
import subprocess
import zipfile
from functools import cache
from pathlib import Path
from tempfile import mkdtemp

import pytest

FIXED = 'causality="parameter" variability="fixed" initial="exact"'
HERE = Path(__file__).parent / "fmu"
HEADERS = Path(__file__).parents[2] / "libsms" / "fmi" / "third_party"
PARAMETERS = {
    "pump_gain": (7, 3.3e-6), "outlet_upper": (8, 17.8e-6), "outlet_lower": (9, 17.8e-6), "pump_dead_band": (10, 0.0),
    "leak_upper": (11, 0.0), "leak_lower": (12, 0.0), "gain_upper": (13, 0.0), "gain_lower": (14, 0.0),
    "offset_upper": (15, 0.0), "offset_lower": (16, 0.0),
}  # fmt: skip


def tanks_fmu(
    folder: Path,
    version: int,
    directional: bool = True,
    events: int = 0,
    internal: float = 0.0,
    rain: float = 0.0,
    planned: float = 0.0,
) -> Path:
    """tanks.fmu in a folder; internal: s, of the steps in which it moves; rain: m^3/s, of a flow that swings with time;
    planned: s, of an event. Skips where there is no compiler."""
    file = (
        folder / f"tanks{version}{'' if directional else '_plain'}{'_events' if events else ''}.fmu"
    )
    here = "linux64" if version == 2 else "x86_64-linux"
    with zipfile.ZipFile(file, "w") as archive:
        archive.write(_library(version, internal, rain, planned), f"binaries/{here}/tanks.so")
        text = _description(version, directional, events)
        if internal:
            step = f'<DefaultExperiment stepSize="{internal}"/><ModelVariables>'
            text = text.replace("<ModelVariables>", step)
        archive.writestr("modelDescription.xml", text)
    return file


@cache
def _library(version: int, internal: float, rain: float, planned: float) -> Path:
    compiler = shutil.which("cc") or shutil.which("gcc")
    if compiler is None:
        pytest.skip("no C compiler here")
    out = Path(mkdtemp()) / f"tanks{version}.so"
    subprocess.run(
        [compiler, "-O2", "-shared", "-fPIC", f"-DFMI={version}", f"-DINTERNAL={internal}", f"-DRAIN={rain}",
         f"-DPLANNED={planned}", f"-I{HEADERS}",
         str(HERE / "tanks.c"), str(HERE / "never_called.c"), "-lm", "-o", str(out)],
        check=True,
    )  # fmt: skip
    return out


def _description(version: int, directional: bool, events: int) -> str:
    variables = [
        ("level_upper", 0, 'causality="output" variability="continuous" initial="exact"', 0.05, ""),
        ("level_lower", 1, 'causality="output" variability="continuous" initial="exact"', 0.05, ""),
        ("rate_upper", 2, 'causality="local" variability="continuous"', None, 'derivative="{}"'),
        ("rate_lower", 3, 'causality="local" variability="continuous"', None, 'derivative="{}"'),
        ("pump_voltage", 4, 'causality="input" variability="continuous"', 0.0, ""),
        ("gauge_upper", 5, 'causality="output" variability="continuous"', None, ""),
        ("gauge_lower", 6, 'causality="output" variability="continuous"', None, ""),
        *((n, r, FIXED, v, "") for n, (r, v) in PARAMETERS.items()),
    ]  # fmt: skip
    lines = []
    for name, reference, role, start, rate in variables:
        begin = "" if start is None else f' start="{start!r}"'
        of = rate.format(reference - 1 if version == 2 else reference - 2)
        if version == 2:
            real = f"<Real{begin} {of}/>"
            lines.append(
                f'<ScalarVariable name="{name}" valueReference="{reference}" {role}>{real}</ScalarVariable>'
            )
        else:
            lines.append(
                f'<Float64 name="{name}" valueReference="{reference}" {role}{begin} {of}/>'
            )
    if version == 2:
        flag = f'providesDirectionalDerivative="{str(directional).lower()}"'
        units = "".join(f'<Unknown index="{k}"/>' for k in (1, 2, 6, 7))
        rates = '<Unknown index="3"/><Unknown index="4"/>'
        return (
            '<?xml version="1.0" encoding="UTF-8"?><fmiModelDescription fmiVersion="2.0" modelName="tanks" '
            f'guid="{{tanks}}" numberOfEventIndicators="{events}"><ModelExchange modelIdentifier="tanks" {flag}/>'
            "<CoSimulation "
            f'modelIdentifier="tanks" canHandleVariableCommunicationStepSize="true" {flag}/><ModelVariables>'
            f"{''.join(lines)}</ModelVariables><ModelStructure><Outputs>{units}</Outputs><Derivatives>{rates}"
            "</Derivatives></ModelStructure></fmiModelDescription>"
        )
    lines.append(
        '<Float64 name="time" valueReference="90" causality="independent" variability="continuous"/>'
    )
    flag = f'providesDirectionalDerivatives="{str(directional).lower()}"'
    if events:
        lines.append('<Float64 name="indicator" valueReference="99" causality="local"/>')
    structure = "".join(f'<Output valueReference="{k}"/>' for k in (0, 1, 5, 6))
    structure += "".join(f'<ContinuousStateDerivative valueReference="{k}"/>' for k in (2, 3))
    structure += '<EventIndicator valueReference="99"/>' * bool(events)
    return (
        '<?xml version="1.0" encoding="UTF-8"?><fmiModelDescription fmiVersion="3.0" modelName="tanks" '
        f'instantiationToken="tanks"><ModelExchange modelIdentifier="tanks" {flag}/><CoSimulation '
        f'modelIdentifier="tanks" canHandleVariableCommunicationStepSize="true" {flag}/><ModelVariables>'
        f"{''.join(lines)}</ModelVariables><ModelStructure>{structure}</ModelStructure></fmiModelDescription>"
    )
