"""The page of `./dev trials`: goals, confusion matrix, and every trial that went wrong."""

from __future__ import annotations

from collections.abc import Sequence

from sms.report.markup import esc, section, table
from sms.report.page import page

from validation.trials.by_level import by_level, cell
from validation.trials.scoring import Outcome, confusion, goals

BOUNDS = "In brackets the one-sided 95 % bound (Clopper and Pearson)."
_STYLE = """
table.matrix { border-collapse: collapse; font-size: 0.8rem; }
table.matrix td, table.matrix th { border: 1px solid #8884; padding: 0.15rem 0.4rem; text-align: left; }
table.matrix td.number { text-align: right; }
table.matrix td.hit { background: #2a9d5c33; }
table.matrix td.miss { background: #d1495b33; }
"""


def trials_html(rig: str, seed: int, multiple: float, outcomes: Sequence[Outcome]) -> str:
    """The whole page."""
    rows = [
        (
            esc(g.what),
            f"{g.count} of {g.of}",
            f"{100 * g.share:.0f} %" if g.of else "-",
            esc(g.wanted),
        )
        for g in goals(outcomes)
    ]
    seconds = sum(o.seconds for o in outcomes) / max(len(outcomes), 1)
    lead = (
        f"{len(outcomes)} trials on a virtual {rig}, seeds from {seed}, effects at {multiple:g} times their detection "
        f"limit, machines off by {_levels(outcomes)} from what can be declared. "
        f"A diagnosis took {seconds:.0f} s of processor time in the mean."
    )
    body = (
        "<main><h1>Hidden effects, found or not</h1>"
        + section(
            "goals", "Goals", table("", ("", "Count", "Share", "Wanted"), rows, "goals"), lead
        )
        + section("levels", "By level of imperfection", _by_level(outcomes), BOUNDS)
        + section("matrix", "Hidden against said", _matrix(outcomes))
        + section("wrong", "Every trial that went wrong", _wrong(outcomes))
        + "</main>"
    )
    return page(f"Trials: {rig}", body, style=_STYLE)


def _levels(outcomes: Sequence[Outcome]) -> str:
    return ", ".join(f"{level:g} %" for level in sorted({o.imperfection for o in outcomes}))


def _by_level(outcomes: Sequence[Outcome]) -> str:
    columns = by_level(outcomes)
    rows = [
        (esc(row[0].what), *(esc(cell(share)) for share in row))
        for row in zip(*columns.values(), strict=True)
    ]
    return table("", ("", *columns), rows, "levels")


def _matrix(outcomes: Sequence[Outcome]) -> str:
    cells = []
    for hidden, said in confusion(outcomes).items():
        total = sum(said.values())
        for number, (name, count) in enumerate(said.most_common()):
            right = any(
                o.right and o.said == name and (" + ".join(o.hidden) or "nothing") == hidden
                for o in outcomes
            )
            head = f'<th rowspan="{len(said)}">{esc(hidden)} ({total})</th>' if number == 0 else ""
            cells.append(
                f'<tr>{head}<td class="{"hit" if right else "miss"}">{esc(name)}</td>'
                f'<td class="number">{count}</td></tr>'
            )
    return (
        '<table class="matrix"><thead><tr><th>Hidden</th><th>Said</th><th>Times</th></tr></thead>'
        f"<tbody>{''.join(cells)}</tbody></table>"
    )


def _wrong(outcomes: Sequence[Outcome]) -> str:
    rows = [
        (
            str(o.seed),
            f"{o.imperfection:g} %",
            esc(" + ".join(o.hidden) or "nothing"),
            esc(", ".join(f"{v:.3g}" for v in o.values)),
            esc(o.said),
        )
        for o in outcomes
        if not o.right
    ]
    return (
        table("", ("Seed", "Imperfection", "Hidden", "Size", "Said"), rows, "wrong")
        if rows
        else "<p>None.</p>"
    )
