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
from rich.progress import BarColumn, Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

if TYPE_CHECKING:
    import can

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
Seconds = Annotated[float | None, typer.Option(help="Stop after so many seconds.")]

VIRTUAL, DEFAULT_BITRATE = "virtual", 500_000
FAILED = 1


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


@contextmanager
def linked(interface: str, channel: str | None, bitrate: int) -> Iterator[RigLink]:
    """A link with the rig on a bus; on a virtual bus a virtual rig is started with it."""
    from sms.link.rig_link import RigLink  # noqa: PLC0415

    with open_address(interface, channel, bitrate) as bus, RigLink(bus) as link:
        if interface != VIRTUAL:
            yield link
            return
        from sms.link.bus import BusAddress, open_bus  # noqa: PLC0415
        from sms.link.real_time import running  # noqa: PLC0415
        from sms.link.virtual_rig import VirtualRig  # noqa: PLC0415

        print("virtual bus: a virtual rig runs in this process", file=sys.stderr)
        with (
            open_bus(BusAddress(interface, channel)) as other_end,
            running(VirtualRig(), other_end),
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
    columns = (
        SpinnerColumn(),
        TextColumn("{task.description}", markup=False),
        BarColumn(),
        TimeElapsedColumn(),
    )
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        yield bar
