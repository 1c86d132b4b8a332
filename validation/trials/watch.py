"""`./dev trials watch`: false alarms of healthy machines, and how soon a leak is alarmed and named.

Each machine is an imperfect bench (validation/twins/imperfection.py) that is moved to and fro by motions drawn anew
all the time. It is learned for ten minutes, runs on for so many hours as it is, and then leaks: one of its fittings
or its piston, by a multiple of the detection limit of the blind trials (validation/twins/limits). The log is played
as fast as it can be watched. One line of a JSON-lines file a machine, so that a run can be stopped and taken up
again.
"""

from __future__ import annotations

import os
import secrets
import tempfile
import time
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Annotated

import numpy as np
import psutil
import typer
from rich.console import Console
from rich.table import Table
from sms.io.json_files import from_json_line, json_line, json_text
from sms.io.rig import load_rig
from sms.io.write import write_text_atomically
from sms.watch.alarm import Alarm
from sms.watch.background import Verdict
from sms.watch.detector import Look
from sms.watch.feed import Chunk
from sms.watch.log import EventLog
from sms.watch.segments import SEGMENT
from sms.watch.watch import Options, Watch

from validation.trials.shares import Share, at_least, share_table, shares_as_dicts
from validation.twins import effects, limits
from validation.twins.draw import Trial, draw_trial, write_trial
from validation.twins.effects import Effect
from validation.twins.traffic import PIECE, Change, traffic

LEVELS = (1.0, 2.0, 3.0)
"""Percent by which the machines are off from what can be declared, in turn."""
LEAKS = ("fitting_leakage:lower", "fitting_leakage:upper", "piston_leakage")
EXCITED_BY = "multisine+holds"
"""Whose limits are those of the leaks: two of the motions."""
LEARN = 600.0
LEAKING = 300.0
"""s of rows after the onset."""
SOON = 60.0
"""s"""


@dataclass(frozen=True)
class Watched:
    """What became of one machine."""

    seed: int
    imperfection: float
    leak: str
    size: float
    """kg/(s Pa)"""
    hours: float
    """Healthy, after it was learned."""
    false_alarms: int
    nearest: float
    """The largest evidence of the healthy hours, of the threshold."""
    alarmed_after: float | None
    """s of rows since the onset; None: not."""
    onset_error: float | None
    """s"""
    first_guess: bool | None
    """Whether what it leaks is among the effects that fit, a minute after the onset."""
    verdict: str | None
    named: bool | None
    """Whether the diagnosis of a minute of rows names it."""
    times_real: float
    """Rows' time over processor time, of the healthy hours."""
    growth: float
    """Of the process's memory over the healthy hours after the first quarter, MiB."""


@dataclass
class Followed:
    """What is kept while a machine is watched."""

    onset: float
    key: str
    nearest: float = 0.0
    guessed: bool | None = None


def key_of(effect: str) -> str:
    """An effect's key in the words of the generator: "fitting_leakage:lower"."""
    return effect.replace(" of ", ":")


def watched(seed: int, hours: float, multiple: float, number: int) -> Watched:
    """Watch one machine."""
    level = LEVELS[number % len(LEVELS)]
    leak = effects.find("bench", LEAKS[number // len(LEVELS) % len(LEAKS)])[0]
    trial = draw_trial("bench", seed, "none", 3.0, level)
    limit = limits.read("bench")[EXCITED_BY][leak.key]
    assert limit is not None
    size = multiple * limit * trial.loudness
    onset = LEARN + max(3600.0 * hours, PIECE)
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder)
        write_trial(trial, out / "records", out / "sealed" / "truth.json")
        log = EventLog(out / "watch" / "events.jsonl")
        rig = load_rig(out / "records" / "rig.toml")
        beside = Watch(rig, Options(LEARN), out / "watch", log)
        kept = Followed(onset, leak.key)
        used = _play(beside, kept, trial, seed, leak, size)
        beside.finish()
        beside.close()
    return _outcome(seed, level, size, beside, kept, used)


def _play(
    beside: Watch, kept: Followed, trial: Trial, seed: int, leak: Effect, size: float
) -> tuple[float, float]:
    """Processor time per second of rows, and the growth of the memory, MiB; over the healthy hours."""
    change = Change(kept.onset, leak.hidden_in(trial.truth, size))
    process, marks = psutil.Process(), []

    def chunks() -> Iterator[Chunk]:
        own = 0.0
        for piece in traffic(trial, kept.onset + LEAKING, seed, (change,)):
            begin = float(piece["time"][0])
            own -= time.process_time()
            yield Chunk(piece)
            own += time.process_time()
            if LEARN + PIECE <= begin < kept.onset:
                marks.append((begin, own, process.memory_info().rss / 2**20))

    def look_at(look: Look, alarm: Alarm | None) -> None:
        if look.end <= kept.onset:
            kept.nearest = max(kept.nearest, look.highest)
        elif alarm is not None and look.end <= kept.onset + SOON + SEGMENT:
            kept.guessed = kept.key in [key_of(g.effect) for g in alarm.guesses]

    beside.on_look = look_at
    beside.run(chunks())
    if len(marks) < 2:
        return float("nan"), float("nan")
    quarter = marks[len(marks) // 4]
    first, last = marks[0], marks[-1]
    return (last[1] - first[1]) / (last[0] - first[0]), last[2] - quarter[2]


def _outcome(
    seed: int, level: float, size: float, beside: Watch, kept: Followed, used: tuple[float, float]
) -> Watched:
    false = [a for a in beside.alarms if a.raised <= kept.onset]
    alarm = next((a for a in beside.alarms if a.raised > kept.onset), None)
    verdict: Verdict | None = None
    if alarm is not None:
        verdict = next((v for v in beside.verdicts if v.alarm == alarm.number), None)
    return Watched(
        seed,
        level,
        kept.key,
        size,
        (kept.onset - LEARN) / 3600.0,
        len(false),
        kept.nearest,
        None if alarm is None else alarm.raised - kept.onset,
        None if alarm is None else alarm.since - kept.onset,
        kept.guessed,
        None if verdict is None else verdict.verdict,
        None if verdict is None else kept.key in [key_of(c) for c in verdict.causes],
        1.0 / used[0],
        used[1],
    )


# ---- what is printed -------------------------------------------------------------------------------


def shares_of(found: Sequence[Watched]) -> list[Share]:
    """What was promised, counted."""
    soon = [w.alarmed_after is not None and w.alarmed_after <= SOON for w in found]
    return [
        at_least(f"leak alarmed within {SOON:g} s", soon),
        at_least(
            "leak among the effects that fit, a minute after its onset",
            [bool(w.first_guess) for w in found],
        ),
        at_least("leak named by the diagnosis of a minute of rows", [bool(w.named) for w in found]),
    ]


def table_of(found: Sequence[Watched]) -> Table:
    """A row a machine."""
    out = Table(
        *("seed", "off by", "leak", "healthy h", "false alarms", "nearest", "alarmed after"),
        *("onset off by", "fits", "diagnosed", "x real time", "memory"),
    )
    for w in found:
        after = "not" if w.alarmed_after is None else f"{w.alarmed_after:.0f} s"
        off = "-" if w.onset_error is None else f"{w.onset_error:+.0f} s"
        named = {True: "right", False: f"{w.verdict}, wrong", None: "-"}[w.named]
        out.add_row(
            *(str(w.seed), f"{w.imperfection:g} %", w.leak, f"{w.hours:.2f}", str(w.false_alarms)),
            *(f"{100.0 * w.nearest:.0f} %", after, off, "yes" if w.first_guess else "no", named),
            *(f"{w.times_real:.1f}", f"{w.growth:+.1f} MiB"),
        )
    return out


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command()(watch)


def watch(
    count: Annotated[int, typer.Option(min=1, help="Machines.")] = 6,
    seed: Annotated[
        int | None, typer.Option(help="Of the first machine. By default drawn, and printed.")
    ] = None,
    hours: Annotated[
        float, typer.Option(min=0.0, help="Healthy hours of each, after it was learned.")
    ] = 0.5,
    multiple: Annotated[
        float, typer.Option(help="Of its detection limit that it then leaks.")
    ] = 3.0,
    out: Annotated[
        Path, typer.Option(help="Folder for watch.jsonl; what is in it is not done twice.")
    ] = Path("trials"),
    as_json: Annotated[Path | None, typer.Option("--json", help="Also to this file.")] = None,
) -> None:
    """Watch virtual benches that are well for hours and then leak: false alarms, delay, names, speed, memory."""
    os.environ.setdefault("SMS_THREADS", "1")
    seed = secrets.randbelow(10**6) if seed is None else seed
    console = Console(width=200)
    console.print(
        f"seed {seed}, {count} machines, {hours:g} h each, {multiple:g} x the limit", style="dim"
    )
    file = out / "watch.jsonl"
    file.parent.mkdir(parents=True, exist_ok=True)
    lines = file.read_text().splitlines() if file.exists() else []
    have = {w["seed"]: Watched(**w) for w in map(from_json_line, lines)}
    found = []
    for number in range(count):
        if seed + number not in have:
            have[seed + number] = watched(seed + number, hours, multiple, number)
            with file.open("a") as log:
                log.write(json_line("watch_trials", asdict(have[seed + number])))
        found.append(have[seed + number])
        console.print(table_of(found[-1:]))
    console.print(table_of(found))
    healthy = sum(w.hours for w in found)
    false = sum(w.false_alarms for w in found)
    console.print(f"{false} false alarms in {healthy:.1f} h of healthy machines")
    console.print(share_table(shares_of(found)))
    if as_json is not None:
        content = {
            "seed": seed,
            "count": count,
            "healthy_hours": healthy,
            "false_alarms": false,
            "median_delay_s": float(
                np.median([np.inf if w.alarmed_after is None else w.alarmed_after for w in found])
            ),
            "shares": shares_as_dicts(shares_of(found)),
            "machines": [asdict(w) for w in found],
        }
        write_text_atomically(as_json, json_text("watch_trials", content))
