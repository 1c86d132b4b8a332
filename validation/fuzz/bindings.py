"""The compiled module itself, called with arguments that are right and then spoilt: a value, or a refusal in words.

A case is a seed and a number. The number says which function it is, so that all are called equally often; everything
else is drawn. A child runs one case after another and says which before it begins, so that a child that dies, or takes
too long, leaves the number of the case that did it.
"""

from __future__ import annotations

import faulthandler
import functools
import importlib.util
import json
import os
import re
import resource
import select
import signal
import sys
import tempfile
import warnings
from collections import Counter, defaultdict
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from types import ModuleType

import numpy as np

from validation.fuzz.calls import RETURNED, Case, judge
from validation.fuzz.signatures import Function, functions_of

MEMORY = 4 * 2**30  #: bytes of address space, where no sanitizer needs all of it
PATIENCE, SANITIZED_PATIENCE = 20, 90  #: s of the processor's time that one case may take
OUT_OF_MEMORY = ("out-of-memory", "allocation-size-too-big", "rss limit exhausted")
"""Of a sanitizer, whose operator new ends the process where another would raise."""


@dataclass(frozen=True)
class Outcome:
    """How one case ended."""

    number: int
    function: str
    verdict: str  #: RETURNED, the name of an exception that is a refusal, or what went wrong
    failed: bool
    call: str
    said: str


@dataclass
class Tally:
    """What the table at the end counts, for one function."""

    verdicts: Counter[str] = field(default_factory=Counter)
    failures: int = 0


def load_core(path: Path | None) -> ModuleType:
    """The module that the package loads, or that of a file, e.g. one with sanitizers, without the package."""
    if path is None:
        from sms import _core  # noqa: PLC0415

        return _core
    spec = importlib.util.spec_from_file_location("sms._core", path)
    if spec is None or spec.loader is None:
        raise ImportError(f"{path} is no extension module of this Python")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def sanitized(core: ModuleType) -> bool:
    """Whether AddressSanitizer watches."""
    return "sanitizer" in core.build_info


def run(core: ModuleType, seed: int, numbers: range, only: str = "") -> Iterator[Outcome]:
    """The outcomes of cases, one by one. only: part of a function's name."""
    functions = functions_of(core)
    wanted = [n for n in numbers if only in functions[n % len(functions)].label]
    while wanted:
        last = None
        for last in _of_child(core, functions, seed, wanted):
            yield last
        if last is None:
            raise RuntimeError("no case could be run")
        wanted = wanted[wanted.index(last.number) + 1 :]


def _of_child(
    core: ModuleType, functions: list[Function], seed: int, wanted: list[int]
) -> Iterator[Outcome]:
    """Outcomes until all are done, or the child died of one, which is the last then."""
    patience = SANITIZED_PATIENCE if sanitized(core) else PATIENCE
    number, call, pending, ended = wanted[0], "nothing yet", b"", False
    with tempfile.TemporaryFile("w+", errors="replace") as errors:
        read, write = os.pipe()
        sys.stdout.flush()
        pid = os.fork()
        if pid == 0:
            os.close(read)
            os.dup2(errors.fileno(), 2)
            _child(core, functions, seed, wanted, write, patience)
        os.close(write)
        try:
            while select.select([read], [], [], 6.0 * patience)[0] and not ended:
                told = os.read(read, 2**16)
                *lines, pending = (pending + told).split(b"\n")
                for number, call, *how in map(json.loads, lines):
                    if how:
                        label = functions[number % len(functions)].label
                        yield Outcome(number, label, how[0], how[1], call, how[2])
                ended = not told
        finally:
            os.close(read)
            if not ended:
                os.kill(pid, signal.SIGKILL)
            code = os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1])
        if code != 0:
            errors.seek(0)
            verdict, failed, said = _death(code, errors.read())
            yield Outcome(
                number, functions[number % len(functions)].label, verdict, failed, call, said
            )


def _death(code: int, said: str) -> tuple[str, bool, str]:
    """What a child died of: a verdict, whether it is a failure, and what was said of it."""
    report = re.search(r"==ERROR|runtime error|Assertion|Fatal Python error", said)
    said = said[max(0, report.start() - 200) if report else -4000 :][:4000]
    if any(words in said for words in OUT_OF_MEMORY):
        return "MemoryError", False, said
    if code in (-signal.SIGPROF, -signal.SIGKILL):
        return "hang", True, said
    return f"crash ({signal.Signals(-code).name if code < 0 else code})", True, said


def _child(
    core: ModuleType,
    functions: list[Function],
    seed: int,
    wanted: list[int],
    write: int,
    patience: int,
) -> None:
    """Runs the cases, tells what it begins and how that ended, and ends the process."""
    begun = ""

    def tell(number: int, call: str, *how: object) -> None:
        nonlocal begun
        begun = call
        os.write(write, (json.dumps((number, call, *how)) + "\n").encode())

    code = 1
    try:
        if not sanitized(core):
            resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        faulthandler.enable()
        faulthandler.register(signal.SIGPROF, chain=True)
        warnings.simplefilter("ignore")
        np.seterr(all="ignore")
        for number in wanted:
            signal.setitimer(signal.ITIMER_PROF, patience)
            function = functions[number % len(functions)]
            tell(number, function.label)
            try:
                case = Case(core, functions, seed, number)
                verdict = case.run(functools.partial(tell, number))
                tell(number, begun, verdict, False, "")
            except BaseException as wrong:
                name, failed = judge(wrong)
                tell(number, begun, name, failed and function.answers, str(wrong)[:2000])
        code = 0
    finally:
        os._exit(code)


# ---- what it came to ----------------------------------------------------------------------------------------------


class Tallies:
    """The table at the end."""

    def __init__(self, functions: list[Function]) -> None:
        self.of: dict[str, Tally] = defaultdict(Tally)
        self.functions = functions
        self.cases = self.failures = 0

    def count(self, one: Outcome) -> None:
        """Takes an outcome in."""
        tally = self.of[one.function]
        self.cases += 1
        self.failures += one.failed
        tally.failures += one.failed
        tally.verdicts[one.verdict] += not one.failed

    def never_answered(self) -> list[str]:
        """Functions that only ever refused, which are not tested then."""
        answers = {f.label for f in self.functions if f.answers}
        return [n for n, tally in self.of.items() if n in answers and not tally.verdicts[RETURNED]]

    def line(self) -> str:
        """All of it in one line."""
        total = sum((tally.verdicts for tally in self.of.values()), Counter[str]())
        refused = ", ".join(f"{n} {name}" for name, n in total.most_common() if name != RETURNED)
        return f"{self.cases} calls: {total[RETURNED]} returned; refused: {refused or 'none'}; {self.failures} failed"

    def table(self) -> str:
        """A line a function."""
        lines = [f"{'function':42}{'cases':>7}{'returned':>9}{'refused':>8}{'failed':>7}  refusals"]
        for name, tally in self.of.items():
            refusals = {k: n for k, n in tally.verdicts.most_common() if k != RETURNED and n}
            returned, refused = tally.verdicts[RETURNED], sum(refusals.values())
            lines.append(
                f"{name:42}{returned + refused + tally.failures:7}{returned:9}{refused:8}{tally.failures:7}  "
                + ", ".join(f"{k} {n}" for k, n in refusals.items())
            )
        return "\n".join(lines)
