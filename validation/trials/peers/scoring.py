"""What each method said of each trial, counted in the same words."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from statistics import median

from rich.table import Table

SORTS = ("healthy", "catalogue", "outside")
LARGEST_CLASS = 3
VERDICTS = ("right", "class", "wrong", "unknown", "nothing")


@dataclass(frozen=True)
class Said:
    """One method on one trial."""

    method: str
    trial: str
    sort: str
    """One of SORTS."""
    hidden: str
    """"none", or the effect's key."""
    named: tuple[tuple[str, ...], ...]
    """Each finding as the effects that it may be; an empty one is a finding without a name."""
    alarm: bool
    """Whether it says that the model is wrong, with a name or without."""
    gain: float | None

    @property
    def verdict(self) -> str:
        """One of VERDICTS: "wrong" is a name for something that is not there, "unknown" an alarm without a name."""
        names = [set(members) for members in self.named if members]
        if not names:
            return "unknown" if self.alarm else "nothing"
        if any(self.hidden not in members for members in names):
            return "wrong"
        if len(names) > 1 or len(names[0]) > LARGEST_CLASS:
            return "wrong"
        return "right" if len(names[0]) == 1 else "class"

    @property
    def false_alarm(self) -> bool:
        return self.hidden == "none" and self.alarm


def _percent(share: float) -> str:
    number = round(100.0 * share)
    return f"{number:+d} %" if number else "0 %"


def table(said: Sequence[Said], title: str) -> Table:
    """For each sort of trial and each method, how often it said what."""
    out = Table(title=title, title_justify="left", title_style="bold", box=None)
    headers = ("trials", "method", *VERDICTS, "false alarm", "error on unseen")
    for number, name in enumerate(headers):
        out.add_column(name, justify="left" if number < 2 else "right", no_wrap=True)
    for sort in SORTS:
        of_sort = [s for s in said if s.sort == sort]
        count = len({s.trial for s in of_sort})
        for number, method in enumerate(dict.fromkeys(s.method for s in of_sort)):
            own = [s for s in of_sort if s.method == method]
            counts = [sum(s.verdict == v for s in own) for v in VERDICTS]
            gains = [s.gain for s in own if s.gain is not None]
            out.add_row(
                f"{sort}, {count}" if number == 0 else "",
                method,
                *(str(c) if c else "." for c in counts),
                str(sum(s.false_alarm for s in own)) if sort == "healthy" else "",
                _percent(-median(gains)) if gains else "-",
            )
        out.add_section()
    return out
