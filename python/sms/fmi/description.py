"""modelDescription.xml of FMI 2.0 and 3.0, and buildDescription.xml, from the variables of a model."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from xml.etree import ElementTree as Xml

from sms import _core
from sms.fmi.binary import Variable, token_of, variables_of
from sms.fmi.units import unit_definitions
from sms.parameters import PARAMETERS

_TITLES = {
    "bench": "One pneumatic actuator behind its valve, on the test bench",
    "platform": "Pneumatic motion platform on three actuators",
    "tank": "Tank of the flow test behind its valve",
    "controller": "Position controller of one actuator, sampled at its control period",
}


def identifier(kind: str) -> str:
    """The model identifier, hence the name of the binary."""
    return f"sms_{kind}"


def model_description(
    kind: str, version: str, starts: Mapping[str, float], sources: Sequence[str]
) -> str:
    """The text of modelDescription.xml. version: "2.0" or "3.0"; starts: by name, SI; sources: for FMI 2.0."""
    variables = variables_of(kind)
    root = _root(kind, version, starts)
    root.append(_co_simulation(kind, version, sources))
    root.append(unit_definitions(v.unit for v in variables))
    root.append(_types(variables, version))
    log = Xml.SubElement(root, "LogCategories")
    Xml.SubElement(log, "Category", name="logStatusError", description="Why a call was refused")
    period = starts.get("control_period", PARAMETERS["control_period"].default)
    Xml.SubElement(root, "DefaultExperiment", startTime="0", stopTime="10", stepSize=repr(period))
    listed = Xml.SubElement(root, "ModelVariables")
    write = _variable_2 if version == "2.0" else _variable_3
    for reference, variable in enumerate(variables):
        listed.append(write(reference, variable, starts.get(variable.name, variable.start)))
    root.append(_structure(variables, version))
    return _text(root)


def build_description(kind: str, sources: Sequence[str]) -> str:
    """The text of buildDescription.xml of FMI 3.0."""
    root = Xml.Element("fmiBuildDescription", fmiVersion="3.0")
    build = Xml.SubElement(
        root,
        "BuildConfiguration",
        modelIdentifier=identifier(kind),
        description="Needs the headers of Eigen 3.4 (MPL-2.0, https://gitlab.com/libeigen/eigen) on the include path",
    )
    files = Xml.SubElement(build, "SourceFileSet", language="C++14")
    for name in sources:
        Xml.SubElement(files, "SourceFile", name=name)
    Xml.SubElement(files, "IncludeDirectory", name=".")
    return _text(root)


def _root(kind: str, version: str, starts: Mapping[str, float]) -> Xml.Element:
    token = "guid" if version == "2.0" else "instantiationToken"
    attributes = {
        "fmiVersion": version,
        "modelName": identifier(kind),
        token: token_of(kind, starts),
        "description": _TITLES[kind],
        "version": _core.__version__,
        "license": "BSD-3-Clause",
        "generationTool": f"sms {_core.__version__}",
        "variableNamingConvention": "structured",
    }
    if version == "2.0":
        attributes["numberOfEventIndicators"] = "0"
    return Xml.Element("fmiModelDescription", attributes)


def _co_simulation(kind: str, version: str, sources: Sequence[str]) -> Xml.Element:
    state = "FMUstate" if version == "2.0" else "FMUState"
    element = Xml.Element(
        "CoSimulation",
        {
            "modelIdentifier": identifier(kind),
            "canHandleVariableCommunicationStepSize": "true",
            f"canGetAndSet{state}": "true",
            f"canSerialize{state}": "true",
        },
    )
    if version == "2.0":
        files = Xml.SubElement(element, "SourceFiles")
        for name in sources:
            Xml.SubElement(files, "File", name=name)
    return element


def _types(variables: Sequence[Variable], version: str) -> Xml.Element:
    element = Xml.Element("TypeDefinitions")
    for variable in variables:
        if variable.type != "enumeration":
            continue
        name = _type_name(variable)
        if version == "2.0":
            simple = Xml.SubElement(element, "SimpleType", name=name)
            defined = Xml.SubElement(simple, "Enumeration")
        else:
            defined = Xml.SubElement(element, "EnumerationType", name=name)
        for number, choice in enumerate(variable.choices, start=1):
            Xml.SubElement(defined, "Item", name=choice, value=str(number))
    if len(element) == 0:
        raise ValueError("every model has an enumeration")
    return element


def _type_name(variable: Variable) -> str:
    return f"{variable.name}_type"


def _variability(variable: Variable) -> str:
    if variable.causality == "parameter":
        return "fixed"
    return "discrete" if variable.sampled else "continuous"


def _declared(variable: Variable, start: float) -> dict[str, str]:
    """Unit, bounds and start value, as both standards write them."""
    attributes: dict[str, str] = {}
    if variable.type == "enumeration":
        return {"declaredType": _type_name(variable), "start": str(int(start))}
    if variable.type == "boolean":
        return {"start": "true" if start > 0.5 else "false"}
    if variable.unit != "1":
        attributes["unit"] = variable.unit
    for key, bound in (("min", variable.lower), ("max", variable.upper)):
        if bound is not None:
            attributes[key] = repr(bound)
    if variable.causality in ("parameter", "input"):
        attributes["start"] = repr(start)
    return attributes


def _named(reference: int, variable: Variable) -> dict[str, str]:
    attributes = {
        "name": variable.name,
        "valueReference": str(reference),
        "description": variable.doc,
        "causality": variable.causality,
        "variability": _variability(variable),
    }
    if variable.causality in ("output", "local"):
        attributes["initial"] = "calculated"
    return attributes


def _variable_2(reference: int, variable: Variable, start: float) -> Xml.Element:
    element = Xml.Element("ScalarVariable", _named(reference, variable))
    kind = {"real": "Real", "enumeration": "Enumeration", "boolean": "Boolean"}[variable.type]
    Xml.SubElement(element, kind, _declared(variable, start))
    return element


def _variable_3(reference: int, variable: Variable, start: float) -> Xml.Element:
    kind = {"real": "Float64", "enumeration": "Enumeration", "boolean": "Boolean"}[variable.type]
    return Xml.Element(kind, _named(reference, variable) | _declared(variable, start))


def _structure(variables: Sequence[Variable], version: str) -> Xml.Element:
    """All outputs; none depends at once on an input, and each follows from the parameters where a run begins."""
    element = Xml.Element("ModelStructure")
    outputs = [place for place, v in enumerate(variables) if v.causality == "output"]
    if version == "2.0":
        listed = Xml.SubElement(element, "Outputs")
        for place in outputs:
            Xml.SubElement(listed, "Unknown", index=str(place + 1), dependencies="")
        initial = Xml.SubElement(element, "InitialUnknowns")
        for place in outputs:
            Xml.SubElement(initial, "Unknown", index=str(place + 1))
        return element
    for name in ("Output", "InitialUnknown"):
        for place in outputs:
            unknown = Xml.SubElement(element, name, valueReference=str(place))
            if name == "Output":
                unknown.set("dependencies", "")
    return element


def _text(root: Xml.Element) -> str:
    Xml.indent(root)
    return (
        '<?xml version="1.0" encoding="UTF-8"?>\n' + Xml.tostring(root, encoding="unicode") + "\n"
    )
