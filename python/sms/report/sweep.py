"""A sweep as one HTML page: how the results spread, and over which parameter."""

from __future__ import annotations

import numpy as np
import pandas as pd
from scipy.stats import spearmanr

from sms import _core
from sms.arrays import Array
from sms.io.units import split_column_name
from sms.report.markup import esc, section, table
from sms.report.page import asset, page, plots
from sms.report.plots import Figure, Line, figures_html, payload
from sms.scenario.findings import quantity
from sms.sweep.plan import Sweep
from sms.units_display import axis_unit, words

_FIRST = ("roll_largest_error", "pitch_largest_error", "height_largest_error")
_OTHERS = ("extension_rms_error", "least_stroke", "arrival", "greatest_flow")


def main_metric(results: pd.DataFrame) -> str:
    """The column that the page is about: the largest error of the axis that moved most; of a tank its arrival."""
    named = {split_column_name(str(name))[0]: str(name) for name in results}
    for name in (*_FIRST, *_OTHERS):
        column = named.get(name)
        if column is None:
            continue
        if results[column].notna().any() and results[column].abs().max() > 0.0:
            return column
    return named["duration"]


def sentences(sweep: Sweep, results: pd.DataFrame) -> list[str]:
    """What the sweep says, a sentence each."""
    column = main_metric(results)
    name, unit = _split(column)
    values = results[column].to_numpy(dtype=np.float64)
    good = values[np.isfinite(values)]
    said = [f"{len(results)} variants of {sweep.scenario.name}; {words(name)} is shown."]
    if good.size:
        low, middle, high = np.quantile(good, [0.05, 0.5, 0.95])
        said.append(
            f"Its median is {quantity(middle, unit)}, 90 % of the variants lie between "
            f"{quantity(low, unit)} and {quantity(high, unit)}, the worst has "
            f"{quantity(float(good.max()), unit)}."
        )
    strongest = ranking(sweep, results, column)
    if strongest and np.isfinite(strongest[0][1]):
        said.append(
            f"It depends most on {words(strongest[0][0])} (rank correlation {strongest[0][1]:+.2f})."
        )
    ended = results["ended"].astype(str)
    if (ended != "").any():
        first = ended[ended != ""].iloc[0]
        said.append(f"{int((ended != '').sum())} variants did not run to their end: {first}")
    return said


def ranking(sweep: Sweep, results: pd.DataFrame, column: str) -> list[tuple[str, float]]:
    """Spearman's rank correlation of a result with each parameter, the strongest first."""
    values = results[column].to_numpy(dtype=np.float64)
    good = np.isfinite(values)
    found = []
    for name, given in zip(sweep.names, sweep.values.T, strict=True):
        if good.sum() < 3 or np.ptp(given[good]) == 0.0 or np.ptp(values[good]) == 0.0:
            found.append((name, float("nan")))
            continue
        found.append((name, float(spearmanr(given[good], values[good]).statistic)))
    return sorted(found, key=lambda entry: -abs(np.nan_to_num(entry[1])))


def sweep_html(sweep: Sweep, results: pd.DataFrame) -> str:
    """The whole page, of which plotly.js is 2 MB."""
    column = main_metric(results)
    name, unit = _split(column)
    shown = axis_unit(unit)
    label = f"{words(name)} in {shown.label}" if shown.label else words(name)
    values = shown.factor * results[column].to_numpy(dtype=np.float64)
    figures = [_spread(values, label)]
    for parameter, given in zip(sweep.names, sweep.values.T, strict=True):
        figures.append(_over(parameter, given, values, label, _unit_of(results, parameter)))
    rows = [
        [esc(words(parameter)), f"{rank:+.2f}" if np.isfinite(rank) else "n/a"]
        for parameter, rank in ranking(sweep, results, column)
    ]
    listed = "".join(f"<li>{esc(text)}</li>" for text in sentences(sweep, results))
    body = (
        f"<main><h1>Sweep of {esc(sweep.scenario.stem)}</h1><ul class='findings-list'>{listed}</ul>"
        + section("results", "Results", figures_html(figures))
        + section(
            "ranks",
            "Which parameter matters",
            table(
                f"Spearman's rank correlation with {words(name)}; 0 is none, ±1 all of it.",
                ("parameter", "rank correlation"),
                rows,
                "shares",
            ),
        )
        + f"<p class='small'>sms {_core.__version__}; {esc(sweep.path.name)}</p></main>"
    )
    return page("Sweep", body, plots(payload(figures), "plots.js"), asset("plots.css"))


def _spread(values: Array, label: str) -> Figure:
    ordered = np.sort(values[np.isfinite(values)])
    share = 100.0 * np.arange(1, ordered.size + 1) / max(ordered.size, 1)
    line = Line(
        "", ordered, share, "extended", mode="lines+markers" if ordered.size < 50 else "lines"
    )
    note = "How many variants stay below a value."
    return Figure("spread", "Spread", label, "variants in %", [line], note, wide=True)


def _over(parameter: str, given: Array, values: Array, label: str, unit: str) -> Figure:
    shown = axis_unit(unit)
    title = f"{words(parameter)} in {shown.label}" if shown.label else words(parameter)
    line = Line("", shown.factor * given, values, "extended", mode="markers")
    return Figure(f"over-{parameter}", f"Over {words(parameter)}", title, label, [line])


def _split(column: str) -> tuple[str, str]:
    name, unit = split_column_name(column)
    return name, unit or "1"


def _unit_of(results: pd.DataFrame, parameter: str) -> str:
    for column in results:
        name, unit = _split(str(column))
        if name == parameter:
            return unit
    return "1"
