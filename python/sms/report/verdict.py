"""The head of the page: the verdict in plain words, and each cause as a card."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping

from sms.diagnosis.result import Cause, Diagnosis, Member, ParameterValue, Verdict
from sms.diagnosis.wording import INSENSITIVE
from sms.report.markup import Scale, dot, effect_label, empty, esc, paragraphs, section, table
from sms.units_display import (
    capital,
    format_aligned,
    format_change,
    format_estimate,
    format_p_value,
    format_percent,
    format_quantity,
    words,
)

MISSING = "–"
SPEAKS = 0.01
"""Chance below which an effect that was tried alone speaks for itself."""
MOST_RIVALS = 5
"""Names that are listed of those put out for one reason."""
VERDICT_WORDS: Mapping[Verdict, str] = {
    "no-evidence": "No evidence of a model error",
    "cause": "One cause found",
    "class": "One cause found, not distinguishable from others",
    "combination": "Several causes found",
    "unknown": "A model error of unknown cause",
    "data-fault": "The data cannot be used",
}
_NO_CARD: Mapping[Verdict, str] = {
    "no-evidence": "No cause is named: simulation and records agree within the noise.",
    "unknown": "No cause is named: no effect in the catalogue explains the error. "
    "Its size is given above, the equation it arises in below.",
    "data-fault": "No cause is named until the faults found by the data check are corrected.",
}


def header(diagnosis: Diagnosis) -> str:
    """Title, remarks, verdict and conclusion."""
    title = diagnosis.title or diagnosis.rig
    notes = f'<p class="role">{esc(diagnosis.notes)}</p>' if diagnosis.notes else ""
    return (
        f'<div class="verdict"><p class="eyebrow">Diagnosis · {esc(diagnosis.rig)}</p>'
        f"<h1>{esc(title)}</h1>{notes}"
        f'<p class="chip {diagnosis.verdict}" data-verdict="{diagnosis.verdict}">'
        f"{VERDICT_WORDS[diagnosis.verdict]}</p>"
        f'<p class="sentence">{esc(diagnosis.sentence)}</p>{_symptoms(diagnosis)}</div>'
    )


def _symptoms(diagnosis: Diagnosis) -> str:
    """What is wrong, signal by signal: how much, when, at which frequencies."""
    if not diagnosis.symptoms:
        return ""
    rows = []
    for s in sorted(diagnosis.symptoms, key=lambda s: -s.rms / s.noise):
        size, noise = format_aligned([s.rms, s.noise], s.unit)
        share = format_percent(s.share)
        rows.append(
            (
                esc(capital(words(s.signal))),
                f'<span class="nowrap">{esc(size)}</span> <span class="role">noise {esc(noise)}</span>',
                f'{esc(s.record)}, <span class="nowrap">{s.begin:.0f} to {s.end:.0f} s</span> '
                f'<span class="role">{esc(share)} of it</span>'
                if s.speaks
                else "within the noise",
                f'<span class="nowrap">below {s.below:.0f} Hz</span>' if s.speaks else MISSING,
            )
        )
    caption = (
        "Simulation error on the validation records after fitting all declared uncertainties; when most of it "
        "beyond the noise occurs, and the frequency below which 80 % of its power lies"
    )
    headers = ("Signal", "RMS error", "When largest", "Frequencies")
    return f'<div id="symptoms"><h2>What is wrong</h2>{table(caption, headers, rows, "symptoms", on_paper=6)}</div>'


def conclusion(diagnosis: Diagnosis) -> str:
    """What an engineer would conclude."""
    if not diagnosis.conclusion:
        return ""
    items = "".join(f"<li>{esc(text)}</li>" for text in diagnosis.conclusion)
    return section("conclusion", "What an engineer would conclude", f"<ul>{items}</ul>")


def causes(diagnosis: Diagnosis) -> str:
    """The cards, one a cause."""
    if not diagnosis.causes:
        text = _NO_CARD.get(diagnosis.verdict, "Nothing is named.")
        return section("causes", "Causes", empty(text))
    title = "The cause" if len(diagnosis.causes) == 1 else f"The {len(diagnosis.causes)} causes"
    cards = "".join(
        _card(number, cause, diagnosis) for number, cause in enumerate(diagnosis.causes, start=1)
    )
    return section("causes", title, f'<div class="stack">{cards}</div>')


def parameter_text(parameter: ParameterValue, shifted: bool) -> str:
    """How much, with standard error: the shift from the old value, or the new term's size."""
    name, unit, error = parameter.name, parameter.unit, parameter.standard_error
    if shifted:
        return format_change(parameter.old_value, parameter.value, error, unit, name)
    return format_estimate(parameter.value, error, unit, name, signed=name.startswith("sensor_"))


def _amount(parameter: ParameterValue, shifted: bool) -> str:
    """The same as HTML, a shift also in percent of the old value."""
    text = f'<span class="nowrap">{esc(parameter_text(parameter, shifted))}</span>'
    if shifted and is_shift(parameter):
        share = format_percent(parameter.value / parameter.old_value - 1.0, 2, signed=True)
        text += f' <span class="nowrap">({esc(share)})</span>'
    return text


def is_shift(parameter: ParameterValue) -> bool:
    """Whether an explanation is a parameter moved away from a value it had."""
    return math.isfinite(parameter.old_value) and abs(parameter.old_value) > 0.0


def _card(number: int, cause: Cause, diagnosis: Diagnosis) -> str:
    several = len(cause.members) > 1 or len(cause.alternatives) > 1
    identifier = cause.effect + (f" {cause.signal}" if cause.signal else "")
    rivals = max(len(cause.members) - 1, len(cause.alternatives))
    title = esc(capital(cause.title)) + (f", or one of {rivals} alternatives" if rivals > 1 else "")
    about = (
        f'<p class="eyebrow">Cause {number} · {esc(cause.kind)} · {esc(words(cause.block))}</p>'
        f"<h3>{title}{', or its alternative' if rivals == 1 else ''}</h3>"
        f"{_amounts(cause)}{paragraphs([cause.explanation])}"
    )
    note = f'<p class="small"><code>{esc(identifier)}</code> · {_significance(cause)}</p>'
    if cause.cross_validated:
        about += paragraphs([f"{capital(INSENSITIVE)}."])
    evidence = _consistency(cause, diagnosis.records) + _against(cause, diagnosis)
    columns = (about + evidence + note, _members(cause)) if several else (about + note, evidence)
    body = "".join(f"<div>{column}</div>" for column in columns)
    return f'<article class="card cause" data-effect="{esc(identifier)}">{body}</article>'


def _against(cause: Cause, diagnosis: Diagnosis) -> str:
    """The explanations that the data speak for too, taken alone, and why no round names them."""
    named = {(found.effect, found.signal) for found in diagnosis.causes}
    named |= {(m.effect, m.signal) for found in diagnosis.causes for m in found.alternatives}
    round_ = next(
        (
            c.round
            for c in diagnosis.candidates
            if c.accepted and (c.effect, c.signal) == (cause.effect, cause.signal)
        ),
        None,
    )
    out: dict[str, list[str]] = {}
    for c in diagnosis.candidates:
        stands_alone = c.round == round_ and not c.accepted and c.p_value <= SPEAKS
        if stands_alone and (c.effect, c.signal) not in named:
            out.setdefault(c.reason, []).append(effect_label(c.effect, c.signal))
    if not out:
        text = "No other effect of the catalogue is significant in these records after correction for multiple testing."
        return f'<p class="small">{text}</p>'
    parts = [
        f"{', '.join(names[:MOST_RIVALS])}{_more(len(names) - MOST_RIVALS)}: {esc(reason)}"
        for reason, names in out.items()
    ]
    return f'<p class="small"><strong>Considered and rejected.</strong> {"; ".join(parts)}.</p>'


def _more(count: int) -> str:
    return f" and {count} more" if count > 0 else ""


def _significance(cause: Cause) -> str:
    probability = esc(format_p_value(cause.p_value))
    return f"{probability} (score test, corrected for all effects tested)"


def _amounts(cause: Cause) -> str:
    shifted = cause.kind == "shifted parameter"
    return "".join(
        f'<p class="amount">{_amount(p, shifted)}<small>{esc(words(p.name))}</small></p>'
        for p in cause.parameters
    )


def _members(cause: Cause) -> str:
    """The rival explanations, and the measurement that would decide."""
    rivals = cause.alternatives
    if not any((m.effect, m.signal) == (cause.effect, cause.signal) for m in rivals):
        first = Member(cause.effect, cause.signal, cause.title, cause.parameters, similarity=1.0)
        rivals = (first, *rivals)
    rows = [
        (
            f"{esc(capital(m.title))}<br>{effect_label(m.effect, m.signal)}",
            "<br>".join(_amount(p, is_shift(p)) for p in m.parameters),
        )
        for m in rivals
    ]
    listed = {_plain(f"{r.effect} {r.signal or ''}") for r in rivals}
    listed |= {_plain(r.effect) for r in rivals}
    rest = [_plain(name) for name in cause.members if _plain(name) not in listed]
    also = f"<p>Also in this ambiguity group: {esc(', '.join(rest))}.</p>" if rest else ""
    decide = (
        f'<p class="decide"><strong>To distinguish them:</strong> {esc(cause.separated_by)}</p>'
        if cause.separated_by
        else ""
    )
    least = min(r.similarity for r in rivals)
    alike = "their sensitivities in these records are identical"
    if not least >= 0.9995:
        alike = f"their sensitivities in these records agree to {format_percent(least, 1)}"
    caption = f"Ambiguity group, not distinguishable by these signals: {alike}"
    headers = ("Explanation", "Estimate, if it is this one")
    return table(caption, headers, rows, "members") + also + decide


def _plain(identifier: str) -> str:
    """A member's identifier as words, however effect and signal are joined in it."""
    return " ".join(re.findall(r"\w+", words(identifier)))


def _consistency(cause: Cause, roles: Mapping[str, str]) -> str:
    """The parameter refitted on each record alone: a wrong cause scatters, a right one does not."""
    if not cause.consistency or not cause.parameters:
        return ""
    fitted = cause.parameters[0]
    error = fitted.standard_error if math.isfinite(fitted.standard_error) else 0.0
    band = (fitted.value - 2.0 * error, fitted.value + 2.0 * error)
    scale = Scale.over([*cause.consistency.values(), *band, fitted.old_value], margin=0.06)
    rows = [
        (
            f'{esc(record)} <span class="role">{esc(roles.get(record, ""))}</span>',
            dot(scale, value, band, (fitted.old_value,)),
            esc(format_quantity(value, fitted.unit, fitted.name)),
        )
        for record, value in cause.consistency.items()
    ]
    values = list(cause.consistency.values())
    low, high = format_aligned([min(values), max(values)], fitted.unit, fitted.name)
    was = "zero" if not is_shift(fitted) else "the old value"
    caption = (
        f"Refitted on each record alone: {low} to {high}. "
        f"Shaded: the fit ± 2 standard errors; line: {was}"
    )
    return table(caption, ("Record", "", "Value"), rows, "consistency")
