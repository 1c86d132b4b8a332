"""The picture of the history page in docs/history_of_a_machine.md: a leak that grows over twelve diagnoses.

python -m tools.history_picture        (needs Chromium: apt-get install chromium)
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
from datetime import timedelta
from pathlib import Path

import numpy as np
from sms.diagnosis.thresholds import DETECTION

from tools.chromium import chromium, photograph
from validation.trials.history import BEGIN, LEAK, RECORDS, as_files, drawn_answer

PICTURE = Path(__file__).resolve().parents[1] / "docs" / "history.png"
SIZE = 1000, 1340
SEED, ONSET, REPAIRED = 3, 5, 7
"""Of what is drawn; the diagnoses at which the leak begins, and before which a stiff seal is changed."""
GROWTH, STIFF = 0.6, 3.0
"""Of their detection limits: by what the leak grows from each diagnosis to the next, and the friction of that seal."""


def diagnoses() -> list[str]:
    """Each as JSON, a month apart."""
    rng = np.random.default_rng(SEED)
    texts = []
    for number in range(RECORDS):
        truth = {
            LEAK: DETECTION * GROWTH * max(number - ONSET + 1, 0),
            "coulomb_force": DETECTION * STIFF if number < REPAIRED else 0.0,
        }
        when = BEGIN + timedelta(days=30.4 * number + rng.uniform(-5.0, 5.0))
        texts.append(drawn_answer(rng, truth, when, float(np.exp(rng.uniform(-0.2, 0.2)))))
    return texts


def main() -> int:
    argparse.ArgumentParser(
        prog="python -m tools.history_picture", description=__doc__
    ).parse_args()
    browser = chromium()
    if browser is None:
        print("history_picture: no Chromium here; apt-get install chromium", file=sys.stderr)
        return 2
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        as_files(diagnoses(), folder / "reports")
        command = [sys.executable, "-m", "sms.cli", "history", "machine.sqlite"]
        command += ["--add", "reports", "--limit", f"{LEAK}=1e-9", "--out", "page"]
        subprocess.run(command, cwd=folder, check=True, stdout=subprocess.DEVNULL)
        page = (folder / "page" / "history.html").as_uri()
        photograph(browser, page, PICTURE, SIZE, folder / "profile", "--virtual-time-budget=5000")
    print(PICTURE)
    return 0


if __name__ == "__main__":
    sys.exit(main())
