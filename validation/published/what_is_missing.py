"""Fits over what may be missing or read differently, and the tables of docs/validation.md.

    python -m validation.published.what_is_missing            both searches, printed
    python -m validation.published.what_is_missing --write    and all experiments, into docs/validation.md
    python -m validation.published.what_is_missing --rows     all experiments alone, into it

Nothing is drawn at random: the same source gives the same tables. Minutes on two cores.
"""

from __future__ import annotations

import argparse
import re
import sys
from collections.abc import Iterable, Mapping, Sequence
from itertools import groupby
from pathlib import Path

from sms.io import write_text_atomically
from sms.validation import Row, validate

from validation.published import actuator, state_feedback

PAGE = Path(__file__).parents[2] / "docs" / "validation.md"
_SHOWN = 8  # candidates of a round


def experiments_table(rows: Iterable[Row]) -> str:
    """Published against computed, one table."""
    lines = [
        "| experiment | quantity | published | computed | unit | |",
        "|---|---|---|---|---|---|",
    ]
    for name, group in groupby(rows, lambda row: row.experiment):
        for number, row in enumerate(group):
            published = "in words" if row.published is None else f"{row.published:.5g}"
            verdict = "agrees" if row.agrees else "**differs**"
            lines.append(
                f"| {name if number == 0 else ''} | {row.quantity} | {published} | "
                f"{row.computed:.4g} | {row.unit} | {verdict} |"
            )
    return "\n".join(lines)


def feedback_table(searches: Mapping[str, Sequence[Sequence[state_feedback.Found]]]) -> str:
    """The best candidates of each round, and what the best leaves with K_a = 0."""
    lines = [
        "| rates from | round | candidate | value | facts met | rise [s] | overshoot [%] | "
        "motion left at K_c = 0.5, 1, 15 [mm] | rise at 15 over 1 |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    ends = []
    for source, rounds in searches.items():
        for number, found in enumerate(rounds, 1):
            for one in found[:_SHOWN]:
                o = one.outcome
                own, high, low = o.motion
                lines.append(
                    f"| {source} | {number} | {one.candidate.name} | {one.value:.3g} | {o.met} of 6 | "
                    f"{o.rise:.3f} | {100.0 * max(o.overshoot, 0.0):.1f} | {1e3 * low:.1f}, "
                    f"{1e3 * own:.1f}, {1e3 * high:.1f} | {o.sameness:.2f} |"
                )
        best = rounds[-1][0].outcome
        left = state_feedback.without_acceleration(best.settings)
        kept = ", ".join(f"{name} = {value:.4g}" for name, value in best.settings.items())
        ends.append(
            f"Rates from {source}, best of the last round: {kept}. With K_a = 0 it keeps moving by "
            f"{1e3 * left:.1f} mm."
        )
    return "\n".join([*lines, "", *ends])


def actuator_table(rounds: Sequence[Sequence[actuator.Found]]) -> str:
    """The best candidates of each round, with the mass-flow gain that gives -11 dB."""
    lines = [
        "| round | candidate | value | 0.54 V read as | mass-flow gain | facts met | travel [mm] | "
        "gain [dB], phase [deg] | m/s per V at 5 V, 0.5 V |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    for number, found in enumerate(rounds, 1):
        alone = [one for one in found if one.candidate is None]
        shown = [*alone, *(one for one in found[:_SHOWN] if one.candidate is not None)]
        for one in shown:
            o = one.outcome
            name, value = "none", ""
            if one.candidate is not None:
                name, value = one.candidate.name, f"{one.value:.3g}"
            lines.append(
                f"| {number} | {name} | {value} | {o.reading} | {o.settings['mass_flow_gain']:.2f} | "
                f"{o.met} of 5 | {1e3 * o.travel:.0f} | {o.gain:.1f}, {o.phase:.0f} | "
                f"{o.speed_open:.3f}, {o.speed_small:.2f} |"
            )
    return "\n".join(lines)


def replaced(page: str, blocks: dict[str, str]) -> str:
    """The page with the text between `<!-- name -->` and `<!-- end name -->` renewed."""
    for name, text in blocks.items():
        pattern = re.compile(rf"(<!-- {name} -->\n).*?(<!-- end {name} -->)", re.DOTALL)
        page, count = pattern.subn(lambda m, text=text: f"{m[1]}{text}\n{m[2]}", page)  # type: ignore[misc]
        if count != 1:
            raise ValueError(f"docs/validation.md has {count} blocks named {name}; one is needed")
    return page


def main() -> None:
    """Run both searches; with --write into the page, and all experiments too."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--write", action="store_true", help="renew docs/validation.md")
    parser.add_argument("--rows", action="store_true", help="renew only its table of all figures")
    asked = parser.parse_args()
    if not asked.rows:
        blocks = _searched()
        print("\n\n".join(blocks.values()))
        if asked.write:
            _renew(blocks)
    if asked.write or asked.rows:
        rows = validate(progress=lambda text, share: _tell(f"{text} ..."))
        _renew({"experiments": experiments_table(rows)})


def _searched() -> dict[str, str]:
    searches = {}
    for source, base in state_feedback.SOURCES.items():
        _tell(f"state feedback, rates from {source} ...")
        searches[source] = state_feedback.search(base)
    _tell("bench, chirp and speeds ...")
    return {
        "state feedback": feedback_table(searches),
        "actuator": actuator_table(actuator.search()),
    }


def _renew(blocks: dict[str, str]) -> None:
    write_text_atomically(PAGE, replaced(PAGE.read_text(encoding="utf-8"), blocks))


def _tell(text: str) -> None:
    print(text, file=sys.stderr, flush=True)


if __name__ == "__main__":
    main()
