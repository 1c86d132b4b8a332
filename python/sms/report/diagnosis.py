"""The diagnosis as one HTML file: no network, no server, readable without a manual."""

from __future__ import annotations

from sms.diagnosis.result import Diagnosis
from sms.report import curves, origin, related, search, verdict, worth
from sms.report.markup import section
from sms.report.page import page, plots


def report_html(diagnosis: Diagnosis) -> str:
    """The whole page as text, up to 4 MB, of which plotly.js is 2 MB.

    The order is that of a reader's questions: what is wrong and how much, what is it worth, why, what
    next; then can I see it, what else was tried, what is left, and what does all of it rest on.
    """
    parts = {
        "conclusion": ("Conclusion", verdict.conclusion(diagnosis)),
        "origin": ("Where from", origin.origin(diagnosis)),
        "curves": ("Curves", _curves(diagnosis)),
        "residual": ("Residual", _residuals(diagnosis)),
        "related": ("Related rigs", related.related(diagnosis)),
        "candidates": ("What was tried", search.candidates(diagnosis)),
        "not-testable": ("Not testable", search.not_testable(diagnosis)),
        "left": ("What is left", worth.remainder(diagnosis) if diagnosis.hidden is None else ""),
        "data-check": ("Data check", search.findings(diagnosis)),
        "provenance": ("Provenance", search.provenance(diagnosis)),
    }
    if diagnosis.verdict == "data-fault":
        parts = {"data-check": parts.pop("data-check")} | parts
        nothing = {
            "candidates": not diagnosis.candidates,
            "not-testable": not diagnosis.not_testable,
            "left": diagnosis.remainder is None,
        }
        parts = {name: part for name, part in parts.items() if not nothing.get(name)}
    links = "".join(
        f'<a href="#{name}">{title}</a>' for name, (title, text) in parts.items() if text
    )
    body = (
        '<main><div class="top">'
        f"{verdict.header(diagnosis)}{verdict.causes(diagnosis)}{worth.gain(diagnosis)}"
        f"{worth.next_experiment(diagnosis)}</div>"
        f'<nav aria-label="Parts of this page">{links}</nav>'
        f"{''.join(content for _, content in parts.values())}</main>"
    )
    scripts = plots(curves.payload(diagnosis), "figures.js") if diagnosis.series else None
    return page(f"Diagnosis: {diagnosis.title or diagnosis.rig}", body, scripts)


def _curves(diagnosis: Diagnosis) -> str:
    if not diagnosis.series:
        return ""
    lead = (
        "Above the signal, below the error (measured less simulated) on the same axis, with the "
        "noise floor as a band. Rows that are not compared, such as standstill, show the "
        "measurement alone."
    )
    if diagnosis.command:
        lead += f" {diagnosis.command}"
    if _drawn_over(diagnosis, "extension"):
        lead += " Over the extension, the strokes lie on top of each other."
    body = (
        f"{worth.key(diagnosis, 'measured', 'baseline', 'extended', 'floor')}"
        '<div id="records" role="group" aria-label="Record and signal"></div>'
        '<div class="buttons" id="views" role="group" aria-label="Horizontal axis"></div>'
        '<div id="lines" role="img" aria-label="Measured, baseline and extended, with the errors">'
        "</div>"
    )
    return section("curves", "Measured and simulated", body, lead)


def _drawn_over(diagnosis: Diagnosis, signal: str) -> bool:
    return any(name.startswith(signal) for s in diagnosis.series for name in s.inputs)


def _residuals(diagnosis: Diagnosis) -> str:
    if not diagnosis.series:
        return ""
    lead = (
        "The error of the compared rows against each signal. Triangles are means; where they lie flat "
        "on zero, nothing is left to explain along that signal."
    )
    if _drawn_over(diagnosis, "direction"):
        lead += (
            " They point up while extending and down while retracting. Two directions that part point "
            "to friction, two that move together to a force or a sensor."
        )
    body = (
        f"{worth.key(diagnosis, 'baseline', 'extended')}"
        '<div id="groups" role="group" aria-label="Records and signal shown"></div>'
        '<div id="residuals"></div>'
    )
    return section("residual", "Where the error lies", body, lead)
