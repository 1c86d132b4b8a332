"""What was tested, what could not be tested, and what the search rests on."""

from __future__ import annotations

import math
from itertools import groupby

from sms.diagnosis.result import Candidate, Diagnosis, Finding, ParameterValue
from sms.report.markup import Scale, bar, effect_label, empty, esc, section, table
from sms.report.verdict import is_shift, parameter_text
from sms.units_display import (
    MISSING,
    format_change,
    format_estimate,
    format_interval,
    format_p_value,
    format_percent,
    words,
)

_PRINTED, _FEWEST_PRINTED = 10, 3  # rows of a long table on paper; of one round
_WORST_SHOWN = -0.5
"""Bars of candidates that make things worse than this are cut off here; the number stays."""


def candidates(diagnosis: Diagnosis) -> str:
    """Every effect tried, a table for each round of the search."""
    title = "Effects tested"
    if not diagnosis.candidates:
        return section("candidates", title, empty("No effect was tested."))
    lead = (
        "Forward selection: each round fits every identifiable effect alone to the identification records, on top "
        "of what was selected before, and measures by how much it reduces the squared error of the validation "
        "records. A negative reduction makes them worse."
    )
    ordered = sorted(diagnosis.candidates, key=lambda c: c.round)
    printed = max(_PRINTED // max(len({c.round for c in ordered}), 1), _FEWEST_PRINTED)
    rounds = "".join(
        _round(number, list(group), printed)
        for number, group in groupby(ordered, key=lambda c: c.round)
    )
    return section("candidates", title, rounds, lead)


def _round(number: int, tried: list[Candidate], printed: int) -> str:
    tried.sort(key=lambda c: (not c.accepted, -c.gain if math.isfinite(c.gain) else math.inf))
    lows = [min(c.gain, c.gain_low) for c in tried if math.isfinite(c.gain + c.gain_low)]
    scale = Scale(max(min([0.0, *lows]), _WORST_SHOWN), 1.0)
    rows = [
        (
            effect_label(c.effect, c.signal),
            bar(
                scale,
                c.gain,
                "accepted" if c.accepted else "rejected",
                (c.gain_low, c.gain_high),
            ),
            f'<span class="number">{esc(_gain_text(c))}</span>',
            "<br>".join(_estimate(p) for p in c.parameters) or MISSING,
            f'<span class="nowrap">{esc(format_p_value(c.p_value))}</span>',
            f'<span class="{"yes" if c.accepted else "no"}">'
            f"{'✓ accepted' if c.accepted else '✗ not accepted'}</span> {esc(c.reason)}",
        )
        for c in tried
    ]
    accepted = sum(c.accepted for c in tried)
    plural = "" if len(tried) == 1 else "s"
    summary = f"Round {number}: {len(tried)} effect{plural} tested, {accepted} accepted"
    headers = (
        "Effect",
        "",
        "Reduction on validation records, 95 %",
        "Fitted",
        "p-value",
        "Decision",
    )
    return (
        f"<details open><summary>{summary}</summary>"
        f"{table(f'Round {number}', headers, rows, 'candidates', printed)}</details>"
    )


def _gain_text(c: Candidate) -> str:
    if not math.isfinite(c.gain):
        return MISSING
    return f"{format_percent(c.gain)} ({format_interval(c.gain_low, c.gain_high)})"


def _estimate(parameter: ParameterValue) -> str:
    return f'<span class="nowrap">{esc(parameter_text(parameter, is_shift(parameter)))}</span>'


def not_testable(diagnosis: Diagnosis) -> str:
    """The effects about which these records say nothing: neither present nor absent."""
    title = "Not identifiable from these records"
    if not diagnosis.not_testable:
        text = "Every effect of the catalogue could be tested."
        return section(
            "not-testable", title, empty(text if diagnosis.candidates else "Not examined.")
        )
    lead = "No value is claimed for these effects, and none is excluded."
    rows = [(effect_label(n.effect, n.signal), esc(n.reason)) for n in diagnosis.not_testable]
    body = table("Effects not testable", ("Effect", "Why not"), rows, "wide-last", _PRINTED)
    return section("not-testable", title, body, lead)


def findings(diagnosis: Diagnosis) -> str:
    """What the data check has to say."""
    title = "The data check"
    if not diagnosis.findings:
        text = "Nothing to report: units, time, gaps, NaN, stuck or saturated channels, length."
        return section("data-check", title, empty(text))
    rows = [
        (
            f'<span class="severity {esc(f.severity)}">{esc(f.severity)}</span>',
            _place(f),
            esc(f.message),
            esc(f.remedy),
        )
        for f in sorted(diagnosis.findings, key=lambda f: _WEIGHTS.get(f.severity, 1))
    ]
    headers = ("Severity", "Location", "Finding", "Remedy")
    return section("data-check", title, table("Findings", headers, rows, "findings", _PRINTED))


_WEIGHTS = {"error": 0, "warning": 1, "note": 2}


def _place(finding: Finding) -> str:
    line = f", line {finding.line}" if finding.line is not None else ""
    signal = f", {esc(words(finding.signal))}" if finding.signal else ""
    return f"<code>{esc(finding.file)}</code>{line}{signal}"


def provenance(diagnosis: Diagnosis) -> str:
    """What the answer rests on: parameters, records, seed, versions."""
    records = table(
        "Records",
        ("Record", "Role"),
        [(esc(name), esc(role)) for name, role in diagnosis.records.items()],
        on_paper=_PRINTED,
    )
    fitted = table(
        "Parameters of the baseline",
        ("Parameter", "Before \N{RIGHTWARDS ARROW} fitted"),
        [
            (f"<code>{esc(p.name)}</code>", f'<span class="nowrap">{esc(_before_after(p))}</span>')
            for p in diagnosis.baseline
        ],
        on_paper=_PRINTED,
    )
    beside = table(
        "Parameters fitted beside the causes",
        ("Parameter", "Declared \N{RIGHTWARDS ARROW} fitted"),
        [
            (f"<code>{esc(p.name)}</code>", f'<span class="nowrap">{esc(_before_after(p))}</span>')
            for p in diagnosis.refitted
        ],
        on_paper=_PRINTED,
    )
    versions = table(
        "Made with",
        ("What", "Version"),
        [("rig", esc(diagnosis.rig)), ("seed", str(diagnosis.seed))]
        + ([("command", esc(diagnosis.command))] if diagnosis.command else [])
        + [(esc(name), esc(version)) for name, version in diagnosis.versions.items()],
    )
    parts = [
        records if diagnosis.records else empty("No records."),
        fitted if diagnosis.baseline else "",
        beside if diagnosis.refitted else "",
        versions,
    ]
    columns = "".join(f"<div>{part}</div>" for part in parts if part)
    return section("provenance", "Provenance", f'<div class="columns">{columns}</div>')


def _before_after(p: ParameterValue) -> str:
    if math.isfinite(p.old_value):
        return format_change(p.old_value, p.value, p.standard_error, p.unit, p.name)
    return format_estimate(p.value, p.standard_error, p.unit, p.name)
