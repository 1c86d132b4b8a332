"""The data sets of another simulator (../foreign.py) by every method: the same records, the key opened at the end.

A key accepts several effects for one that is hidden; whichever is named counts as the first of them.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

from sms.diagnosis.effects.catalogue import effects_of
from sms.diagnosis.simulated import Case

from validation.trials.answers import answered
from validation.trials.foreign import sets_of
from validation.trials.machines import taken
from validation.trials.peers.on_machines import (
    AskPeers,
    Opinion,
    Round,
    asked,
    equation_of,
    load,
    ours,
)
from validation.trials.scoring import Outcome

OUTSIDE = "unknown_"
"""How a key calls an effect that no catalogue holds."""


def play_set(folder: Path, number: int, name: str, ask: AskPeers) -> Round:
    """Diagnose, ask everyone, open the key."""
    answer = answered(folder / name, seed=1)
    case = answer.case
    said = Outcome(
        case.data.rig.kind, number, "", 0.0, [], [], case.verdict, answer.named, [], answer.block
    )
    said = replace(
        said, gain=taken(case, case.after) if answer.named else 0.0, seconds=answer.seconds
    )
    opinions = [ours(case, said), *asked(case, ask)]
    key = json.loads((folder / "keys" / f"{name}.json").read_text(encoding="utf-8"))
    return scored(key, said, opinions, case)


def scored(key: dict[str, Any], said: Outcome, opinions: Sequence[Opinion], case: Case) -> Round:
    """Every method against the truth."""
    sort, accepted = sort_of(key), [sorted(group) for group in key["accepted"]]
    known = accepted if sort in ("catalogue", "pair") else []
    hidden = (
        [e["name"] for e in key["effects"]] if sort == "outside" else [group[0] for group in known]
    )
    outcome = replace(
        said, sort=sort, hidden=hidden, named=accepted_names(said.named, known), achievable=1.0
    )
    equations = {e.id: equation_of(e) for e in effects_of(case.data.rig)}
    sits_in = {equations[i] for group in known for i in group if i in equations} - {"reading"}
    # What the supply does wrong is seen in the flows.
    sits_in |= {"flow"} if "supply" in sits_in else set()
    return Round(
        outcome,
        sorted(sits_in),
        [replace(o, named=accepted_names(o.named, known)) for o in opinions],
    )


def sort_of(key: dict[str, Any]) -> str:
    """ "healthy", "outside", "catalogue" or "pair"."""
    effects = [e["name"] for e in key["effects"]]
    if effects == ["none"]:
        return "healthy"
    if effects[0].startswith(OUTSIDE):
        return "outside"
    return "catalogue" if len(effects) == 1 else "pair"


def accepted_names(
    named: Sequence[Sequence[str]], accepted: Sequence[Sequence[str]]
) -> list[list[str]]:
    """Effects by their id, whatever their signal; of those that are accepted for one, the first of these."""
    first = {effect: group[0] for group in accepted for effect in group}
    return [[first.get(i, i) for i in (m.partition(":")[0] for m in members)] for members in named]


def play_folder(folder: Path, file: Path, ask: AskPeers, each: Callable[[], None]) -> list[Round]:
    """Every set that is not in the file yet, each written as it comes."""
    have = {r.outcome.seed: r for r in load(file)}
    file.parent.mkdir(parents=True, exist_ok=True)
    rounds = []
    with file.open("a", encoding="utf-8") as log:
        for number, name in enumerate(sets_of(folder)):
            found = have.get(number)
            if found is None:
                found = play_set(folder, number, name, ask)
                log.write(json.dumps(asdict(found)) + "\n")
                log.flush()
            rounds.append(found)
            each()
    return rounds
