"""`./dev trials history`: how often two diagnoses are wrongly called different, and from which size a change is seen.

The answers are drawn, not diagnosed: an estimate is the truth plus a normal error of the standard error that is stated,
an effect is named where it is beyond three of these, and what is not named has its detection limit in the answer where
a diagnosis states it (verdict no-evidence). So the tests are tried on what they assume, thousands of times in a minute;
that standard errors of real diagnoses are right is what the blind trials count. `miss` is what they do not assume: a
share of the causes beyond their limit goes unnamed.
"""

from __future__ import annotations

import secrets
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer
from rich.console import Console
from sms.diagnosis.thresholds import DETECTION
from sms.history import Answer, Course, Machine, compare, history_of, read_answer
from sms.io.json_files import json_text
from sms.io.write import write_text_atomically

from validation.trials.shares import Share, at_least, at_most, share_table, shares_as_dicts

LEAK = "chamber_leakage_lower"
BEGIN = datetime(2026, 1, 15, tzinfo=UTC)
RECORDS = 12
"""Diagnoses of a history, a month apart."""
WITHIN = 2
"""Records between the onset that is named and the true one."""


@dataclass(frozen=True)
class Effect:
    """What may be wrong: its parameter, and the usual standard error of its size in SI."""

    effect: str
    signal: str | None
    parameter: str
    unit: str
    error: float


EFFECTS = (
    Effect("fitting_leakage", "lower", LEAK, "kg/(s Pa)", 2e-11),
    Effect("piston_seal_leakage", None, "piston_leakage", "kg/(s Pa)", 3e-11),
    Effect("moving_mass", None, "moving_mass", "kg", 0.05),
    Effect("coulomb_friction", None, "coulomb_force", "N", 0.8),
    Effect("dead_volume", "lower", "dead_volume_lower", "m^3", 4e-7),
    Effect("valve_centre_offset", None, "valve_centre", "V", 0.01),
)
MODEL = (("mass_flow_gain", "1", 1.5, 0.02), ("supply_pressure", "Pa", 6e5, 800.0))


def drawn_answer(
    rng: np.random.Generator,
    truth: Mapping[str, float],
    measured: datetime = BEGIN,
    scale: float = 1.0,
    miss: float = 0.0,
    named_from: float = DETECTION,
    **more: Any,
) -> str:
    """A diagnosis.json. truth: parameter -> size in standard errors of its effect. scale: of all standard errors.

    miss: share of causes beyond their limit that is not named. named_from: the limit, in standard errors; that of what
    is practically significant is higher. more: other keys of the JSON.
    """
    causes, hidden = [], []
    for e in EFFECTS:
        error = scale * e.error
        size = truth.get(e.parameter, 0.0) * e.error + rng.normal(0.0, error)
        common: dict[str, Any] = {"effect": e.effect, "signal": e.signal}
        common["title"] = e.effect.replace("_", " ")
        if abs(size) > named_from * error and rng.uniform() >= miss:
            causes.append(
                common | {"parameters": [_estimate(e.parameter, size, error, e.unit, 0.0)]}
            )
        else:
            limit = {"parameter": e.parameter, "size": named_from * error, "unit": e.unit}
            best = {"estimate": size, "standard_error": error}
            hidden.append(common | limit | best)
    verdict = ("no-evidence", "cause")[len(causes)] if len(causes) < 2 else "combination"
    model = [
        _estimate(name, rng.normal(value, scale * error), scale * error, unit, value)
        for name, unit, value, error in MODEL
    ]
    content = {
        "rig": "rig.toml",
        "title": "A drawn machine",
        "kind": "bench",
        "measured": measured.isoformat(),
        "measured_from": "stated",
        "verdict": verdict,
        "causes": causes,
        "still_hidden": [] if causes else hidden,
        "baseline": model,
        "declared": {"parameters": {}, "model": {}, "control": {}, "signals": {}},
    }
    return json_text("diagnosis", content | more)


def _estimate(name: str, value: float, error: float, unit: str, old: float) -> dict[str, Any]:
    return {"name": name, "value": value, "standard_error": error, "unit": unit, "old_value": old}


def read(text: str, name: str = "diagnosis.json") -> Answer:
    """The answer in a drawn JSON."""
    return read_answer(text, name, BEGIN)


# ---- pairs -----------------------------------------------------------------------------------------


def pair_says_changed(rng: np.random.Generator, times: float, other: float, miss: float) -> bool:
    """Whether a pair is called changed. times: of its limit, by which one effect of the second differs. other: up to
    which factor the standard errors of the second are others."""
    background = {
        e.parameter: DETECTION * rng.uniform(0.3, 4.0) for e in EFFECTS if rng.uniform() < 0.3
    }
    after = dict(background)
    chosen = EFFECTS[int(rng.integers(len(EFFECTS)))].parameter
    after[chosen] = after.get(chosen, 0.0) + DETECTION * times
    scale = float(np.exp(rng.uniform(-np.log(other), np.log(other))))
    a = read(drawn_answer(rng, background, miss=miss), "a")
    b = read(drawn_answer(rng, after, scale=scale, miss=miss), "b")
    return any(i.change == "changed" for i in compare(a, b).items)


def pair_shares(count: int, seed: int, other: float = 1.25, miss: float = 0.0) -> list[Share]:
    """Of so many pairs at each size: how many are called changed."""
    shares = []
    for times in (0.0, 1.0, 2.0, 3.0):
        rng = np.random.default_rng([seed, int(10 * times), int(100 * miss), int(100 * other)])
        called = [pair_says_changed(rng, times, other, miss) for _ in range(count)]
        records = f"errors alike within {other:g}" + (
            f", {100 * miss:.0f} % unnamed" if miss else ""
        )
        if times == 0.0:
            shares.append(at_most(f"unchanged pair called changed ({records})", called))
        else:
            shares.append(
                at_least(f"changed by {times:g} x its limit, and called so ({records})", called)
            )
    return shares


# ---- histories -------------------------------------------------------------------------------------


def leak_course(
    rng: np.random.Generator, onset: int, growth: float, miss: float = 0.0
) -> tuple[Course | None, list[Course]]:
    """The leak's course and all others over `RECORDS` diagnoses. The leak is zero before the diagnosis `onset` and
    grows by so many limits from each to the next; some other effects are there all the time."""
    others = [e.parameter for e in EFFECTS if e.parameter != LEAK]
    background = {p: DETECTION * rng.uniform(0.3, 4.0) for p in others if rng.uniform() < 0.3}
    answers = []
    for number in range(RECORDS):
        size = DETECTION * growth * max(number - onset + 1, 0)
        truth = background | {LEAK: size}
        when = BEGIN + timedelta(days=30.4 * number + rng.uniform(-5.0, 5.0))
        scale = float(np.exp(rng.uniform(-0.2, 0.2)))
        answers.append(read(drawn_answer(rng, truth, when, scale, miss)))
    found = history_of(Machine("A drawn machine", "bench"), answers).courses
    leak = next((c for c in found if c.parameter == LEAK), None)
    return leak, [c for c in found if c.parameter != LEAK]


def onset_found(course: Course | None, onset: int) -> bool:
    """Whether it is called growing, with its onset within two diagnoses."""
    if course is None or course.onset is None or not course.grows:
        return False
    return abs(course.onset[0].number - onset) <= WITHIN


def history_shares(count: int, seed: int, miss: float = 0.0) -> list[Share]:
    """Of so many histories: growing leaks that are named with their onset; steady ones that are called otherwise."""
    shares = []
    unnamed = f" ({100 * miss:.0f} % unnamed)" if miss else ""
    for growth in (0.3, 0.5, 1.0):
        rng = np.random.default_rng([seed, int(100 * growth), int(100 * miss)])
        found = []
        for _ in range(count):
            onset = int(rng.integers(3, 9))
            found.append(onset_found(leak_course(rng, onset, growth, miss)[0], onset))
        what = f"leak that grows by {growth:g} x its limit a record: named, onset within {WITHIN}{unnamed}"
        shares.append(at_least(what, found))
    rng = np.random.default_rng([seed, 0, int(100 * miss)])
    wrong = []
    for _ in range(count):
        leak, others = leak_course(rng, RECORDS, 0.0, miss)
        wrong.append(
            any(c.changed or c.moves for c in [*others, *([] if leak is None else [leak])])
        )
    shares.append(at_most(f"steady machine of which something is said to change{unnamed}", wrong))
    return shares


# ---- the command -----------------------------------------------------------------------------------


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command()(history)


def history(
    count: Annotated[int, typer.Option(min=1, help="Pairs at each size, and histories.")] = 200,
    seed: Annotated[int | None, typer.Option(help="By default drawn, and printed.")] = None,
    as_json: Annotated[Path | None, typer.Option("--json", help="Also to this file.")] = None,
) -> None:
    """Drawn pairs and series of diagnoses, changed or not: what is called changed, and how well its onset is told."""
    seed = secrets.randbelow(10**6) if seed is None else seed
    console = Console()
    console.print(f"seed {seed}, {count} of each", style="dim")
    shares: list[Share] = []
    for other, miss in ((1.25, 0.0), (2.0, 0.0), (1.25, 0.05)):
        shares += pair_shares(count, seed, other, miss)
    for miss in (0.0, 0.05):
        shares += history_shares(count, seed, miss)
    console.print(share_table(shares))
    if as_json is not None:
        content: Mapping[str, Any] = {
            "seed": seed,
            "count": count,
            "shares": shares_as_dicts(shares),
        }
        write_text_atomically(as_json, json_text("trials", content))


def as_files(texts: Sequence[str], folder: Path) -> list[Path]:
    """Each JSON in a folder of its own, as `sms diagnose` leaves it."""
    found = []
    for number, text in enumerate(texts):
        path = folder / f"{number:02d}" / "diagnosis.json"
        path.parent.mkdir(parents=True)
        path.write_text(text, encoding="utf-8")
        found.append(path)
    return found
