"""Reference of the Python package: which modules are public, and a page for each."""

from __future__ import annotations

import importlib
import inspect
from collections.abc import Iterator
from types import ModuleType

from tools.site.prose import title

MODULES = (
    "sms",
    "sms.parameters",
    "sms.workspace",
    "sms.workspace_survey",
    "sms.design",
    "sms.errors",
    "sms.io",
    "sms.io.json_files",
    "sms.data",
    "sms.fmi",
    "sms.draft",
    "sms.schemas",
    "sms.diagnosis",
    "sms.diagnosis.result",
    "sms.diagnosis.own",
    "sms.diagnosis.design.detection_limits",
    "sms.history",
    "sms.report.files",
    "sms.identification.actuator",
    "sms.identification.flow",
    "sms.identification.flow_result",
    "sms.identification.flow_map",
    "sms.identification.friction",
    "sms.identification.spool",
    "sms.identification.noise",
    "sms.motion",
    "sms.scenario",
    "sms.sweep",
    "sms.comparison",
    "sms.requirements",
    "sms.validation",
    "sms.link.bus",
    "sms.link.codec",
    "sms.link.drive",
    "sms.link.monitor",
    "sms.link.motion",
    "sms.link.parameters",
    "sms.link.real_time",
    "sms.link.replay",
    "sms.link.rig_link",
    "sms.link.virtual_rig",
)
"""What docs/versions.md promises to keep; all else is the package's own."""


def public_names(module: ModuleType) -> list[str]:
    """Its __all__; without one, what it defines without an underscore."""
    listed = getattr(module, "__all__", None)
    if listed is not None:
        return sorted(listed)
    return sorted(
        name
        for name, value in vars(module).items()
        if not name.startswith("_")
        and (inspect.isfunction(value) or inspect.isclass(value))
        and value.__module__ == module.__name__
    )


def pages() -> Iterator[tuple[str, str]]:
    """(name, text) of every page."""
    for name in MODULES:
        module = importlib.import_module(name)
        out = [*title(f"``{name}``"), f".. automodule:: {name}", "   :no-members:", ""]
        out += [f".. currentmodule:: {name}", ""]
        for public in public_names(module):
            out += _entry(name, public, getattr(module, public))
        yield f"python/{name}", "\n".join(out) + "\n"


def _entry(module: str, name: str, value: object) -> list[str]:
    if inspect.isclass(value):
        shown = ["   :members:", "   :undoc-members:"]
        if issubclass(value, tuple | BaseException) or value.__module__ == "sms._core":
            shown = ["   :members:"]
        return [f".. autoclass:: {module}.{name}", *shown, ""]
    if callable(value) and not isinstance(value, dict):
        return [f".. autofunction:: {module}.{name}", ""]
    return [f".. autodata:: {module}.{name}", "   :no-value:", ""]
