"""The page of `sms identify actuator`."""

from __future__ import annotations

from sms import _core
from sms.identification.actuator import BenchResult
from sms.identification.bench_result import sentences
from sms.report.bench_fit import bench_parts
from sms.report.markup import esc, section
from sms.report.panels import PanelsPage


def actuator_html(result: BenchResult) -> str:
    """The whole page as text; plotly.js is 2 MB of it."""
    return actuator_page(result).html


def actuator_page(result: BenchResult) -> PanelsPage:
    """Its parts, and the figures that they hold."""
    said = "".join(f"<li>{esc(text)}</li>" for text in sentences(result))
    parts = [
        f'<p class="eyebrow">Actuator identification · {esc(result.rig)}</p>'
        f"<h1>{esc(result.title)}</h1><ul class='said'>{said}</ul>"
    ]
    more, figures = bench_parts(result)
    parts += more
    findings = result.fit.records.findings
    if findings:
        items = "".join(f"<li>{esc(str(f))}</li>" for f in findings)
        parts.append(section("data-check", "Data check", f"<ul class='said'>{items}</ul>"))
    found = result.fit.found
    parts.append(
        f"<p class='small'>sms {_core.__version__}; {found.starts} starts, {found.minima} minima; "
        f"condition number {found.condition:.3g}</p>"
    )
    return PanelsPage(f"Actuator: {result.title}", parts, figures)
