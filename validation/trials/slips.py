"""`./dev trials slips`: rig files and records with a slip of the pen, and whether the diagnosis says which one.

A slip is no effect of the machine: a unit, a sign, a gauge pressure, two columns, a clock. Each is made in records of
virtual machines that are well, and of others that hide an effect of the catalogue. The honest answer is the verdict
data-fault, or a refusal, with the line to write; a physical cause is the worst.
"""

from __future__ import annotations

import re
import secrets
import shutil
import tempfile
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console
from rich.progress import track
from rich.table import Table
from sms.diagnosis import diagnose
from sms.diagnosis.pipeline import read_and_check
from sms.errors import InputError
from sms.io import load_rig
from sms.io.json_files import json_text
from sms.io.write import write_text_atomically

from validation.trials.bad_input import records, spoil
from validation.trials.shares import at_least, at_most, shares_as_dicts
from validation.twins.draw import draw

KINDS = ("bench", "platform", "tank")
AMBIENT = r"^ambient_pressure = \{ value = \"?([-+.0-9e]+) ?(\w*)"


@dataclass(frozen=True)
class Slip:
    """signals: of each kind, those in which it is made; words: what the answer has to say, of each of them."""

    name: str
    signals: Mapping[str, tuple[str, ...]]
    make: Callable[[Path, tuple[str, ...]], None]
    words: str


def _shifted(folder: Path, signals: tuple[str, ...]) -> None:
    """Gauge readings where absolute ones are declared: the ambient pressure is missing in each."""
    found = re.search(AMBIENT, (folder / "rig.toml").read_text(), re.MULTILINE)
    ambient = float(found[1]) * {"kPa": 1e3, "bar": 1e5}.get(found[2], 1.0) if found else 86e3
    for signal in signals:
        spoil(folder, signal, lambda i, time, values: values - ambient)


def _scaled(factor: float, offset: float = 0.0) -> Callable[[Path, tuple[str, ...]], None]:
    def make(folder: Path, signals: tuple[str, ...]) -> None:
        for signal in signals:
            spoil(folder, signal, lambda i, time, values: factor * values + offset)

    return make


def _exchanged(folder: Path, signals: tuple[str, ...]) -> None:
    """The names of two columns in each other's place."""
    one, other = signals
    for path in records(folder):
        head, rest = path.read_text().split("\n", 1)
        names = [
            n.replace(one, "\0").replace(other, one).replace("\0", other) for n in head.split(",")
        ]
        path.write_text(",".join(names) + "\n" + rest)


LOWER, UPPER = "chamber_pressure_lower", "chamber_pressure_upper"
PRESSURES = {
    "bench": (LOWER, UPPER),
    "platform": tuple(f"{p}_{leg}" for p in (LOWER, UPPER) for leg in (1, 2, 3)),
    "tank": ("tank_pressure",),
}
COMMANDS = {
    "bench": ("valve_command",),
    "platform": ("valve_command_2",),
    "tank": ("valve_command",),
}
POSITIONS = {"bench": ("extension",), "platform": ("extension_3",)}
TIME = {kind: ("time",) for kind in KINDS}
SLIPS = (
    Slip("chamber or tank pressures gauge, declared absolute", PRESSURES, _shifted, "gauge = true"),
    Slip("one chamber's pressure gauge", {"bench": (UPPER,), "platform": (f"{LOWER}_2",)}, _shifted, "gauge = true"),
    Slip("chambers exchanged", {"bench": (LOWER, UPPER), "platform": (f"{LOWER}_1", f"{UPPER}_1")}, _exchanged,
         "exchange the columns"),
    Slip("position reversed", POSITIONS, _scaled(-1.0), "scale = -1"),
    Slip("position in cm", POSITIONS, _scaled(100.0), 'unit = "cm"'),
    Slip("command reversed", COMMANDS, _scaled(-1.0, 10.0), "scale = -1"),
    Slip("pressures in bar", PRESSURES, _scaled(1e-5), 'unit = "bar"'),
    Slip("time in ms", TIME, _scaled(1e3), 'unit = "ms"'),
    Slip("time stretched by 10 %", TIME, _scaled(1.1), "scale = 0.909"),
)  # fmt: skip


class _UnderWayError(Exception):
    """The checks have nothing to say: the diagnosis begins to fit."""


def said_before_fitting(rig: Path) -> str:
    """What the diagnosis says of the declaration and the records before it fits anything; empty if nothing."""

    def progress(text: str, done: float) -> None:
        if text.startswith("fitting"):
            raise _UnderWayError

    try:
        answer = diagnose(rig, progress=progress)
    except InputError as problem:
        return str(problem)
    except _UnderWayError:
        warned = read_and_check(load_rig(rig))[1]
        return " ".join(f.remedy for f in warned if f.severity == "warning")
    return (
        f"{answer.sentence} {' '.join(f.remedy for f in answer.findings if f.severity == 'error')}"
    )


@dataclass(frozen=True)
class Tried:
    slip: str
    kind: str
    seed: int
    said: str
    right: bool


def try_machine(kind: str, seed: int, folder: Path) -> list[Tried]:
    """One machine without a slip, and with each."""
    clean = folder / "clean"
    draw(kind, seed, clean, folder / "truth.json", "none" if seed % 2 else None, imperfection=1.0)
    said = said_before_fitting(clean / "rig.toml")
    tried = [Tried("none", kind, seed, said, not said)]
    for slip in SLIPS:
        if kind not in slip.signals:
            continue
        spoilt = folder / "spoilt"
        shutil.copytree(clean, spoilt)
        slip.make(spoilt, slip.signals[kind])
        said = said_before_fitting(spoilt / "rig.toml")
        tried.append(Tried(slip.name, kind, seed, said, slip.words in said))
        shutil.rmtree(spoilt)
    return tried


def table_of(tried: list[Tried]) -> Table:
    table = Table("slip", *KINDS, title="said, with the line to write")
    for name in ("none", *(slip.name for slip in SLIPS)):
        cells = []
        for kind in KINDS:
            here = [t.right for t in tried if (t.slip, t.kind) == (name, kind)]
            cells.append(f"{sum(here)} of {len(here)}" if here else "-")
        table.add_row("none: left alone" if name == "none" else name, *cells)
    return table


def register(app: typer.Typer) -> None:
    @app.command()
    def slips(
        count: Annotated[int, typer.Option(min=1, help="Machines of each kind.")] = 4,
        seed: Annotated[int | None, typer.Option(help="Of the first; fresh if left out.")] = None,
        out: Annotated[Path | None, typer.Option("--json", help="File for all answers.")] = None,
    ) -> None:
        """Make slips of unit, sign, column, clock in virtual records; count which are said."""
        first = secrets.randbelow(1_000_000) if seed is None else seed
        print(f"seed {first}")
        tried = []
        tasks = [(kind, first + k) for kind in KINDS for k in range(count)]
        for kind, number in track(tasks, "machines", console=Console(stderr=True)):
            with tempfile.TemporaryDirectory() as folder:
                tried += try_machine(kind, number, Path(folder))
        made = [t.right for t in tried if t.slip != "none"]
        alarms = [not t.right for t in tried if t.slip == "none"]
        shares = [
            at_least("slips said, with the line to write", made),
            at_most("false alarms", alarms),
        ]
        console = Console()
        console.print(table_of(tried))
        for share in shares:
            console.print(
                f"{share.what}: {share.count} of {share.of} (95 % bound {share.bound:.0%})"
            )
        for t in tried:
            if not t.right:
                console.print(
                    f"{t.slip}, {t.kind} {t.seed}: {t.said or 'nothing was said'}", markup=False
                )
        if out is not None:
            found = {
                "seed": first,
                "shares": shares_as_dicts(shares),
                "tried": [asdict(t) for t in tried],
            }
            write_text_atomically(out, json_text("trials", found))
