"""Where the error arises, by two methods: unknown inputs in the simulation, and each equation fed with measurements."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from sms.diagnosis.remainder import ErrorCurve, FedEquations, Hidden, Shape
from sms.diagnosis.result import Diagnosis
from sms.diagnosis.wording_simulated import two_ways
from sms.report.markup import Scale, bar, esc, printed_in_part, section, table
from sms.report.worth import gain_table
from sms.units_display import axis_unit, capital, format_aligned, format_percent, words

WIDTH, HEIGHT = 560, 240
PRINTED = 7
"""Equations of a table on paper: all that a bench has."""
LEFT, TOP, MARGIN = 60, 28, 40
"""Free on the left and above; below, and on the right."""


def origin(diagnosis: Diagnosis) -> str:
    """Shares of the equations before the extension, and the curve of what is missing."""
    hidden = diagnosis.hidden
    if hidden is None:
        return ""
    lead = (
        "An unknown input, a function of any of the signals, is added to each equation of the simulation in turn. "
        "Shown is the share of the error beyond the noise that it explains alone, with its 95 % bootstrap interval "
        "over windows. Shares need not add up to 100 %: an error in one equation propagates to the others. No cause is "
        "assumed here; this is an independent check."
    )
    figures = _curve(
        hidden.shape, "Before the extension" if diagnosis.causes else "What is missing"
    )
    left = diagnosis.hidden_left
    if diagnosis.causes and left is not None and left.shape.share > 0.05:
        figures += _curve(left.shape, "In the residual of the extended model")
    body = f'{_shares(hidden)}<div class="cards">{figures}</div>'
    body += _empirical(diagnosis)
    if diagnosis.fed is not None:
        body += _fed(diagnosis.fed, hidden)
    return section("origin", "Where the error arises", body, lead)


def _empirical(diagnosis: Diagnosis) -> str:
    """The curve as a term of the simulation, on request."""
    if diagnosis.empirical is None:
        return ""
    shape = diagnosis.empirical.shape
    text = (
        f"Not explained: as an empirical term in {words(shape.equation)}, a function of "
        f"{words(shape.signal.split(' [')[0])}, the curve above improves the validation records as follows. It is "
        f"applied with a factor of {format_percent(shape.confirmed)}: what the identification records confirm of each "
        "other. It predicts but names no cause, and may be wrong outside these records. Its values: "
        "empirical.csv."
    )
    return (
        f'<p id="empirical">{esc(text)}</p>{gain_table(diagnosis.empirical.gain, "With the curve")}'
    )


def _shares(hidden: Hidden) -> str:
    scale = Scale(0.0, 1.0)
    rows = "".join(
        f'<tr{"" if number < PRINTED else " class=screen"}><th scope="row">{esc(capital(words(name)))}</th>'
        f"<td>{bar(scale, max(share, 0.0), 'baseline', (max(low, 0.0), max(high, 0.0)))}</td>"
        f'<td class="number">{esc(format_percent(max(share, 0.0)))}</td></tr>'
        for number, (name, (share, low, high)) in enumerate(
            sorted(hidden.shares.items(), key=lambda item: -item[1][0])
        )
    )
    head = "".join(f'<th scope="col">{text}</th>' for text in ("Equation", "", "Takes alone"))
    shown = f'<table class="shares"><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table>'
    return shown + printed_in_part(PRINTED, len(hidden.shares))


def _fed(fed: FedEquations, hidden: Hidden) -> str:
    """The other way: shares, sizes in the equations' own units, and the worst one over time."""
    lead = (
        "The second method simulates nothing. Each equation is fed with the measured signals, smoothed by local cubics "
        f"over {1e3 * fed.smoothing:g} ms, and its error is averaged over {1e3 * fed.average:g} ms. The noise is "
        "propagated from the signals. Shares of the error beyond the noise add up here: an error stays in its equation."
    )
    scale = Scale(0.0, 1.0)
    rows = []
    for e in sorted(fed.equations, key=lambda e: -e.share[0]):
        size, noise = format_aligned([e.rms, e.noise], e.unit)
        share, low, high = e.share
        rows.append(
            (
                esc(capital(words(e.equation))),
                bar(scale, share, "baseline", (low, high)),
                esc(format_percent(share)),
                esc(f"{size} ({noise})"),
                f"{e.times_noise:.1f}",
            )
        )
    shown = table(
        "Each equation fed with measured signals",
        ("Equation", "", "Share", "RMS error (noise)", "Error / noise"),
        rows,
        "shares",
        PRINTED,
    )
    curves = [c for c in fed.curves if c.equation == fed.equation]
    figures = "".join(map(_over_time, curves)) if fed.beyond_noise else ""
    return (
        f'<div id="fed"><p class="lead">{esc(lead)}</p><p>{esc(two_ways(hidden, fed))}</p>'
        f'{shown}<div class="cards">{figures}</div></div>'
    )


def _over_time(curve: ErrorCurve) -> str:
    """The missing term of one record over time, with the band of its noise about zero."""
    unit = axis_unit(curve.unit)
    x = curve.time
    y, band = ([v * unit.factor for v in values] for values in (curve.missing, curve.band))
    high = max(*map(abs, y), *band, 1e-300)
    middle = 0.5 * (TOP + HEIGHT - MARGIN)

    def at(a: float, b: float) -> tuple[float, float]:
        return _across(a, x), middle - b / high * (middle - TOP)

    around = [at(a, b) for a, b in zip(x, band, strict=True)]
    around += [at(a, -b) for a, b in zip(x[::-1], band[::-1], strict=True)]
    caption = (
        f"{capital(words(curve.equation))} in '{curve.record}': the missing term, and a band of twice its noise "
        "about zero."
    )
    drawn = (
        f'<polygon points="{_points(around)}" fill="#88888833"/>'
        f'<polyline points="{_points([at(a, b) for a, b in zip(x, y, strict=True)])}" fill="none" stroke="#4477aa" '
        'stroke-width="1.5"/>'
    )
    across = Axis("time [s]", [(at(v, 0.0)[0], f"{v:.0f}") for v in (x[0], x[-1])])
    up = Axis(
        f"{words(curve.equation)} [{unit.label}]",
        [(at(x[0], v)[1], f"{v:.2g}") for v in (-high, 0.0, high)],
    )
    return _figure(drawn, across, up, caption)


@dataclass(frozen=True)
class Axis:
    """Its title, and its marks: where in the drawing, and what stands there."""

    title: str
    marks: Sequence[tuple[float, str]]


def _figure(drawn: str, across: Axis, up: Axis, caption: str) -> str:
    """A small drawing with two axes, from points that lie between the margins."""
    bottom, low = HEIGHT - MARGIN, 'text-anchor="middle"'
    marks = "".join(
        f'<text x="{place:.1f}" y="{bottom + 16}" {low}>{esc(text)}</text>'
        for place, text in across.marks
    )
    marks += "".join(
        f'<line x1="{LEFT}" x2="{WIDTH - MARGIN}" y1="{place:.1f}" y2="{place:.1f}" stroke="#8886"/>'
        f'<text x="{LEFT - 6}" y="{place + 4:.1f}" text-anchor="end">{esc(text)}</text>'
        for place, text in up.marks
    )
    titles = (
        f'<text x="{0.5 * (LEFT + WIDTH - MARGIN)}" y="{bottom + 32}" {low}>{esc(across.title)}</text>'
        f'<text x="6" y="14">{esc(up.title)}</text>'
    )
    return (
        f'<figure class="shape"><svg viewBox="0 0 {WIDTH} {HEIGHT}" role="img" aria-label="{esc(caption)}" '
        f'font-size="12" fill="currentColor">{marks}{drawn}{titles}</svg>'
        f"<figcaption>{esc(caption)}</figcaption></figure>"
    )


def _curve(shape: Shape, title: str) -> str:
    """The curve with its band as a small figure."""
    name, _, unit = shape.signal.partition(" [")
    x_unit, y_unit = axis_unit(unit.rstrip("]") or "1"), axis_unit(shape.unit)
    x = [v * x_unit.factor for v in shape.at]
    y = [v * y_unit.factor for v in shape.value]
    band = [b * y_unit.factor for b in shape.band]
    low = min(0.0, *(v - b for v, b in zip(y, band, strict=True)))
    high = max(0.0, *(v + b for v, b in zip(y, band, strict=True)))
    span = max(high - low, 1e-300)

    def at(a: float, b: float) -> tuple[float, float]:
        return _across(a, x), HEIGHT - MARGIN - (b - low) / span * (HEIGHT - MARGIN - TOP)

    upper = [at(a, v + b) for a, v, b in zip(x, y, band, strict=True)]
    lower = [at(a, v - b) for a, v, b in zip(x, y, band, strict=True)]
    caption = (
        f"{title}: the missing term in {words(shape.equation)} as a function of {words(name)}, with its 95 % band. "
        f"It explains {format_percent(min(max(shape.share, 0.0), 1.0))} of the error beyond the noise. It describes "
        "what is missing; it does not explain it."
    )
    drawn = (
        f'<polygon points="{_points(upper + lower[::-1])}" fill="#4477aa33"/>'
        f'<polyline points="{_points([at(a, v) for a, v in zip(x, y, strict=True)])}" fill="none" stroke="#4477aa" '
        'stroke-width="2"/>'
    )
    across = Axis(
        f"{words(name)} [{x_unit.label}]",
        [(_across(v, x), f"{v:.3g}") for v in (x[0], 0.5 * (x[0] + x[-1]), x[-1])],
    )
    ends = [v for v in (low, high) if abs(v) > 0.05 * span]
    up = Axis(
        f"{words(shape.equation)} [{y_unit.label}]",
        [(at(x[0], v)[1], f"{v:.2g}") for v in (*ends, 0.0)],
    )
    return _figure(drawn, across, up, caption)


def _across(value: float, x: Sequence[float]) -> float:
    """Where a value lies between the left and the right margin."""
    return LEFT + (value - x[0]) / max(x[-1] - x[0], 1e-300) * (WIDTH - MARGIN - LEFT)


def _points(points: Sequence[tuple[float, float]]) -> str:
    return " ".join(f"{a:.1f},{b:.1f}" for a, b in points)
