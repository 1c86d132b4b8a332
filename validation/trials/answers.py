"""What the diagnosis says of a folder of records, as trials need it."""

from __future__ import annotations

import os
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from sms.diagnosis.effects.catalogue import Effect, effects_of
from sms.diagnosis.pipeline import read_and_check
from sms.diagnosis.preparation import make_data
from sms.diagnosis.simulated import Case, investigate
from sms.io.rig import load_rig


@dataclass(frozen=True)
class Answered:
    """A diagnosis of a folder of records."""

    case: Case
    block: str
    """The equation that takes most, for the verdict unknown."""
    seconds: float
    """Of processor time."""

    @property
    def named(self) -> list[list[str]]:
        """The members of each named cause."""
        return [[key_of(m.effect) for m in members] for members in self.case.outcome.groups]


def answered(records: Path, seed: int) -> Answered:
    """Diagnose the records of a folder, on one thread."""
    os.environ.setdefault("SMS_THREADS", "1")
    begin = time.process_time()
    rig = load_rig(records / "rig.toml")
    read, _ = read_and_check(rig)
    data, rng = make_data(rig, read), np.random.default_rng(seed)
    case = investigate(data, effects_of(rig), rng, lambda text, done: None)
    unknown = case.verdict == "unknown"
    block = case.where(np.random.default_rng(seed)).equation if unknown else ""
    return Answered(case, block, time.process_time() - begin)


def key_of(effect: Effect) -> str:
    """An effect's name in the words of the generator: "sensor_gain:extension"."""
    return effect.key.replace(" of ", ":")
