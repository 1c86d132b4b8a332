"""What the history of a machine says, a sentence each."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from datetime import UTC, datetime

from sms.history.course import Course
from sms.history.trend import DAY, MONTH, Reached
from sms.units_display import capital, format_estimate, format_quantity, words

_WEEK = 7.0 * DAY


def sentences(courses: Sequence[Course]) -> list[str]:
    """The causes first: what appeared, what went away, what moves, since when."""
    said = [text for course in courses for text in _of(course)]
    if not said:
        return ["Nothing appeared, went away or moves by as much as these diagnoses would show."]
    return said


def _of(course: Course) -> Iterator[str]:
    name, when = name_of(course), dates_of(course)
    if course.about == "cause":
        yield from _presence(course, name, when)
    if (onset := course.onset) is not None:
        first, earliest, latest = onset
        ramp = course.change is not None and course.change.course == "ramp"
        between = ""
        if earliest.number != latest.number:
            between = f" (95 %: between {when[earliest.number]} and {when[latest.number]})"
        how = "keeps changing" if ramp else "changed in one step"
        of = when[first.number]
        yield f"{capital(name)} {how}: the first changed diagnosis is that of {of}{between}."
    if course.trend is not None and course.moves:
        verb = "grows" if course.grows else "moves"
        yield f"{capital(name)} {verb} by {slope_in_words(course)}{_reached(course)}."


def _presence(course: Course, name: str, when: Mapping[int, str]) -> Iterator[str]:
    first = course.first_named
    if course.appeared and first is not None:
        yield f"{capital(name)} appeared: first named in the diagnosis of {when[first]}."
    last = course.points[-1]
    if course.went_away:
        of = when[last.number]
        yield f"{capital(name)} went away: the diagnosis of {of} would have shown it."
    elif first is not None and last.state == "not named":
        yield (
            f"{capital(name)} is not named any more, but the diagnosis of {when[last.number]} might not have shown it "
            "as small as it was."
        )


def name_of(course: Course) -> str:
    """Of a cause its title, of a parameter its name."""
    return course.title or words(course.parameter)


def slope_in_words(course: Course) -> str:
    """ "0.12 ± 0.03 g/s per bar a month", with its 95 percent interval; empty without a trend."""
    if course.trend is None:
        return ""
    line = course.trend
    half = line.quantile * line.slope_error * MONTH
    return f"{format_estimate(line.slope * MONTH, half, course.unit, course.parameter, signed=True)} a month (95 %)"


def _reached(course: Course) -> str:
    reached = course.reached
    if reached is None:
        return ""
    limit = format_quantity(reached.limit, course.unit, course.parameter)
    last = course.counted[-1]
    beyond = (last.value - reached.limit) * (reached.limit - course.neutral) >= 0.0
    if beyond:
        return f" and is beyond {limit} since about {about(reached)}"
    if reached.time < last.time:
        return f" away from {limit}"
    return f" and reaches {limit} on about {about(reached)}"


def about(reached: Reached) -> str:
    """ "2027-03 ± 3 weeks", as fine as its interval."""
    width = reached.half_width
    if not abs(reached.time) < 2.5e11:
        return "a day beyond any calendar"
    if width < 2 * _WEEK:
        return f"{day(reached.time)} ± {max(round(width / DAY), 1)} days"
    month = day(reached.time)[:7]
    if width < 3 * MONTH:
        return f"{month} ± {round(width / _WEEK)} weeks"
    return f"{month} ± {round(width / MONTH)} months"


def dates_of(course: Course) -> dict[int, str]:
    """Number of each diagnosis -> when it was measured."""
    shown = dates([p.time for p in course.points])
    return {p.number: text for p, text in zip(course.points, shown, strict=True)}


def dates(times: Sequence[float]) -> list[str]:
    """The date of each instant, s since 1970, in UTC; with its time of day where another one has the same date."""
    count = Counter(map(day, times))
    return [day(t) if count[day(t)] == 1 else _minute(t) for t in times]


def day(time: float) -> str:
    """The date of an instant, s since 1970, in UTC."""
    return datetime.fromtimestamp(time, UTC).date().isoformat()


def _minute(time: float) -> str:
    return datetime.fromtimestamp(time, UTC).strftime("%Y-%m-%d %H:%M")
