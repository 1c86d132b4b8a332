"""What a notebook shows of a result: head, sentences and tables of its page, and its figures one by one."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial, singledispatch
from inspect import signature

import numpy as np
import plotly.graph_objects as go  # type: ignore[import-untyped]

from sms.diagnosis.result import Diagnosis
from sms.identification.actuator import BenchResult
from sms.identification.flow_result import FlowResult
from sms.identification.friction import FrictionResult
from sms.identification.spool import SpoolResult
from sms.report import verdict, workspace, worth
from sms.report.actuator import actuator_page
from sms.report.answer_figures import figures_of_diagnosis
from sms.report.flow import flow_page
from sms.report.friction import friction_page
from sms.report.markup import esc, table
from sms.report.page import asset
from sms.report.panels import PanelsPage
from sms.report.plotly_figures import of_figure, of_view
from sms.report.plots import Figure, Line
from sms.report.spool import spool_page
from sms.simulation import Run
from sms.workspace_survey import Survey

_NOTEBOOK = "& { padding: 12px 16px; } table { color: inherit; }"


@dataclass(frozen=True)
class View:
    """HTML, and by name what draws a figure."""

    html: str
    figures: Mapping[str, Callable[..., go.Figure]]


def html_of(result: object) -> str:
    """For `_repr_html_`: the page's own style, kept to this output."""
    style = asset("style.css").replace(":root:not([data-paper])", "&").replace(":root", "&")
    style = style.replace("\nbody {", "\n& {") + _NOTEBOOK
    return f'<div class="sms-view"><style>.sms-view {{ {style} }}</style>{_view(result).html}</div>'


def figure_of(result: object, name: str, **chosen: str | int) -> go.Figure:
    """One figure. ValueError that names what there is."""
    figures = _view(result).figures
    if name not in figures:
        there = f"there is {', '.join(figures)}" if figures else "it has none"
        raise ValueError(f"no figure '{name}': {there}")
    may = signature(figures[name]).parameters
    for said in chosen:
        if said not in may:
            there = f"{', '.join(may)} can" if may else "nothing can"
            raise ValueError(f"figure '{name}': no choice '{said}'; {there} be chosen of it")
    return figures[name](**chosen)


@singledispatch
def _view(result: object) -> View:
    raise TypeError(f"{type(result).__name__} has no view")


@_view.register
def _of_diagnosis(d: Diagnosis) -> View:
    parts = verdict.header(d), verdict.causes(d), worth.gain(d), verdict.conclusion(d)
    return View("".join((*parts, worth.next_experiment(d))), figures_of_diagnosis(d))


# ---- identified ------------------------------------------------------------------------------------


def _of_panels(page: PanelsPage) -> View:
    def draw(name: str, number: int = 0) -> go.Figure:
        views = page.figures[name]
        if not 0 <= number < len(views):
            raise ValueError(f"figure '{name}' has numbers 0 to {len(views) - 1}, not {number}")
        return of_view(views[number])

    return View(page.without_figures, {name: partial(draw, name) for name in page.figures})


@_view.register
def _of_bench(result: BenchResult) -> View:
    return _of_panels(actuator_page(result))


@_view.register
def _of_flow(result: FlowResult) -> View:
    return _of_panels(flow_page(result))


@_view.register
def _of_friction(result: FrictionResult) -> View:
    return _of_panels(friction_page(result))


@_view.register
def _of_spool(result: SpoolResult) -> View:
    return _of_panels(spool_page(result))


# ---- simulated, reached ----------------------------------------------------------------------------


@_view.register
def _of_run(run: Run) -> View:
    """Every column in SI: where it begins and ends, and between what it moves."""
    rows = [
        (esc(name), *(f"{v:.6g}" for v in (c[0], c.min(), c.max(), c[-1])))
        for name in run.columns
        if (c := run[name]).size
    ]
    lasted = f"{run.time[-1] - run.time[0]:.4g} s" if run.time.size else "nothing"
    lead = f"{lasted} simulated in {run.steps} steps, {run.time.size} rows; SI units"
    head = ("Column", "begin", "least", "largest", "end")
    return View(
        table(lead, head, rows), {name: partial(_column, run, name) for name in _names(run)}
    )


def _names(run: Run) -> list[str]:
    """Columns, and those that each leg has under one name."""
    legs = [n.removesuffix("_1") for n in run.columns if n.endswith("_1")]
    return [*run.columns, *(n for n in legs if n not in run.columns)]


def _column(run: Run, name: str) -> go.Figure:
    of = [name] if name in run.columns else [f"{name}_{leg}" for leg in (1, 2, 3)]
    lines = [Line(n if len(of) > 1 else "", run.time, run[n], "" if len(of) > 1 else "extended")
             for n in of if n in run.columns]  # fmt: skip
    return of_figure(Figure(name, name.replace("_", " "), "time [s]", f"{name} [SI]", lines))


@_view.register
def _of_survey(survey: Survey) -> View:
    return View(workspace.sentences_and_numbers(survey), {"region": partial(_region, survey)})


def _region(survey: Survey) -> go.Figure:
    """Roll and pitch that the strokes allow, a line a height."""
    lines = [
        Line(f"{1e3 * survey.heights[row]:.0f} mm", np.degrees(roll), np.degrees(pitch))
        for row in workspace.drawn_heights(survey)
        for roll, pitch in [survey.outline(row)]
    ]
    drawn = of_figure(Figure("region", "Roll and pitch by height", "roll [°]", "pitch [°]", lines))
    return drawn.update_yaxes(scaleanchor="x")
