"""The command `sms` as a test runs it: a process of its own that begins where this one has already imported everything.

A fork costs milliseconds where a new interpreter costs two seconds for the same imports; what the command prints, its
exit code and what it leaves behind are the same. One test starts the command as a user does (test_cli_diagnose.py).
"""

from __future__ import annotations

import importlib
import os
import subprocess
import sys
import tempfile
import traceback
import warnings
from pathlib import Path

from sms.cli.command import main

ENDED_BY_ERROR = 1
for _module in (
    "comparison.files",
    "diagnosis",
    "identification.friction",
    "scenario.command",
    "sweep.run",
):
    importlib.import_module(f"sms.{_module}")  # here, so that no child has to


def sms(*arguments: str, cwd: Path) -> subprocess.CompletedProcess[str]:
    """`sms ARGUMENTS` in a folder, 100 columns wide, without a terminal."""
    with tempfile.TemporaryFile("w+") as out, tempfile.TemporaryFile("w+") as err:
        sys.stdout.flush()
        sys.stderr.flush()
        child = os.fork()
        if child == 0:
            _command(arguments, cwd, out.fileno(), err.fileno())
        _, status = os.waitpid(child, 0)
        out.seek(0)
        err.seek(0)
        code = os.waitstatus_to_exitcode(status)
        return subprocess.CompletedProcess(["sms", *arguments], code, out.read(), err.read())


def sms_started(*arguments: str, cwd: Path) -> subprocess.CompletedProcess[str]:
    """The same in a new interpreter, as a user starts it; and where the command starts processes of its own, which a
    fork of a process that has some already cannot."""
    return subprocess.run(
        [sys.executable, "-m", "sms.cli", *arguments],
        cwd=cwd,
        capture_output=True,
        text=True,
        check=False,
        env=os.environ | {"COLUMNS": "100"},
    )


def _command(arguments: tuple[str, ...], cwd: Path, out: int, err: int) -> None:
    """The child: it never returns into the test."""
    code = ENDED_BY_ERROR
    try:
        os.dup2(out, 1)
        os.dup2(err, 2)
        os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
        sys.stdout = open(1, "w", encoding="utf-8", closefd=False)  # noqa: SIM115
        sys.stderr = open(2, "w", encoding="utf-8", closefd=False)  # noqa: SIM115
        sys.stdin = open(0, encoding="utf-8", closefd=False)  # noqa: SIM115
        os.chdir(cwd)
        os.environ["COLUMNS"] = "100"
        sys.argv = ["sms", *arguments]
        warnings.resetwarnings()
        warnings.simplefilter("ignore")
        try:
            main()
            code = 0
        except SystemExit as end:
            code = end.code if isinstance(end.code, int) else int(end.code is not None)
        except BaseException:
            traceback.print_exc()
        sys.stdout.flush()
        sys.stderr.flush()
    finally:
        os._exit(code)
