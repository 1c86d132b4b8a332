"""The peers' own environment, build/peers: big packages that nothing of this project depends on."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / "build" / "peers"
REQUIREMENTS = Path(__file__).with_name("peers") / "requirements.txt"


class PeersUnavailableError(RuntimeError):
    """The environment cannot be made here; the text says why."""


def peer_python() -> Path:
    """The environment's Python; makes the environment when it is missing or out of date.

    Raises: PeersUnavailableError when the packages cannot be installed.
    """
    python = FOLDER / "bin" / "python"
    stamp = FOLDER / REQUIREMENTS.name
    wanted = REQUIREMENTS.read_text()
    if python.exists() and stamp.exists() and stamp.read_text() == wanted:
        return python
    print(f"installing {', '.join(wanted.split())} into {FOLDER} (0.7 GB)", flush=True)
    _run([sys.executable, "-m", "venv", "--clear", str(FOLDER)])
    pip = [str(python), "-m", "pip", "--disable-pip-version-check", "install", "--quiet"]
    _run([*pip, "--only-binary", ":all:", "-r", str(REQUIREMENTS)])
    stamp.write_text(wanted)
    return python


def _run(command: list[str]) -> None:
    result = subprocess.run(command, capture_output=True, text=True, check=False)
    if result.returncode:
        said = (result.stderr.strip() or result.stdout.strip() or "no reason given").splitlines()
        raise PeersUnavailableError(
            f"the multibody peers cannot be installed into {FOLDER}: {said[-1]}"
        )
