"""The firmware's application on an emulated Cortex-M4F, and the processor in the loop.

    ./dev firmware        (after the kinematics, validation/firmware/__main__.py)

Built for the target, for a 32-bit and for this host. Gates: how the library says it was built, instructions of a tick
and of the codec, flash, RAM, stack, called symbols, the same faults at the same times with 32 bits, the C side under
cppcheck with chars of 16 bits, and the lockstep test: extensions as on this host to 1e-5 m, commands and decisions to
the bit.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table

ROOT = Path(__file__).resolve().parents[2]
OUT = ROOT / "build" / "firmware"
FIRMWARE = ROOT / "libsms" / "firmware"
EMULATION = FIRMWARE / "emulation"
MACHINE = "qemu-system-arm -M mps2-an386 -nographic -monitor none -serial none -icount shift=0"
SEMIHOSTING = ("-semihosting-config", "enable=on,target=native", "-kernel")
BUILD_INFO = r"libsms \S+ float c\+\+201402L no-exceptions no-rtti"
MOST_CODEC, MOST_TICK = 300, 12_000
MOST_FLASH, MOST_RAM, MOST_STACK = 48 * 1024, 6 * 1024, 2 * 1024
LARGEST_DIFFERENCE = 1e-5
"""m, between the extensions of the two runs."""


def run(*command: str, cwd: Path | None = None, timeout: float = 3600.0) -> str:
    """Standard output of a command; raises CalledProcessError, which main() shows."""
    return subprocess.run(
        command, capture_output=True, text=True, check=True, timeout=timeout, cwd=cwd
    ).stdout


def build() -> None:
    """Target and hosts; after build.sh, whose objects are linked too."""
    run("sh", str(EMULATION / "build_application.sh"), str(OUT))
    run("sh", str(EMULATION / "build_host.sh"), str(OUT), "64")


# ---- functions ----


def count_functions(console: Console) -> list[str]:
    """Instructions of each function on the target; what misses a goal."""
    text = run(*MACHINE.split(), *SEMIHOSTING, str(OUT / "count_application.elf"))
    info, *rows = text.splitlines()
    console.print(f"\non the target: {info}")
    failures = [] if re.fullmatch(BUILD_INFO, info) else [f"built as '{info}', not {BUILD_INFO}"]
    table = Table(title="instructions of one call, application, emulated Cortex-M4F, 8000 calls")
    for column in ("function", "least", "mean", "most", "goal"):
        table.add_column(column, justify="left" if column == "function" else "right")
    for row in rows:
        name, least, mean, most = row.split(";")
        codec = "pack" in name
        table.add_row(name, least, mean, most, f"<= {MOST_CODEC}" if codec else "")
        if codec and int(most) > MOST_CODEC:
            failures.append(f"{name} takes {most} instructions, the goal is {MOST_CODEC}")
    console.print(table)
    return failures


# ---- the image ----


def image_size() -> tuple[int, int]:
    """Bytes of flash and of RAM without stack, main loop and startup included."""
    text, data, bss = (
        int(n)
        for n in run("arm-none-eabi-size", str(OUT / "image.elf")).splitlines()[1].split()[:3]
    )
    return text + data, data + bss


def frames_of_the_stack() -> list[tuple[int, str, str]]:
    """Every function's frame as the compiler states it: bytes, kind, file and line."""
    rows = []
    for source in OUT.glob("*.app.arm.su"):
        for line in source.read_text(encoding="utf-8").splitlines():
            name, size, kind = line.rsplit("\t", 2)
            rows.append((int(size), kind, ":".join(Path(name).name.split(":")[:2])))
    return rows


def called_symbols() -> set[str]:
    """What the application's archive calls and neither it nor the core's holds."""
    archive = str(OUT / "libsms_firmware.arm.a")
    called = set(re.findall(r" U (\S+)", run("arm-none-eabi-nm", "-u", archive)))
    held = set(re.findall(r" [TDRBWVu] (\S+)", run("arm-none-eabi-nm", archive)))
    return called - held


def check_image(console: Console, allowed: set[str]) -> list[str]:
    """Size, stack frames and symbols."""
    flash, ram = image_size()
    size = run("arm-none-eabi-size", "image.elf", cwd=OUT)
    console.print(f"\narm-none-eabi-size image.elf\n{size.rstrip()}", highlight=False)
    console.print(f"flash of the whole image: {flash} bytes (goal <= {MOST_FLASH})")
    console.print(f"RAM without stack: {ram} bytes (goal <= {MOST_RAM})")
    largest = max(frames_of_the_stack())
    console.print(f"largest stack frame: {largest[0]} bytes, at {largest[2]}")
    strangers = called_symbols() - allowed
    console.print(f"nm -u, of the application's archive: {' '.join(sorted(called_symbols()))}")
    failures = [
        f"{name}: its frame is {kind}"
        for _, kind, name in frames_of_the_stack()
        if kind != "static"
    ]
    if flash > MOST_FLASH:
        failures.append(f"the image takes {flash} bytes of flash, the goal is {MOST_FLASH}")
    if ram > MOST_RAM:
        failures.append(f"the image takes {ram} bytes of RAM, the goal is {MOST_RAM}")
    if strangers:
        failures.append(f"called but not allowed: {' '.join(sorted(strangers))}")
    return failures


# ---- other machines ----


def check_c_side(console: Console) -> list[str]:
    """The headers and examples in C, read by cppcheck with chars and ints of 16 bits."""
    if shutil.which("cppcheck") is None:
        console.print("cppcheck is not installed: the C side was not read with chars of 16 bits")
        return []
    sources = [
        *sorted((ROOT / "libsms" / "examples").glob("*.c")),
        FIRMWARE / "tests" / "c_board.c",
    ]
    found = subprocess.run(
        [
            "cppcheck",
            "--quiet",
            f"--platform={EMULATION / 'c28x.xml'}",
            "--error-exitcode=1",
            "--enable=warning,portability,performance",
            f"-I{ROOT / 'libsms' / 'include'}",
            f"-I{FIRMWARE}",
            *map(str, sources),
        ],
        capture_output=True,
        text=True,
        check=False,
    )
    console.print(f"C side, chars and ints of 16 bits (cppcheck): {len(sources)} files read")
    return [f"cppcheck: {found.stderr.strip()}"] if found.returncode else []


def compiles_for_32_bits() -> bool:
    """Whether g++ here can make programs of 32 bits, and this machine run them."""
    with tempfile.TemporaryDirectory() as folder:
        source = Path(folder) / "nothing.cpp"
        source.write_text("#include <cmath>\nint main() {}\n", encoding="utf-8")
        program = str(Path(folder) / "nothing")
        made = subprocess.run(
            ["g++", "-m32", str(source), "-o", program], capture_output=True, check=False
        )
        return made.returncode == 0 and subprocess.run([program], check=False).returncode == 0


def check_32_bits(console: Console) -> list[str]:
    """The table of faults by a program of 32 bits and by one of 64."""
    if not compiles_for_32_bits():
        console.print("no 32-bit host: g++-multilib is not installed; not tried")
        return []
    run("sh", str(EMULATION / "build_host.sh"), str(OUT), "32")
    tables = [run(str(OUT / f"fault_table.{bits}")) for bits in ("32", "64")]
    same = tables[0] == tables[1]
    rows = len(tables[0].splitlines())
    console.print(
        f"32-bit host: {rows} faults, {'the same' if same else 'other'} times and reactions"
    )
    return [] if same else ["the 32-bit host's table of faults is another"]


# ---- the processor in the loop ----


@dataclass(frozen=True)
class Lockstep:
    """One run: a row a period."""

    extension: np.ndarray
    """(n, 3), m"""
    pulse_width: np.ndarray
    """(n, 3), counts"""
    decisions: np.ndarray
    """(n, 3): mode, phase, faults"""
    sent: np.ndarray
    """(n,): a hash over all frames of that tick"""
    instructions: np.ndarray
    """(n,)"""
    stack: int
    """bytes, the deepest"""


def read_lockstep(path: Path) -> Lockstep:
    """A file of the program lockstep."""
    rows = [line.split(",") for line in path.read_text(encoding="utf-8").splitlines()]
    numbers = np.array([[float(v) for v in row[:10]] for row in rows])
    return Lockstep(
        numbers[:, 1:4],
        numbers[:, 4:7],
        numbers[:, 7:10],
        np.array([row[10] for row in rows]),
        np.array([int(row[12]) for row in rows]),
        max(int(row[13]) for row in rows),
    )


def run_lockstep() -> tuple[Lockstep, Lockstep]:
    """The same test on this host and with the application on the emulated target."""
    run(str(OUT / "lockstep.host"), "here", "here.csv", cwd=OUT)
    for pipe in (OUT / "to_target", OUT / "from_target"):
        pipe.unlink(missing_ok=True)
        os.mkfifo(pipe)
    target = subprocess.Popen(
        [*MACHINE.split(), *SEMIHOSTING, "lockstep.elf"], cwd=OUT, stdin=subprocess.DEVNULL
    )
    try:
        run(str(OUT / "lockstep.host"), "target", "target.csv", cwd=OUT)
        target.wait(timeout=30)
    finally:
        target.kill()
    return read_lockstep(OUT / "here.csv"), read_lockstep(OUT / "target.csv")


def compare_lockstep(console: Console, here: Lockstep, target: Lockstep) -> list[str]:
    """The report of the equivalence test; what is not equivalent."""
    apart = float(np.abs(here.extension - target.extension).max())
    commands = int((here.pulse_width != target.pulse_width).any(axis=1).sum())
    decisions = int((here.decisions != target.decisions).any(axis=1).sum())
    frames = int((here.sent != target.sent).sum())
    n = target.instructions
    ticks = len(n)
    table = Table(title="processor in the loop: 67.5 s, levelling, tracking, 60 s of heave chirp")
    for column in ("output", "this host against the emulated target", "goal"):
        table.add_column(column)
    table.add_row("extensions", f"at most {apart:.2g} m apart", f"<= {LARGEST_DIFFERENCE:g} m")
    table.add_row("valve commands", f"{commands} of {ticks} ticks differ", "0")
    table.add_row("mode, phase, faults", f"{decisions} of {ticks} ticks differ", "0")
    table.add_row(
        "frames sent",
        f"{frames} of {ticks} ticks differ",
        "few: the last bit of a sine in telemetry",
    )
    table.add_row(
        "instructions of a tick",
        f"{n.min()} least, {n.mean():.0f} mean, {n.max()} most",
        f"<= {MOST_TICK}",
    )
    table.add_row("stack", f"{target.stack} bytes", f"<= {MOST_STACK}")
    console.print(table)
    failures = []
    if apart > LARGEST_DIFFERENCE:
        failures.append(f"processor in the loop: extensions are {apart:.2g} m apart")
    if commands or decisions:
        failures.append(
            f"processor in the loop: {commands} commands and {decisions} decisions differ"
        )
    if frames > ticks // 1000:
        failures.append(f"processor in the loop: the frames of {frames} ticks differ")
    if n.max() > MOST_TICK:
        failures.append(f"a tick takes {n.max()} instructions, the goal is {MOST_TICK}")
    if target.stack > MOST_STACK:
        failures.append(f"the stack takes {target.stack} bytes, the goal is {MOST_STACK}")
    return failures


def check(console: Console, allowed: set[str]) -> list[str]:
    """Everything above; what failed."""
    build()
    failures = count_functions(console)
    failures += check_image(console, allowed)
    failures += check_c_side(console)
    failures += check_32_bits(console)
    return failures + compare_lockstep(console, *run_lockstep())
