"""What is done to any file: random bytes, other encodings, packing; and the odd numbers and names for all others.

Each mutation takes the content of a file and a generator, and returns what replaces it. None of them knows what the
right answer is: that a command refuses in one sentence, or answers, is all that is asked.
"""

from __future__ import annotations

import gzip
from collections.abc import Callable, Sequence
from typing import TypeVar

import numpy as np

Random = np.random.Generator
Mutation = Callable[[bytes, Random], bytes]
Anything = TypeVar("Anything")

NUMBERS = (
    "nan", "inf", "-inf", "1e308", "-1e308", "1e-320", "-1", "0", "-0.0", "1", "1e9", "3000000000", "1e999999", "0x1F",
    "1_000", "12abc", "٣", "true", "''", "[]", "{}", "9" * 5000, "1979-05-27", "[1, [2, 'a']]", "0.1", "100", "1e-3",
)  # fmt: skip
NAMES = (
    "[/red]", "[bold]", "[link=x]", "~nosuchuser", "~", "/", "..", ".", "-", "--help", "con:", "\\", "=", "*", "a/b",
    "ünïcødé", "日本", "'", '"', "</script>", "$HOME", "nan", "%s %d {0}", "a\x00b", "a" * 300, " ", "\n", "\t", "",
    "\u202egpj", "a\udcffb", "rig.toml", "time", "time [s]", "/dev/null", "/dev/zero", "/proc/nothing/x",
)  # fmt: skip
UNITS = ("m", "mm", "kg", "bar", "V", "s", "ms", "1", "%", "furlong", "m/", "m^999", "1e5", "")
ENCODINGS = ("utf-16", "utf-32", "utf-16-be", "latin-1", "utf-8-sig", "cp037")


def pick(among: Sequence[Anything], random: Random) -> Anything:
    """One of them."""
    return among[int(random.integers(len(among)))]


def spoil_bytes(content: bytes, random: Random) -> bytes:
    """Cut off, lost, doubled, inserted, overwritten, changed here and there, or all random."""
    i, j = sorted(int(k) for k in random.integers(len(content) + 1, size=2))
    noise = random.bytes(int(random.integers(1, 64)))
    data = bytearray(content)
    for place in random.integers(len(content) + 1, size=20):
        data[place : place + 1] = random.bytes(1)
    head, tail = content[:i], content[j:]
    inserted, written = head + noise + content[i:], head + noise + content[i + len(noise) :]
    options = (head, head + tail, head + content[i:j] + content[i:], inserted, written, bytes(data))
    return pick((*options, 40 * noise), random)


def spoil_encoding(content: bytes, random: Random) -> bytes:
    """Another encoding, with a letter in which they differ."""
    text = content.decode("utf-8", "replace").replace("a", "ä", 3)
    return text.encode(pick(ENCODINGS, random), "replace")


def spoil_packing(content: bytes, random: Random) -> bytes:
    """A packed file that is cut off, or broken, or holds 200 MB more; or what is not packed."""
    packed, how = gzip.compress(content, 1, mtime=0), int(random.integers(4))
    if how == 0:
        return gzip.compress(content + b"0,\n" * 70_000_000, 1, mtime=0)
    half = packed[: int(random.integers(len(packed)))]
    return (content, half, packed[:20] + random.bytes(40) + packed[60:])[how - 1]
