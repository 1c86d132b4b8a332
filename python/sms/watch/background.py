"""A full diagnosis in a process of its own, so that the watch goes on."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

NICE = 10
"""The watch comes first."""


@dataclass(frozen=True)
class Verdict:
    """What a diagnosis said."""

    alarm: int
    verdict: str
    sentence: str
    folder: Path
    causes: tuple[str, ...] = ()
    """Effects that it names, those of an ambiguity group one by one."""

    def to_dict(self) -> dict[str, Any]:
        """For the log."""
        return {
            "alarm": self.alarm,
            "verdict": self.verdict,
            "sentence": self.sentence,
            "causes": list(self.causes),
            "folder": str(self.folder),
        }


class Diagnosis:
    """`sms diagnose` on an excerpt, as a process."""

    def __init__(self, alarm: int, rig: Path) -> None:
        self.alarm, self.folder = alarm, rig.parent
        self._log = (self.folder / "diagnose.log").open("wb")
        environment = {**os.environ, "SMS_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
        command = [sys.executable, "-m", "sms.cli", "diagnose", str(rig), "--out", str(self.folder)]
        self._process = subprocess.Popen(
            command,
            stdin=subprocess.DEVNULL,
            stdout=self._log,
            stderr=subprocess.STDOUT,
            env=environment,
            start_new_session=True,
        )
        if hasattr(os, "setpriority"):
            os.setpriority(os.PRIO_PROCESS, self._process.pid, NICE)

    def poll(self) -> Verdict | None:
        """Its verdict, once it is there."""
        if self._process.poll() is None:
            return None
        self._log.close()
        if self._process.returncode != 0:
            said = (self.folder / "diagnose.log").read_text(errors="replace").strip().splitlines()
            last = said[-1] if said else f"exit code {self._process.returncode}"
            return Verdict(self.alarm, "failed", f"the diagnosis ended: {last}", self.folder)
        answer = json.loads((self.folder / "diagnosis.json").read_text())
        named = [m for c in answer.get("causes", []) for m in (c, *c.get("alternatives", []))]
        causes = tuple(_key(m) for m in named)
        return Verdict(self.alarm, answer["verdict"], answer["sentence"], self.folder, causes)

    def wait(self) -> Verdict:
        """The same, waiting for it."""
        while (verdict := self.poll()) is None:
            time.sleep(0.2)
        return verdict

    def stop(self) -> None:
        """End it."""
        if self._process.poll() is None:
            self._process.terminate()
            self._process.wait()
        self._log.close()


def _key(cause: dict[str, Any]) -> str:
    """As Effect.key has it."""
    signal = cause.get("signal")
    return cause["effect"] if signal is None else f"{cause['effect']} of {signal}"
