"""The same model on other rigs of the bench: what stays, and what goes with the part changed."""

from __future__ import annotations

from collections.abc import Sequence

from sms.diagnosis.result import Diagnosis, ParameterValue, Related
from sms.diagnosis.wording import REPEAT
from sms.report.markup import Scale, dot, esc, section, table
from sms.report.verdict import parameter_text
from sms.units_display import MISSING, capital


def related(diagnosis: Diagnosis) -> str:
    """A table with a row a rig and a column a parameter; nothing without related rigs."""
    rigs = diagnosis.related
    if not rigs:
        return ""
    lead = (
        "The extended model fitted to all records of each rig. What stays the same when a part is "
        "changed belongs to the rest of the bench; what changes with it belongs to that part. "
        "The same parts mounted again show how much comes from mounting alone."
    )
    names = list(dict.fromkeys(p.name for r in rigs for p in r.parameters))
    scales = {name: _scale(name, rigs) for name in names}
    rows = [
        [
            f'{esc(title)}<br><span class="role">{esc(_differs(rig))}</span>',
            *(_cell(rig, name, scales[name]) for name in names),
        ]
        for rig, title in zip(rigs, _short([r.title or r.rig for r in rigs]), strict=True)
    ]
    caption = "Dot: value; shaded: ± 2 standard errors; line: the value before"
    headers = ("Rig", *(capital(name) for name in names))
    return section("related", "On related rigs", table(caption, headers, rows, "related"), lead)


def _short(titles: Sequence[str]) -> list[str]:
    """Titles without the words that all of them begin with."""
    split = [title.split(" ") for title in titles]
    same = 0
    for column in zip(*split, strict=False):
        if len(set(column)) > 1:
            break
        same += 1
    return [capital(" ".join(parts[same:])) or " ".join(parts) for parts in split]


def _find(rig: Related, name: str) -> ParameterValue | None:
    return next((p for p in rig.parameters if p.name == name), None)


def _band(p: ParameterValue) -> tuple[float, float]:
    return p.value - 2.0 * p.standard_error, p.value + 2.0 * p.standard_error


def _scale(name: str, rigs: Sequence[Related]) -> Scale:
    found = [p for rig in rigs if (p := _find(rig, name)) is not None]
    return Scale.over((v for p in found for v in (p.old_value, p.value, *_band(p))), margin=0.06)


def _cell(rig: Related, name: str, scale: Scale) -> str:
    p = _find(rig, name)
    if p is None:
        return MISSING
    text = esc(parameter_text(p, shifted=False))
    return f'{dot(scale, p.value, _band(p), (p.old_value,))}<span class="nowrap">{text}</span>'


def _differs(rig: Related) -> str:
    if rig.differs == REPEAT:
        return "the same parts, mounted again"
    return f"other {rig.differs}" if rig.differs else "this rig"
