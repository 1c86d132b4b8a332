"""The answer of `sms identify flow`: its sentences, its tables, its JSON and its parameter file."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from sms import _core
from sms.errors import InputError
from sms.identification.flow import FlowFit
from sms.identification.flow_map import MapCurve, SupplyComparison, compare_supplies, valve_map
from sms.identification.flow_problem import COMPONENT, SYMBOL
from sms.identification.flow_rig import supplies
from sms.io.records import Finding
from sms.views import Shown

COVERAGE = 2.0
"""Standard uncertainties of what the parameter file states, about 95 percent."""


@dataclass(frozen=True)
class FlowResult(Shown):
    """Everything `sms identify flow` found."""

    title: str
    rig: str
    heat: str
    heat_ratios: tuple[float, float]
    """In and out; C belongs to them (polytropic tank only)."""
    fits: tuple[FlowFit, ...]
    curves: tuple[MapCurve, ...]
    comparison: tuple[SupplyComparison, ...]
    findings: tuple[Finding, ...]

    @property
    def good(self) -> tuple[FlowFit, ...]:
        """The fits of records that say something."""
        return tuple(f for f in self.fits if f.found is not None)

    def sentences(self) -> list[str]:
        """What a reader should know first."""
        good = self.good
        said = [f"{len(good)} of {len(self.fits)} records could be fitted."]
        if good:
            u = [100.0 * f.combined / f.known[COMPONENT[0]].value for f in good]
            said.append(
                f"C is known to {min(u):.2g} to {max(u):.2g} % (one standard uncertainty, everything "
                f"in the budget); its largest part is {_largest_part(good)}."
            )
        for name in COMPONENT[1:]:
            told = sum(f.known[name].identifiable for f in good)
            said.append(
                f"{SYMBOL[name]} is identifiable in {told} of {len(good)} records; elsewhere only its "
                "interval is stated."
            )
        both = [f for f in good if math.isfinite(f.mae_classic)]
        if both:
            iso, classic = (
                float(np.mean([f.mae for f in both])),
                float(np.mean([f.mae_classic for f in both])),
            )
            said.append(
                f"Mean absolute error (eq. 5.16, noise included): {iso:.0f} Pa by the ISO law, "
                f"{classic:.0f} Pa by the classic one with its discharge coefficient fitted."
            )
        said += [_compared(c) for c in self.comparison]
        if good and len(supplies([f.record for f in good])) == 1:
            said.append(
                "Only one supply pressure: whether C, b and m depend on it cannot be seen; record a "
                "second one. C, b and m at this supply are identified."
            )
        if self.heat != "energy" and any(f.record.temperature is not None for f in good):
            said.append(
                'tank_temperature is recorded and not used: with chambers = "polytropic" the temperature in the tank '
                'is constant. To fit it with the pressure, write under [model]: chambers = "energy".'
            )
        missing = sum(f.record.spool is None for f in good)
        if missing:
            said.append(
                f"{missing} records do not say their spool position and are not in the valve map."
            )
        return said

    def to_dict(self) -> dict[str, Any]:
        """Everything, for programs; SI units."""
        return {
            "rig": self.rig,
            "title": self.title,
            "heat": self.heat,
            "heat_ratio_in": self.heat_ratios[0],
            "heat_ratio_out": self.heat_ratios[1],
            "sentences": self.sentences(),
            "findings": [str(f) for f in self.findings],
            "records": [_fit_dict(f) for f in self.fits],
            "map": [_curve_dict(c) for c in self.curves],
            "supplies": [vars(c) for c in self.comparison],
        }


def assemble(
    title: str,
    rig: str,
    heat: str,
    heat_ratios: tuple[float, float],
    fits: Sequence[FlowFit],
    findings: Sequence[Finding],
    monotone: bool,
) -> FlowResult:
    """The result of all fits."""
    return FlowResult(
        title, rig, heat, heat_ratios, tuple(fits), valve_map(fits, monotone),
        compare_supplies([f for f in fits if f.found is not None]), tuple(findings),
    )  # fmt: skip


def _largest_part(fits: Sequence[FlowFit]) -> str:
    parts = [max(f.budget, key=lambda line: line.uncertainty).name for f in fits if f.budget]
    name = max(set(parts), key=parts.count)
    return "the fit itself" if name == "fit" else name.replace("_", " ")


def _compared(c: SupplyComparison) -> str:
    pair = f"{1e-5 * c.low:.2f} and {1e-5 * c.high:.2f} bar"
    if c.significant <= 0.1 * c.positions:
        return f"{c.direction}: C at {pair} agrees within the fits' errors, as ISO 6358 assumes."
    return (
        f"{c.direction}: C at {1e-5 * c.high:.2f} bar is {100 * c.difference:+.1f} % against that at "
        f"{1e-5 * c.low:.2f} bar, beyond the fits' errors at {c.significant} of {c.positions} "
        "positions: one conductance does not describe this component with this model of the tank."
    )


def _fit_dict(f: FlowFit) -> dict[str, Any]:
    out: dict[str, Any] = {
        "record": f.record.name,
        "direction": f.direction,
        "supply_pressure": f.record.supply_pressure,
        "spool_position": f.record.spool,
        "notes": list(f.notes),
        "fitted": f.found is not None,
    }
    if f.found is None:
        return out
    found = f.found
    return out | {
        "parameters": {
            free.name: {"value": float(v), "standard_error": found.sd(free.name), "at_bound": bound}
            for free, v, bound in zip(found.free, found.value, found.at_bound, strict=True)
        },
        "covariance": found.covariance.tolist(),
        "intervals": {
            name: {
                "lower": k.lower, "upper": k.upper, "closed": k.closed,
                "identifiable": k.identifiable,
            }
            for name, k in f.known.items()
        },
        "budget": [{"name": c.name, "limits": c.limits, "uncertainty": c.uncertainty} for c in f.budget],
        "combined_uncertainty": f.combined,
        "noise": math.sqrt(found.colours[0].variance) / float(found.weight[0]),
        "samples_as_one": found.colours[0].samples_as_one,
        "condition": found.condition,
        "iterations": found.iterations,
        "converged": found.converged,
        "starts": found.starts,
        "minima": found.minima,
        "mae": f.mae,
        "mae_classic": f.mae_classic,
        "discharge_coefficient": None
        if f.classic is None
        else {
            "value": f.classic.params.discharge_coefficient,
            "standard_error": f.classic.sd("discharge_coefficient"),
        },
    }  # fmt: skip


def _curve_dict(c: MapCurve) -> dict[str, Any]:
    return {
        key: value.tolist() if isinstance(value, np.ndarray) else value
        for key, value in vars(c).items()
    }


# ---- the parameter file -----------------------------------------------------------------------------------


def parameter_file(result: FlowResult) -> str:
    """TOML: the valve map with its limits, and what it belongs to. `load_valve_map` reads it."""
    lines = [
        f"# Flow identified by sms {_core.__version__} from {result.rig}.",
        "# C in m^3/(s Pa), spool in m, pressures in Pa absolute; limits are 95 %.",
        "# C belongs to the heat model and ratios stated here: scale it by ratio here / ratio there.",
        "",
        "[flow]",
        f'heat = "{result.heat}"',
    ]
    if result.heat == "polytropic":
        lines += [f"heat_ratio_in = {result.heat_ratios[0]!r}"]
        lines += [f"heat_ratio_out = {result.heat_ratios[1]!r}"]
    for f in result.good:
        lines += [
            "",
            "[[component]]",
            f'record = "{f.record.name}"',
            f'direction = "{f.direction}"',
        ]
        lines.append(f"supply_pressure = {f.record.supply_pressure!r}")
        if f.record.spool is not None:
            lines.append(f"spool_position = {f.record.spool!r}")
        c = f.known[COMPONENT[0]]
        limits = COVERAGE * f.combined
        lines.append(f"sonic_conductance = {{ value = {c.value:.6g}, uncertainty = {limits:.3g} }}")
        for name, key in zip(COMPONENT[1:], ("critical_ratio", "subsonic_index"), strict=True):
            k = f.known[name]
            value = f"value = {k.value:.4g}, " if k.identifiable else "identifiable = false, "
            lines.append(f"{key} = {{ {value}lower = {k.lower:.4g}, upper = {k.upper:.4g} }}")
    for curve in result.curves:
        lines += ["", "[[map]]", f'direction = "{curve.direction}"']
        lines.append(f"supply_pressure = {curve.supply_pressure!r}")
        for key, values in _curve_dict(curve).items():
            if isinstance(values, list):
                lines.append(f"{key} = [{', '.join(_toml(v) for v in values)}]")
    return "\n".join(lines) + "\n"


def _toml(value: object) -> str:
    return str(value).lower() if isinstance(value, bool) else f"{value:.7g}"


def load_valve_map(path: Path) -> tuple[MapCurve, ...]:
    """The curves of a parameter file that `sms identify flow` wrote. InputError if it is none."""
    try:
        tables = tomllib.loads(path.read_text(encoding="utf-8"))
        return tuple(_read_curve(table) for table in tables["map"])
    except OSError as problem:
        raise InputError(f"{path}: cannot be read ({problem.strerror})") from None
    except (tomllib.TOMLDecodeError, KeyError, TypeError, ValueError):
        raise InputError(
            f"{path}: holds no valve map; give a flow.toml written by sms identify flow"
        ) from None


def _read_curve(table: Mapping[str, Any]) -> MapCurve:
    arrays = {k: np.array(v) for k, v in table.items() if isinstance(v, list)}
    return MapCurve(
        direction=str(table["direction"]),
        supply_pressure=float(table["supply_pressure"]),
        **arrays,
    )
