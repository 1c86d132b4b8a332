"""Units in modelDescription.xml: exponents of the base units of FMI, and the units in which people read them."""

from __future__ import annotations

from collections.abc import Iterable
from xml.etree import ElementTree as Xml

from sms.io.units import base_exponents

DISPLAYED = {"m": ("mm", 1e3), "Pa": ("bar", 1e-5), "rad": ("deg", 57.29577951308232)}


def unit_definitions(units: Iterable[str]) -> Xml.Element:
    """The element UnitDefinitions, the same in FMI 2.0 and 3.0; SI units, so without factors."""
    element = Xml.Element("UnitDefinitions")
    for unit in sorted(set(units) - {"1"}):
        defined = Xml.SubElement(element, "Unit", name=unit)
        exponents = {base: str(power) for base, power in base_exponents(unit).items()}
        Xml.SubElement(defined, "BaseUnit", exponents)
        if unit in DISPLAYED:
            name, factor = DISPLAYED[unit]
            Xml.SubElement(defined, "DisplayUnit", name=name, factor=repr(factor))
    return element
