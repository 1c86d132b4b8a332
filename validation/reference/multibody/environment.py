"""Environments for peers, under build/: big packages that nothing of this project depends on."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
FOLDER = ROOT / "build" / "peers"
REQUIREMENTS = Path(__file__).with_name("peers") / "requirements.txt"


class PeersUnavailableError(RuntimeError):
    """The environment cannot be made here; the text says why."""


def peer_python(
    folder: Path = FOLDER, requirements: Path = REQUIREMENTS, size: str = "0.7 GB"
) -> Path:
    """An environment's Python; makes the environment when it is missing or out of date.

    Raises: PeersUnavailableError when the packages cannot be installed.
    """
    python = folder / "bin" / "python"
    stamp = folder / requirements.name
    wanted = requirements.read_text()
    if python.exists() and stamp.exists() and stamp.read_text() == wanted:
        return python
    print(f"installing {', '.join(wanted.split())} into {folder} ({size})", flush=True)
    _run([sys.executable, "-m", "venv", "--clear", str(folder)], folder)
    pip = [str(python), "-m", "pip", "--disable-pip-version-check", "install", "--quiet"]
    _run([*pip, "--only-binary", ":all:", "-r", str(requirements)], folder)
    stamp.write_text(wanted)
    return python


def _run(command: list[str], folder: Path) -> None:
    result = subprocess.run(command, capture_output=True, text=True, check=False)
    if result.returncode:
        said = (result.stderr.strip() or result.stdout.strip() or "no reason given").splitlines()
        raise PeersUnavailableError(f"the peers cannot be installed into {folder}: {said[-1]}")
