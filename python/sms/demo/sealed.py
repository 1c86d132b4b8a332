"""What is hidden, sealed: its hash is told before anybody looks for it, so that nobody can change the answer after."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Sealed:
    """The truth as the bytes of a JSON file."""

    content: bytes

    @classmethod
    def of(cls, truth: Mapping[str, Any], salt: bytes) -> Sealed:
        """The truth as text; the salt keeps it from being guessed by its hash."""
        salted = {**truth, "salt": salt.hex()}
        return cls((json.dumps(salted, indent=2) + "\n").encode())

    @property
    def sha256(self) -> str:
        """The seal."""
        return hashlib.sha256(self.content).hexdigest()


def open_sealed(content: bytes, sha256: str) -> dict[str, Any]:
    """The truth; ValueError if it is not the one of this seal."""
    if Sealed(content).sha256 != sha256.strip():
        raise ValueError("this is not the truth that was sealed")
    truth: dict[str, Any] = json.loads(content)
    return truth
