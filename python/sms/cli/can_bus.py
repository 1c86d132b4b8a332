"""What the commands `sms can ...` share: the options of a bus, and a bus or a link that is open for one command."""

from __future__ import annotations

import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.console import Console

if TYPE_CHECKING:
    import can
    from rich.progress import Progress

    from sms.link.rig_link import RigLink

Interface = Annotated[
    str,
    typer.Option(
        envvar="CAN_INTERFACE",
        help="The bus by python-can's name: *virtual* (inside this command, with a virtual rig), *udp_multicast* "
        "(between the commands on this computer), *socketcan*, *slcan*, *pcan*, ...",
    ),
]
Channel = Annotated[
    str | None,
    typer.Option(
        envvar="CAN_CHANNEL",
        help="Which bus of that kind: *can0*, */dev/ttyACM0*, *PCAN_USBBUS1*, *239.74.163.2:43114* (group and port). "
        "Default: the usual one.",
    ),
]
Bitrate = Annotated[
    int, typer.Option(envvar="CAN_BITRATE", help="Of a real bus, bit/s; the rig's is 500000.")
]
KeyFile = Annotated[
    Path | None,
    typer.Option(
        envvar="CAN_KEY_FILE",
        help="The rig's key, a file of 32 hexadecimal digits: commands are authenticated with it. Without: the bus is "
        "open.",
    ),
]
Seconds = Annotated[float | None, typer.Option(help="Stop after so many seconds.")]

VIRTUAL, DEFAULT_BITRATE = "virtual", 500_000
FAILED = 1
OPEN_BUS = "this bus is open: whoever is on it can command the rig; a key closes it (--key-file)"


@contextmanager
def open_address(interface: str, channel: str | None, bitrate: int) -> Iterator[can.BusABC]:
    """An open bus; what goes wrong on it is one sentence and exit code 1."""
    from sms.link.bus import BusAddress, open_bus  # noqa: PLC0415
    from sms.link.rig_link import LinkError  # noqa: PLC0415

    with open_bus(BusAddress(interface, channel, bitrate)) as bus, ended_like_ctrl_c():
        try:
            yield bus
        except LinkError as problem:
            print(f"sms: {problem}", file=sys.stderr)
            raise typer.Exit(FAILED) from None


@contextmanager
def ended_like_ctrl_c() -> Iterator[None]:
    """A command that is ended (`kill`) finishes as after Ctrl-C: a log is closed, a platform levelled."""

    def interrupt(_signal: int, _frame: object) -> None:
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGTERM, interrupt)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)


def key_of(file: Path | None) -> bytes | None:
    """The key in a file; says on the error output when others may read it."""
    from sms.link.key_file import read_key, readable_by_others  # noqa: PLC0415

    if file is None:
        return None
    key = read_key(file)
    if (warning := readable_by_others(file)) is not None:
        print(f"sms: {warning}", file=sys.stderr)
    return key


def say_open() -> None:
    print(f"sms: {OPEN_BUS}", file=sys.stderr)


def take_control(link: RigLink, interface: str) -> None:
    """Connect; without a key, say that everybody could. A virtual bus ends at this process: nobody else is on it."""
    link.connect()
    if link.sender.key is None and interface != VIRTUAL:
        say_open()


@contextmanager
def linked(
    interface: str, channel: str | None, bitrate: int, key_file: Path | None = None
) -> Iterator[RigLink]:
    """A link with the rig on a bus; on a virtual bus a virtual rig is started with it, and has the same key."""
    from sms.link.rig_link import RigLink  # noqa: PLC0415

    key = key_of(key_file)
    with open_address(interface, channel, bitrate) as bus, RigLink(bus, key=key) as link:
        if interface != VIRTUAL:
            yield link
            return
        from sms.link.bus import BusAddress, open_bus  # noqa: PLC0415
        from sms.link.real_time import running  # noqa: PLC0415
        from sms.link.virtual_rig import VirtualRig  # noqa: PLC0415

        print("virtual bus: a virtual rig runs in this process", file=sys.stderr)
        with (
            open_bus(BusAddress(interface, channel)) as other_end,
            running(VirtualRig(key=key), other_end),
        ):
            yield link


@contextmanager
def recording(link: RigLink, log: Path | None) -> Iterator[None]:
    from sms.io.can_files import LogWriter  # noqa: PLC0415

    if log is None:
        yield
        return
    with LogWriter(log) as writer:
        link.listener = writer.write
        yield
    print(f"written: {log} ({writer.frames} frames, {writer.duration:.1f} s)")


@contextmanager
def progress_bar() -> Iterator[Progress]:
    from rich.progress import (  # noqa: PLC0415 (--help must not wait for it)
        BarColumn,
        Progress,
        SpinnerColumn,
        TextColumn,
        TimeElapsedColumn,
    )

    columns = (
        SpinnerColumn(),
        TextColumn("{task.description}", markup=False),
        BarColumn(),
        TimeElapsedColumn(),
    )
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        yield bar
