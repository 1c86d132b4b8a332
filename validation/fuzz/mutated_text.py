"""What is done to text with a structure: TOML and DBC, logs of a bus, the words of a command line."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator
from typing import Any

from validation.fuzz.mutations import NAMES, NUMBERS, UNITS, Random, pick

_VALUE = re.compile(r"(?<![\w.])[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?(?![\w.])", re.IGNORECASE)
_WORD = re.compile(r"[A-Za-z_]\w{2,}")
_QUOTED = re.compile(r'"[^"\n]*"')
_UNIT = re.compile(r'(?<=\d )[A-Za-z^*/ \d]+(?=")')
_OCTETS = re.compile(r"[0-9A-Fa-f]{2,}")
_JSON: tuple[Any, ...] = (
    None,
    True,
    "",
    "x" * 300,
    "[/red]",
    "\ud800",
    -1,
    0,
    1e308,
    1e-320,
    10**400,
    [],
    {},
    [[]],
    {"a": None},
)
OUTPUTS = ("--out", "-o", "--output", "--json", "--record", "record")
"""After these comes what is written."""
OPTIONS = (
    "--seed", "--out", "--set", "--scale", "--huber", "--starts", "--alpha", "--from", "--to", "--shift", "--signal",
    "--pair", "--input", "--align", "--json", "--empirical", "--workers", "--speed",
)  # fmt: skip


def _one(pattern: re.Pattern[str], text: str, new: Callable[[str], str], random: Random) -> str:
    """One of what fits a pattern replaced."""
    found = list(pattern.finditer(text))
    if not found:
        return text + new("x")
    one = pick(found, random)
    return text[: one.start()] + new(one[0]) + text[one.end() :]


def _misspelt(word: str, random: Random) -> str:
    i = int(random.integers(len(word)))
    return pick(
        (word[:i] + word[i + 1 :], word[:i] + word[i:i] + word[i:], word.upper(), word + "_9"),
        random,
    )


def spoil_json(content: bytes, random: Random) -> bytes:
    """One value of it lost, doubled, of another kind or another size; or its text as that of a TOML file."""
    try:
        tree = json.loads(content)
    except ValueError:
        return spoil_toml(content, random)
    if random.uniform() < 0.1:
        return spoil_toml(content, random)
    places = list(_places(tree))
    if not places:
        return json.dumps(pick(_JSON, random)).encode()
    holder, key = pick(places, random)
    how = int(random.integers(4))
    if how == 0:
        del holder[key]
    elif how == 1 and isinstance(holder, list):
        holder.append(holder[key])
    elif how == 2 and isinstance(holder[key], float):
        holder[key] *= float(pick((-1.0, 1e3, 1e300, float("nan"), float("inf")), random))
    else:
        holder[key] = pick(_JSON, random)
    return json.dumps(tree).encode()


def _places(tree: Any) -> Iterator[tuple[Any, Any]]:
    """Every holder and key of a value, at any depth."""
    keys = tree if isinstance(tree, dict) else range(len(tree)) if isinstance(tree, list) else ()
    for key in keys:
        yield tree, key
        yield from _places(tree[key])


def _quoted(word: str) -> str:
    """As TOML wants it, so that the odd name gets past its reader."""
    return (
        '"'
        + "".join(c if c.isprintable() and c not in '"\\' else f"\\u{ord(c):04x}" for c in word)
        + '"'
    )


def _nested(random: Random) -> str:
    deep = pick((90, 1000, 20000), random)
    names = (
        f"[{'a.' * deep}a]",
        f"{'a.' * deep}a = 1",
        "".join(f"[{'b.' * i}b]\n" for i in range(200)),
    )
    return pick(
        (f"x = {'[' * deep}{']' * deep}", f"x = {'{a = ' * deep}1{'}' * deep}", *names), random
    )


def spoil_toml(content: bytes, random: Random) -> bytes:
    """One key, value, line or table of it."""
    text = content.decode("utf-8", "replace")
    lines = text.splitlines()
    i, j = (int(k) for k in random.integers(len(lines) + 1, size=2))
    head = pick([k for k, line in enumerate(lines) if line.startswith("[")] or [0], random)
    how = int(random.integers(12))
    if how < 8:
        what = (_VALUE, _VALUE, _VALUE, _QUOTED, _QUOTED, _QUOTED, _UNIT, _WORD)[how]
        new = pick(NUMBERS, random) if how in (0, 1, 2, 3) else _quoted(pick(NAMES, random))
        unit = pick(UNITS, random)
        text = _one(
            what, text, lambda old: (new, unit, _misspelt(old, random))[max(how - 5, 0)], random
        )
    else:
        lost, double = lines[:i] + lines[i + 1 :], [*lines[:i], *lines[j : j + 3], *lines[i:]]
        deep, headless = (
            [*lines[:i], _nested(random), *lines[i:]],
            lines[:head] + lines[head + 1 + 3 * (i % 2) :],
        )
        text = "\n".join((lost, double, deep, headless)[how - 8])
    return text.encode("utf-8", "surrogatepass")


def spoil_log(content: bytes, random: Random) -> bytes:
    """Lines out of order, lost, doubled or cut; or some numbers or octets."""
    text = content.decode("utf-8", "replace")
    lines = text.splitlines()
    i, j = sorted(int(k) for k in random.integers(len(lines) + 1, size=2))
    what = pick((_VALUE, _OCTETS), random)
    for _ in range(1 + i % 4):
        text = _one(what, text, lambda _: pick((*NUMBERS, "FF", "7FFFFFFF"), random), random)
    cut = [line[: 1 + i % 60] if k % 3 == 0 else line for k, line in enumerate(lines)]
    back, double = lines[:i] + lines[i:j][::-1] + lines[j:], lines[:j] + lines[i:]
    options = [text, text, *map("\n".join, (cut, back, double, lines[:i] + lines[j:]))]
    return pick(options, random).encode()


def spoil_words(command: tuple[str, ...], random: Random) -> tuple[str, ...]:
    """A word or a number of the command line replaced, doubled or left out; an option added."""
    words = list(command)
    i, how = int(random.integers(len(words))), int(random.integers(6))
    new = pick(NAMES if random.integers(2) else NUMBERS, random)
    if how <= 2:
        left, equals, _ = words[i].partition("=")
        words[i] = f"{left}={new}" if equals else new
    elif how == 3:
        del words[i]
    elif how == 4:
        words.insert(i, words[i])
    else:
        words += [pick(OPTIONS, random), new]
    for k in range(1, len(words)):  # who is root must not lose what is there
        if words[k - 1] in OUTPUTS and words[k].startswith("/"):
            words[k] = "/proc/nothing"
    return tuple(word.replace("\x00", "") for word in words)  # no command line can hold one
