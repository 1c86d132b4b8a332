"""Improvement on the validation records, the residual, and the next experiment."""

from __future__ import annotations

import math
from collections.abc import Sequence

from sms.diagnosis.remainder import Remainder, Unexplained
from sms.diagnosis.result import Diagnosis, FreeRun, Gain, InUse
from sms.diagnosis.wording import ARRANGED
from sms.diagnosis.wording_simulated import free_run_in_words, worst_free_runs
from sms.report.markup import (
    Scale,
    bar,
    effect_label,
    empty,
    esc,
    printed_in_part,
    section,
    swatch,
    table,
)
from sms.units_display import (
    capital,
    format_aligned,
    format_interval,
    format_percent,
    format_quantity,
    words,
)

_LEGEND = (
    ("measured", "Measured", "the record"),
    (
        "baseline",
        "Baseline",
        "the simulation with every parameter fitted within its declared uncertainty",
    ),
    ("extended", "Extended", "the same with the causes named here"),
    (
        "floor",
        "Noise floor",
        "what does not repeat from stroke to stroke, which no model can explain",
    ),
)


_FLOOR_OF_A_SIMULATION = "what changes from sample to sample, which no model can explain"
PRINTED = 4  # records and signals on paper; paper.css knows the number too
TESTED = ' <span class="role">test: took no part in any choice</span>'


def key(diagnosis: Diagnosis, *kinds: str) -> str:
    """The colours alone, beside a figure that shows these kinds."""
    items = "".join(
        f"<span>{swatch(kind)}{name}</span>"
        for kind, name, _ in _LEGEND
        if kind in kinds and (diagnosis.causes or kind != "extended")
    )
    return f'<p class="key">{items}</p>'


def legend(diagnosis: Diagnosis) -> str:
    """The words and colours used on the whole page; without a cause there is no extended model."""
    simulated = diagnosis.hidden is not None
    items = "".join(
        f"<dt>{swatch(kind)}{name}</dt><dd>{_FLOOR_OF_A_SIMULATION if kind == 'floor' and simulated else text}</dd>"
        for kind, name, text in _LEGEND
        if diagnosis.causes or kind != "extended"
    )
    if not diagnosis.gain and not diagnosis.series:
        return ""
    return f'<dl class="legend">{items}</dl>'


def gain(diagnosis: Diagnosis) -> str:
    """Error before and after on each validate record, as bars with interval, and what it means in use."""
    title = "Improvement" if diagnosis.causes else "Simulation error"
    if not diagnosis.gain:
        return section("worth", title, empty("No record was judged, so no improvement is claimed."))
    extended = "Extended" if diagnosis.causes else ""
    first = _worst_of_each(diagnosis.gain)
    body = gain_table(first, extended)
    if len(first) < len(diagnosis.gain):
        rest = gain_table([g for g in diagnosis.gain if g not in first], extended)
        body += (
            f"<details><summary>The other {len(diagnosis.gain) - len(first)} of "
            f"{len(diagnosis.gain)} records and signals</summary>{rest}</details>"
        )
    body += _free_runs(diagnosis) + _in_use(diagnosis.in_use)
    return section("worth", title, body + legend(diagnosis))


def _worst_of_each(gains: Sequence[Gain]) -> list[Gain]:
    """Of several signals, the record in which each is furthest off; of one signal, all records."""
    signals = list(dict.fromkeys(g.signal for g in gains))
    if len(signals) == 1:
        return list(gains)
    return [max((g for g in gains if g.signal == s), key=lambda g: g.baseline_rms) for s in signals]


def _free_runs(diagnosis: Diagnosis) -> str:
    """The worst of each signal; the others folded away."""
    runs = diagnosis.free_run
    if not runs:
        return ""
    first = worst_free_runs(runs)
    body = _free_run_table(first, bool(diagnosis.causes))
    if len(first) < len(runs):
        rest = _free_run_table([r for r in runs if r not in first], bool(diagnosis.causes))
        body += f"<details><summary>The other {len(runs) - len(first)} free runs</summary>{rest}</details>"
    return body


def _free_run_table(runs: Sequence[FreeRun], extended: bool) -> str:
    rows = []
    for run in runs:
        before, after = map(esc, free_run_in_words(run))
        where = f"<strong>{esc(run.record)}</strong>, {esc(words(run.signal))}{TESTED if run.role == 'test' else ''}"
        rows.append((where, before, after) if extended else (where, before))
    caption = (
        "RMS error of a free run over the whole record, from the initial state that fits it best"
    )
    head = ("Record and signal", "Baseline", "Extended")
    return table(caption, head if extended else head[:2], rows, "in-use", on_paper=PRINTED)


def _in_use(quantities: Sequence[InUse]) -> str:
    """Rise time, bandwidth, error of following: without and with the causes."""
    if not quantities:
        return ""
    rows = []
    for q in quantities:
        old, new = format_aligned([q.baseline, q.extended], q.unit)
        change = q.extended / q.baseline - 1.0
        rows.append(
            (
                esc(capital(q.name)),
                f'<span class="nowrap">{esc(old)} \N{RIGHTWARDS ARROW} {esc(new)}</span>',
                esc(format_percent(change, signed=True)),
            )
        )
    caption = "In closed loop: what either model predicts under a position controller of 10 V/m"
    return table(caption, ("Quantity", "Predicted", "Change"), rows, "in-use")


def gain_table(gains: Sequence[Gain], extended: str) -> str:
    """Errors without and with an extension of that name, as bars; without one if it is empty."""
    tops: dict[str, float] = {}
    for g in gains:
        ends = Scale.over([0.0, tops.get(g.unit, 0.0), g.baseline_rms, *_interval(g)])
        tops[g.unit] = 1.02 * ends.high
    rows = "".join(_gain_rows(g, Scale(0.0, tops[g.unit]), extended) for g in gains)
    interval = "; whisker and brackets: 95 % interval" if extended else ""
    return (
        '<table class="gain"><caption>RMS error on records that the fit has not seen'
        f"{interval}</caption>{rows}</table>{printed_in_part(PRINTED, len(gains))}"
    )


def _interval(g: Gain) -> tuple[float, float]:
    """The extended model's RMS error, 95 percent interval."""
    return (
        g.baseline_rms * (1.0 - g.reduction_high),
        g.baseline_rms * (1.0 - g.reduction_low),
    )


def _gain_rows(g: Gain, scale: Scale, extended: str) -> str:
    bars: list[tuple[str, float, tuple[float, float] | None]] = [
        ("baseline", g.baseline_rms, None),
        ("extended", g.extended_rms, _interval(g)),
        ("floor", g.noise_floor, None),
    ]
    names = {"baseline": "Baseline", "extended": extended, "floor": "Noise floor"}
    if not extended:
        del bars[1]
    texts = format_aligned([value for _, value, _ in bars], g.unit)
    lines = "".join(
        f'<tr><th scope="row">{swatch(kind)}{names[kind]}</th>'
        f"<td>{bar(scale, value, kind, interval, marks=())}</td>"
        f'<td class="number">{esc(text)}</td></tr>'
        for (kind, value, interval), text in zip(bars, texts, strict=True)
    )
    within = format_interval(-g.reduction_high, -g.reduction_low, signed=True)
    change = (
        f'<span class="reduction">{esc(format_percent(-g.reduction, signed=True))}</span> '
        f'<span class="small nowrap">({esc(within)})</span>'
        if extended
        else ""
    )
    head = (
        f'<tr><th scope="rowgroup" colspan="3"><strong>{esc(g.record)}</strong>, '
        f"{esc(words(g.signal))}{TESTED if g.role == 'test' else ''} {change}</th></tr>"
    )
    return f"<tbody>{head}{lines}{_refitted(g) if extended else ''}</tbody>"


def _refitted(g: Gain) -> str:
    """The same errors where what is declared uncertain was fitted again, if that makes a difference."""
    again = (g.baseline_refitted_rms, g.extended_refitted_rms)
    if not all(map(math.isfinite, again)) or again == (g.baseline_rms, g.extended_rms):
        return ""
    before, after = format_aligned(again, g.unit)
    return (
        '<tr><td colspan="3" class="small">with the parameters of declared uncertainty refitted to this record: '
        f"{esc(before)} \N{RIGHTWARDS ARROW} {esc(after)}</td></tr>"
    )


def _by_signal(left: Unexplained, diagnosis: Diagnosis) -> str:
    """What is left in each signal, beside the noise and what declared uncertainties make tolerable."""
    unit = {g.signal: g.unit for g in diagnosis.gain}
    rows = [
        (
            esc(words(s)),
            *map(esc, format_aligned([left.rms[s], left.floor[s], left.tolerated[s]], unit[s])),
        )
        for s in left.rms
        if s in unit
    ]
    head = ("Signal", "Residual", "Noise floor", "Tolerated beyond it")
    return table("RMS on the validation records", head, rows, "left-by-signal")


def remainder(diagnosis: Diagnosis) -> str:
    """What is still unexplained: its size, whether it repeats, and where it lies."""
    title, left = "Residual", diagnosis.remainder
    floors = " and ".join(
        f"{text} from {words(name)} to {words(name)}"
        for name, text in zip(
            diagnosis.noise_floor,
            format_aligned(list(diagnosis.noise_floor.values()), _unit(diagnosis)),
            strict=True,
        )
    )
    noise = f"<p>The measurement itself scatters by {esc(floors)} (RMS).</p>" if floors else ""
    if isinstance(left, Unexplained):
        return section("left", title, f"<p>{esc(left.sentence)}</p>{_by_signal(left, diagnosis)}")
    if not isinstance(left, Remainder):
        return section("left", title, empty("The residual was not examined.") + noise)
    sentence = (
        f"{format_quantity(left.rms, left.unit)} RMS is unexplained on the validation records: "
        f"{format_percent(left.share_of_excess)} of the baseline's reproducible squared error. "
        f"Of the residual, {format_percent(left.repeats)} repeats from stroke to stroke, "
        "which a better model could still explain."
    )
    shares = _shares(left, "extended" if diagnosis.causes else "baseline")
    return section("left", title, f"<p>{esc(sentence)}</p>{noise}{shares}")


def _shares(left: Remainder, css: str) -> str:
    """Where the remainder sits, the largest part first."""
    if not left.shares:
        return ""
    scale = Scale(0.0, 1.0)
    rows = "".join(
        f'<tr><th scope="row">{esc(capital(ARRANGED.get(name, name)))}</th>'
        f"<td>{bar(scale, share, css)}</td>"
        f'<td class="number">{esc(format_percent(share))}</td>'
        f'<td class="number">{esc(format_quantity(left.rms * max(share, 0.0) ** 0.5, left.unit))}'
        "</td></tr>"
        for name, share in sorted(left.shares.items(), key=lambda item: item[1], reverse=True)
    )
    head = "".join(f'<th scope="col">{text}</th>' for text in ("Where", "", "Share", "RMS"))
    return (
        '<table class="shares"><caption>Where the remaining squared error sits; '
        "the shares add up to all of it</caption>"
        f"<thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table>"
    )


def _unit(diagnosis: Diagnosis) -> str:
    """The unit of the noise floor: that of the signal judged."""
    units = {g.unit for g in diagnosis.gain} | {s.unit for s in diagnosis.series}
    return units.pop() if len(units) == 1 else "N"


def next_experiment(diagnosis: Diagnosis) -> str:
    """The measurement that would teach most, or what to do with the answer as it is."""
    title, plan = "Next experiment", diagnosis.next_experiment
    if plan is None:
        text = _without_measuring(diagnosis)
        return section("next", title, f'<div class="card plan"><p>{esc(text)}</p></div>')
    parts = [_identifier_label(identifier) for identifier in plan.separates]
    separates = f"<p>It would distinguish: {', '.join(parts)}.</p>" if parts else ""
    carry = ""
    if diagnosis.verdict == "unknown" and diagnosis.hidden is not None and not diagnosis.empirical:
        asked = "diagnose_model(..., empirical=True)"
        if diagnosis.inputs:  # else a model in Python, and no rig file
            asked = f"sms diagnose {diagnosis.rig} --empirical"
        carry = (
            f"<p>Until it is found, <code>{esc(asked)}</code> includes the curve of the missing term in the simulation "
            "and measures the improvement.</p>"
        )
    body = (
        f"<h3>{esc(capital(plan.title))}</h3><p>{esc(capital(plan.purpose))}</p>{separates}{carry}"
    )
    return section("next", title, f'<div class="card plan">{body}</div>')


def _without_measuring(diagnosis: Diagnosis) -> str:
    if diagnosis.causes:
        return (
            "No measurement is proposed: every other effect that was tested was rejected on these records, and "
            "'Effects tested' says why. Find the cause on the machine and repair it, or keep it and simulate with "
            "extended.toml, written beside this page."
        )
    if diagnosis.verdict == "data-fault":
        return "Correct what the data check found, then diagnose again."
    small = "No measurement is proposed. An effect too small for these records may still be present"
    if not diagnosis.inputs:  # a model in Python
        return f"{small}; diagnosis.json says from which size each would show (still_hidden)."
    return f"{small}: sms limits {diagnosis.rig} gives the detection limits, and the experiment that lowers each."


def _identifier_label(identifier: str) -> str:
    effect, _, signal = identifier.replace(":", " ").partition(" ")
    return effect_label(effect, signal or None)
