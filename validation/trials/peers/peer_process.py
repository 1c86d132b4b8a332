"""The peers as one process that answers question after question (on_equations.py)."""

from __future__ import annotations

import json
import os
import subprocess
import tempfile
from pathlib import Path
from types import TracebackType

from validation.reference.multibody.environment import ROOT, PeersUnavailableError
from validation.trials.peers.exchange import PlantAnswer, Question


class PeerProcess:
    """Runs as long as the block in which it was opened; on one thread, so that its processor time is comparable."""

    def __init__(self, python: Path) -> None:
        self._python = python

    def __enter__(self) -> PeerProcess:
        self._folder = tempfile.TemporaryDirectory()
        self._errors = (Path(self._folder.name) / "errors").open("w+")
        self._process = subprocess.Popen(
            [str(self._python), "-m", "validation.trials.peers.on_equations"],
            cwd=ROOT,
            env=os.environ | {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self._errors,
            text=True,
        )
        return self

    def ask(self, question: Question) -> dict[str, PlantAnswer]:
        """Method -> answer. PeersUnavailableError with the last line of what went wrong."""
        assert self._process.stdin is not None and self._process.stdout is not None
        file = Path(self._folder.name) / "question.npz"
        question.save(file)
        try:
            self._process.stdin.write(f"{file}\n")
            self._process.stdin.flush()
            line = self._process.stdout.readline()
        except BrokenPipeError:
            line = ""
        if not line:
            self._errors.seek(0)
            said = self._errors.read().strip().splitlines() or ["no reason given"]
            raise PeersUnavailableError(f"the peers failed: {said[-1]}")
        return {name: PlantAnswer(**answer) for name, answer in json.loads(line).items()}

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        assert self._process.stdin is not None and self._process.stdout is not None
        if kind is not None:
            self._process.kill()
        self._process.stdin.close()
        self._process.stdout.close()
        self._process.wait()
        self._errors.close()
        self._folder.cleanup()
