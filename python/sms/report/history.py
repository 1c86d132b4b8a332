"""The page of `sms history`: every size over time with its intervals, what moves since when, the rig file's changes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from datetime import UTC, datetime
from typing import Any

from sms.history.course import Course, Point, State
from sms.history.summary import Entry, History
from sms.history.wording import dates_of, name_of, slope_in_words
from sms.report.markup import empty, esc, section, table
from sms.report.panels import Colour, figure, panel, panels_page, trace, view
from sms.report.verdict import MISSING
from sms.units_display import DisplayUnit, capital, display_unit, format_estimate

STACKED = 4
"""Causes that are drawn above each other; with more, one at a time. Judgement: what a screen shows."""
_SHOWN: tuple[tuple[State, str, Colour, str], ...] = (
    ("named", "named", "extended", "circle"),
    ("not named", "not named: what the records leave possible", "floor", "circle-open"),
    ("fitted", "fitted, no cause named", "measured", "circle"),
    ("fitted beside a cause", "fitted where a cause is named: moved by it", "warn", "x"),
)


def history_html(history: History) -> str:
    """The whole page as text."""
    causes = [c for c in history.courses if c.about == "cause"]
    model = [c for c in history.courses if c.about == "model"]
    figures: dict[str, list[dict[str, Any]]] = {}
    parts = [_head(history)]
    lead = "Bars are 95 % intervals. Dotted upright: the first changed diagnosis. Dashed: the trend that is not zero."
    if causes:
        figures["causes"] = list(_views(causes))
        size: Any = "tall" if 1 < len(causes) <= STACKED else ""
        parts.append(figure("causes", "Causes over time", figures["causes"], lead, size))
    else:
        parts.append(section("causes", "Causes over time", empty("No diagnosis names a cause.")))
    parts.append(_course_table("sizes", "Sizes and their trends", causes or model))
    if model:
        figures["model"] = [view(capital(name_of(c)), "", [_panel(c)]) for c in model]
        parts.append(
            figure(
                "model",
                "Parameters of the declared model",
                figures["model"],
                "As the fit without any cause has them. Where a cause is named they are moved by it, and do not count.",
            )
        )
    parts += [_diagnoses(history.entries), _rig_file(history.entries), _lacks(history)]
    return panels_page(f"History: {history.machine.title}", "".join(parts), figures)


def _head(history: History) -> str:
    kind = f" · {esc(history.machine.kind)}" if history.machine.kind else ""
    listed = "".join(f"<li>{esc(text)}</li>" for text in history.sentences)
    return (
        f'<p class="eyebrow">History{kind} · {len(history.entries)} diagnoses</p>'
        f"<h1>{esc(history.machine.title)}</h1><ul class='said'>{listed}</ul>"
    )


# ---- figures ---------------------------------------------------------------------------------------


def _views(causes: Sequence[Course]) -> Iterator[dict[str, Any]]:
    if 1 < len(causes) <= STACKED:
        yield view("all", "", [_panel(c, quiet=n > 0) for n, c in enumerate(causes)])
    for course in causes:
        yield view(capital(name_of(course)), "", [_panel(course)])


def _panel(course: Course, quiet: bool = False) -> dict[str, Any]:
    unit = _unit(course)
    traces = [
        _points(course, state, label, colour, symbol, unit, quiet)
        for state, label, colour, symbol in _SHOWN
        if any(p.state == state for p in course.points)
    ]
    if course.trend is not None and course.moves:
        traces.append(_line(course, unit))
    if course.onset is not None:
        traces.append(_upright(course, unit))
    if course.reached is not None:
        ends = [course.points[0].time, course.points[-1].time]
        level = unit.scale(course.reached.limit)
        traces.append(_over(ends, [level, level], "bad", "dot"))
    name = capital(name_of(course))
    return panel(f"{name}<br>[{unit.label}]" if unit.label else name, traces)


def _unit(course: Course) -> DisplayUnit:
    largest = max(abs(p.value) for p in course.points)
    return display_unit(course.unit, largest, course.parameter)


def _points(
    course: Course, state: State, label: str, colour: Colour, symbol: str, unit: DisplayUnit, quiet: bool
) -> dict[str, Any]:  # fmt: skip
    points = [p for p in course.points if p.state == state]
    values = [unit.scale(p.value) for p in points]
    found = trace(
        [],
        values,
        label,
        colour,
        "markers",
        symbol=symbol,
        size=8,
        quiet=quiet,
        error=[unit.scale(p.high - p.value) for p in points],
        error_below=[unit.scale(p.value - p.low) for p in points],
    )
    return found | {"x": [_instant(p.time) for p in points]}


def _line(course: Course, unit: DisplayUnit) -> dict[str, Any]:
    assert course.trend is not None
    begin = course.points[0].time
    if course.change is not None and course.changed:
        counted = course.counted
        begin = counted[max(course.change.first - 1, 0)].time
    ends = [begin, course.points[-1].time]
    return _over(ends, [unit.scale(course.trend.at(t)) for t in ends], "baseline", "dash")


def _upright(course: Course, unit: DisplayUnit) -> dict[str, Any]:
    assert course.onset is not None
    time = course.onset[0].time
    ends = [unit.scale(f(_ends(course.points))) for f in (min, max)]
    return _over([time, time], ends, "warn", "dot")


def _ends(points: Sequence[Point]) -> list[float]:
    return [end for p in points for end in (p.low, p.high)]


def _over(
    times: Sequence[float], values: Sequence[float], colour: Colour, dash: str
) -> dict[str, Any]:
    return trace([], values, "", colour, "lines", dash=dash) | {"x": [_instant(t) for t in times]}


def _instant(time: float) -> str:
    """As Plotly reads a date."""
    return datetime.fromtimestamp(time, UTC).strftime("%Y-%m-%d %H:%M:%S")


# ---- tables ----------------------------------------------------------------------------------------

LONGEST_DATE = len("2026-11-25 14:30")
COURSE_HEADERS = ("size", "first", "last", "since", "trend", "state")


def course_rows(courses: Sequence[Course]) -> list[tuple[str, ...]]:
    """For page and console alike: a course a row, as plain text."""
    return [
        (
            capital(name_of(c)),
            _estimate(c, c.points[0]),
            _estimate(c, c.points[-1]),
            dates_of(c)[c.onset[0].number] if c.onset is not None else MISSING,
            slope_in_words(c) if c.moves else MISSING,
            _state(c),
        )
        for c in courses
    ]


def _estimate(course: Course, point: Point) -> str:
    if point.state == "not named":
        return f"not named ({format_estimate(point.value, point.high - point.value, course.unit, course.parameter)})"
    return format_estimate(point.value, point.standard_error, course.unit, course.parameter)


def _state(course: Course) -> str:
    said = [
        word
        for word, holds in (
            ("appeared", course.appeared),
            ("went away", course.went_away),
            ("grows", course.grows),
            ("moves", course.moves and not course.grows),
            ("changed", course.changed and not course.moves),
        )
        if holds
    ]
    return ", ".join(said) or "steady"


def _course_table(identifier: str, title: str, courses: Sequence[Course]) -> str:
    rows = [
        [_nowrap(c) if len(c) <= LONGEST_DATE else esc(c) for c in row]
        for row in course_rows(courses)
    ]
    if not rows:
        return ""
    caption = "Sizes with standard errors, of what is not named what its records leave possible; trends with 95 %"
    headers = [capital(h) for h in COURSE_HEADERS]
    return section(identifier, title, table(caption, headers, rows))


def _diagnoses(entries: Sequence[Entry]) -> str:
    rows = [
        [
            _nowrap(e.date),
            *map(esc, (e.verdict, "; ".join(e.causes) or MISSING, e.measured_from, e.source)),
        ]
        for e in entries
    ]
    headers = ("Measured", "Verdict", "Causes", "Time is", "From")
    return section("diagnoses", "Diagnoses", table("In the order of measurement", headers, rows))


def _nowrap(text: str) -> str:
    return f'<span class="nowrap">{esc(text)}</span>'


def _rig_file(entries: Sequence[Entry]) -> str:
    listed = "".join(
        f"<li>{esc(e.date)}: {esc(text)}</li>" for e in entries for text in e.changed_in_rig_file
    )
    body = f"<ul>{listed}</ul>" if listed else empty("Nothing that is known of.")
    return section("rig-file", "What changed in the rig file", body)


def _lacks(history: History) -> str:
    if not history.lacks:
        return ""
    listed = "".join(f"<li>{esc(text)}</li>" for text in history.lacks)
    return section("lacks", "What older diagnoses do not say", f"<ul>{listed}</ul>")
