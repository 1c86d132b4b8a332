"""Runs cases, each in a child of its own: imported once, forked thousands of times.

A child that crashes or hangs ends alone. Its memory and its time are limited; what it says goes to files.
"""

from __future__ import annotations

import faulthandler
import gc
import importlib
import json
import os
import resource
import shutil
import signal
import sys
import tempfile
import time
import traceback
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from validation.fuzz.cases import Case, base_of, make
from validation.fuzz.inputs import Base, write_inputs

MEMORY = 3 * 2**30  #: bytes of address space
PROCESSOR_TIME, PATIENCE = 120, 600  #: s; of the processor's, and on the clock
WATCHED = 4.0  #: s, of what runs in real time until Ctrl-C
LARGEST_FILE = 2**30  #: bytes
TRACEBACK, NOT_MADE = 97, 98  #: exit codes of a child
IK_TABLES = Path(__file__).parents[2] / "build" / "package" / "ik_tables" / "ik_tables"
GOOD = ("answered", "refused", "ended as documented")
_SUBJECTS = (
    "sms.cli", "sms.diagnosis", "sms.report.console", "sms.report.files", "sms.report.flow", "sms.report.friction",
    "sms.report.spool", "sms.report.actuator", "sms.report.noise", "sms.report.comparison", "sms.report.limits",
    "sms.report.run_files", "sms.report.sweep", "sms.identification.flow_rig", "sms.identification.actuator",
    "sms.identification.spool", "sms.identification.friction", "sms.comparison.files", "sms.scenario", "sms.sweep.run",
    "sms.scenario.tank", "sms.diagnosis.design.detection_limits", "sms.io.can_logs", "sms.link.replay",
    "sms.link.virtual_rig", "sms.link.monitor", "sms.link.drive", "scipy.signal", "scipy.stats", "pyarrow.parquet",
)  # fmt: skip


@dataclass(frozen=True)
class Outcome:
    """How one case ended."""

    number: int
    case: str  #: the command, and what was spoilt
    verdict: (
        str  #: of GOOD, or: traceback, crash, hang, left files, more than a sentence, exit code ...
    )
    seconds: float
    said: str  #: the end of standard error


def run(seed: int, numbers: range, keep: Path | None, only: str = "") -> Iterator[Outcome]:
    """The outcomes of cases, one by one. keep: folder for the files of those that failed; only: part of a command."""
    for subject in _SUBJECTS:
        importlib.import_module(subject)
    gc.freeze()
    root = Path(tempfile.mkdtemp(prefix="sms-fuzz-"))
    try:
        drawn = [(number, base_of(seed, number)[0]) for number in numbers]
        asked = [(n, b) for n, b in drawn if only in " ".join((b.folder, b.program, *b.command))]
        folders = {base.folder for _, base in asked}
        if _child(lambda: write_inputs(root, folders), root / "inputs") != 0:
            raise RuntimeError((root / "inputs.err").read_text())
        for number, base in asked:
            yield _run_one(seed, number, base, root, keep)
    finally:
        shutil.rmtree(root, ignore_errors=True)


def _run_one(seed: int, number: int, base: Base, root: Path, keep: Path | None) -> Outcome:
    place = root / "cases" / str(number)
    place.mkdir(parents=True)
    folder, told = place / "in", place / "case"

    def work() -> None:
        try:
            case = make(seed, number, root, folder)
        except Exception:
            traceback.print_exc()
            sys.exit(NOT_MADE)
        words = " ".join([f"{base.folder}: {base.program}", *map(ascii, case.command)])
        told.write_text(f"{words} ({case.spoilt!a})")
        os.chdir(folder)
        _command(case)

    began = time.monotonic()
    in_real_time = base.command[0] == "can"  # some of its commands go on until Ctrl-C
    code = _child(work, place / "said", stopped=WATCHED if in_real_time else 0.0)
    seconds = time.monotonic() - began
    said = (place / "said.err").read_text(errors="replace")
    shown = (place / "said.out").read_text(errors="replace")
    verdict = judge(code, said, folder / "out", shown)
    if verdict not in GOOD and keep is not None:
        shutil.copytree(place, keep / f"{seed}-{number}", dirs_exist_ok=True)
    what = told.read_text() if told.exists() else base.folder
    shutil.rmtree(place, ignore_errors=True)
    return Outcome(number, what, verdict, seconds, said[-3000:])


def _command(case: Case) -> None:
    if case.base.program == "ik_tables":
        Path("out").mkdir()
        os.execv(IK_TABLES, [b"ik_tables", *map(os.fsencode, case.command)])
    from sms.cli import main  # noqa: PLC0415 (loaded already)

    sys.argv = ["sms", *case.command]
    main()


def judge(code: int, said: str, out: Path, shown: str = "") -> str:
    """What an exit code (negative: a signal), the text on standard error and that on standard output amount to."""
    lines = [line for line in said.splitlines() if line.strip()]
    if code == NOT_MADE:
        return "the fuzzer's own mistake"
    if code in (-signal.SIGXCPU, -signal.SIGALRM):
        return "hang"
    if code < 0:
        return f"crash ({signal.Signals(-code).name})"
    if code == TRACEBACK or "Traceback (most recent call last)" in said:
        return "traceback"
    if code == 0:
        if "Warning: " in said:
            return "more than a sentence"
        return "answered" if all(map(_is_json, out.glob("*.json"))) else "no JSON"
    if code in (1, 130) and lines and lines[-1].startswith(("sms: ", "ik_tables: ")):
        return "ended as documented"
    if code != 2:
        return f"exit code {code}"
    if "─ Error ─" in said:  # of the parser of the command line
        return "refused"
    if not lines and shown.lstrip().startswith("Usage: "):  # of several commands none was named
        return "ended as documented"
    if not lines or not all(line.startswith(_OPENINGS) for line in lines):
        return "more than a sentence"
    left = [f for f in out.rglob("*") if f.is_file()] if out.is_dir() else []
    return "left files" if left and not any("partial" in f.name for f in left) else "refused"


def _is_json(file: Path) -> bool:
    """Without NaN, which JSON does not know."""
    try:
        json.loads(file.read_bytes(), parse_constant=int)
    except ValueError:
        return False
    return True


_OPENINGS = ("sms: ", "ik_tables: ", "virtual bus: ")


def _child(
    work: Callable[[], None], said: Path, patience: float = PATIENCE, stopped: float = 0.0
) -> int:
    """Exit code of a fork that does `work`; negative: the signal that ended it, SIGALRM when time was over.

    stopped: when Ctrl-C is sent, s; 0: never.
    """
    sys.stdout.flush()
    sys.stderr.flush()
    pid = os.fork()
    if pid == 0:
        os._exit(_guarded(work, said))
    end = time.monotonic() + patience
    late = False
    pause = 0.002
    while os.waitid(os.P_PID, pid, os.WEXITED | os.WNOHANG | os.WNOWAIT) is None:
        if stopped and time.monotonic() > end - patience + stopped:
            os.kill(pid, signal.SIGINT)
            stopped = 0.0
        if time.monotonic() > end:
            late = True
            break
        time.sleep(pause)
        pause = min(2.0 * pause, 0.1)
    with suppress(ProcessLookupError):
        os.killpg(pid, signal.SIGKILL)  # with what it may have started
    code = os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1])
    return -signal.SIGALRM if late else code


def _guarded(work: Callable[[], None], said: Path) -> int:
    """In the child: limits, standard streams in files, and any exception as a traceback there."""
    os.setsid()
    signal.signal(signal.SIGINT, signal.default_int_handler)
    for number, ending in enumerate((".out", ".err"), 1):
        os.dup2(os.open(f"{said}{ending}", os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600), number)
    os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
    sys.stdout = open(1, "w", encoding="utf-8", closefd=False)  # noqa: SIM115 (as long as the child lives)
    sys.stderr = open(2, "w", encoding="utf-8", errors="backslashreplace", closefd=False)  # noqa: SIM115
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    resource.setrlimit(resource.RLIMIT_CPU, (PROCESSOR_TIME, PROCESSOR_TIME + 5))
    resource.setrlimit(resource.RLIMIT_FSIZE, (LARGEST_FILE, LARGEST_FILE))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    faulthandler.enable()
    code = 0
    try:
        work()
    except SystemExit as end:
        code = end.code if isinstance(end.code, int) else 0 if end.code is None else 1
    except BaseException:  # what Python itself would print
        traceback.print_exc()
        code = TRACEBACK
    with suppress(Exception):
        sys.stdout.flush()
        sys.stderr.flush()
    return code
