"""The one exception that a person's input can raise, and the search for the word that was meant."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Sequence

MOST_LISTED = 30  #: known words in one sentence
FEW = 5


class InputError(ValueError):
    """Something in a rig file, a record or an output folder cannot be used.

    The text is one sentence for a person: what is wrong, where, what to do. The command line
    prints it and ends with exit code 2.
    """


def nearest(word: str, known: Iterable[str]) -> str | None:
    """The known word that `word` most likely was meant to be, or None when nothing is near."""
    by_lower_case = {candidate.lower(): candidate for candidate in known}
    found = difflib.get_close_matches(word.lower(), by_lower_case, n=1, cutoff=0.6)
    return by_lower_case[found[0]] if found else None


def did_you_mean(word: str, known: Iterable[str], where_all: str = "") -> str:
    """The remedy for an unknown word: the nearest known one, or else all of them.

    Of more than fit a sentence the nearest few, and `where_all` they stand:
    "`sms can get` lists all".
    """
    candidates = list(known)
    near = nearest(word, candidates)
    if near is not None:
        return f"did you mean '{near}'?"
    if len(candidates) <= MOST_LISTED:
        return f"known are: {', '.join(candidates)}"
    few = f"of {len(candidates)} known ones the nearest are: {', '.join(_nearest_few(word, candidates))}"
    return f"{few}; {where_all}" if where_all else few


def _nearest_few(word: str, candidates: Sequence[str]) -> list[str]:
    """Those that hold the word first, then by likeness."""
    plain = word.lower()
    holding = [candidate for candidate in candidates if plain in candidate.lower()]
    alike = difflib.get_close_matches(plain, candidates, n=FEW, cutoff=0.0)
    return list(dict.fromkeys([*holding, *alike]))[:FEW]
