"""The picture of the live page in docs/watch.md: a virtual bench that begins to leak, watched while its log grows.

python -m tools.watch_picture        (needs Chromium: apt-get install chromium; some minutes)
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from tools.chromium import chromium, photograph
from validation.twins import effects
from validation.twins.draw import draw_trial, write_trial
from validation.twins.rig_file import write_record
from validation.twins.traffic import Change, traffic

PICTURE = Path(__file__).resolve().parents[1] / "docs" / "watch.png"
SIZE = 1000, 900
SEED, LEAK = 1, 7e-10
"""Of the bench; kg/(s Pa)."""
LEARN, ONSET, END = 240.0, 480.0, 660.0
"""s"""
PATIENCE = 900.0
"""s until the diagnosis must be there."""


def write_day(folder: Path) -> Path:
    """rig.toml in a folder, and the log of the bench beside it."""
    trial = draw_trial("bench", SEED, "none", 3.0, 2.0)
    write_trial(trial, folder, folder.parent / "sealed.json")
    leak = effects.find("bench", "fitting_leakage:lower")[0].hidden_in(trial.truth, LEAK)
    pieces = list(traffic(trial, END, SEED, (Change(ONSET, leak),)))
    columns = {n: np.concatenate([p[n] for p in pieces]) for n in pieces[0]}
    write_record(folder / "day.csv", columns)
    return folder / "rig.toml"


def has_happened(log: Path, event: str) -> bool:
    """Whether an event stands in the log."""
    lines = log.read_text().splitlines() if log.exists() else []
    return any(json.loads(line)["event"] == event for line in lines)


def main() -> int:
    argparse.ArgumentParser(prog="python -m tools.watch_picture", description=__doc__).parse_args()
    browser = chromium()
    if browser is None:
        print("watch_picture: no Chromium here; apt-get install chromium", file=sys.stderr)
        return 2
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        rig = write_day(folder / "bench")
        command = [sys.executable, "-m", "sms.cli", "watch", str(rig)]
        command += ["--follow", str(rig.with_name("day.csv")), "--learn", f"{LEARN:g}"]
        command += ["--out", str(folder / "out"), "--page", "127.0.0.1:0", "--quiet"]
        watch = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
        try:
            assert watch.stdout is not None
            address = watch.stdout.readline().split()[-1]
            end = time.monotonic() + PATIENCE
            while not has_happened(folder / "out" / "events.jsonl", "diagnosed"):
                if time.monotonic() > end or watch.poll() is not None:
                    print("watch_picture: the leak was not diagnosed", file=sys.stderr)
                    return 1
                time.sleep(1.0)
            photograph(browser, address, PICTURE, SIZE, folder / "profile", "--timeout=4000")
        finally:
            watch.terminate()
            watch.wait()
    print(PICTURE)
    return 0


if __name__ == "__main__":
    sys.exit(main())
