"""The commands `sms can ...`: a rig on a CAN bus, real or virtual."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.console import Console
from rich.progress import BarColumn, Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

from sms.io.errors import InputError

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
        help="Which bus of that kind: *can0*, */dev/ttyACM0*, *PCAN_USBBUS1*, *239.74.163.2*. Default: the usual one.",
    ),
]
Bitrate = Annotated[
    int, typer.Option(envvar="CAN_BITRATE", help="Of a real bus, bit/s; the rig's is 500000.")
]
Seconds = Annotated[float | None, typer.Option(help="Stop after so many seconds.")]

VIRTUAL, DEFAULT_BITRATE = "virtual", 500_000
FAILED = 1

can_app = typer.Typer(
    help="A rig on a CAN bus: watch it, drive it, record it, set its parameters; and a virtual rig to try all on.",
    no_args_is_help=True,
    rich_markup_mode="markdown",
    epilog="Without hardware: **sms can rig --interface udp_multicast** in one terminal, "
    "**sms can monitor --interface udp_multicast** in another. docs/can_tutorial.md goes on from there.",
)


def register(app: typer.Typer) -> None:
    """Add the commands."""
    app.add_typer(can_app, name="can")


@can_app.command(
    epilog="Example: **sms can monitor --interface socketcan --channel can0**. It only listens: nothing is sent."
)
def monitor(
    interface: Interface = VIRTUAL,
    channel: Channel = None,
    bitrate: Bitrate = DEFAULT_BITRATE,
    seconds: Seconds = None,
) -> None:
    """Show what the rig says, as a live table: values with units, how often each frame comes, faults, events.

    A value in yellow is older than five of its periods. Stop with Ctrl-C.
    """
    from sms.link.monitor import show  # noqa: PLC0415 (python-can takes its time; --help must not)

    with _link(interface, channel, bitrate) as link:
        show(link, Console(), seconds)


@can_app.command(
    epilog="Example: **sms can drive sea_state_4.csv --scale 0.8 --record run.blf**. The file has the columns "
    "*time [s], roll [deg], pitch [deg], heave [m]* (or *height [m]*); other units are read, too."
)
def drive(
    motion: Annotated[
        Path, typer.Argument(help="Deck motion: CSV with time and roll, pitch, heave or height.")
    ],
    interface: Interface = VIRTUAL,
    channel: Channel = None,
    bitrate: Bitrate = DEFAULT_BITRATE,
    scale: Annotated[float, typer.Option(help="Excursions from level, times this.")] = 1.0,
    rate: Annotated[
        float | None,
        typer.Option(help="Set-points a second; default that of the bus definition, 100."),
    ] = None,
    law: Annotated[
        str, typer.Option(help="Control law: *proportional*, *pid*, *state_feedback*, *unchanged*.")
    ] = "unchanged",
    record: Annotated[Path | None, typer.Option(help="Also record the bus into this log.")] = None,
) -> None:
    """Drive the platform along a deck motion, and say how even the stream of set-points was.

    The motion is held against the workspace before anything moves. The platform is levelled, led to the motion's
    begin, driven, led back to level, and stays level. Ctrl-C levels it at once.
    """
    from sms.link.drive import drive as stream  # noqa: PLC0415
    from sms.link.motion import check_motion, read_motion  # noqa: PLC0415

    wanted = read_motion(motion).scaled(scale)
    check_motion(wanted)
    with _link(interface, channel, bitrate) as link, _recording(link, record), _progress() as bar:
        task = bar.add_task("connecting", total=1.0)
        link.connect()
        try:
            streamed = stream(
                link,
                wanted,
                rate=rate,
                law=law,
                progress=lambda what, done: bar.update(task, description=what, completed=done),
            )
        except KeyboardInterrupt:
            link.request_mode("levelling")
            raise InputError("stopped by Ctrl-C; the platform is levelling") from None
    print(streamed.summary())


@can_app.command(
    epilog="Example: **sms can record run.mf4 --seconds 60 --interface udp_multicast**. A rig file names the log as a "
    'record, *file = "run.mf4"*, and its signals as columns: *extension_1*, *Setpoint.extension_setpoint_1*, ...'
)
def record(
    log: Annotated[
        Path, typer.Argument(help="The log; its ending says the format: .blf, .asc, .mf4, .csv.")
    ],
    interface: Interface = VIRTUAL,
    channel: Channel = None,
    bitrate: Bitrate = DEFAULT_BITRATE,
    seconds: Seconds = None,
) -> None:
    """Record all frames of the bus into a log, until Ctrl-C or for a given time.

    The log appears when it is finished, whole; Ctrl-C finishes it.
    """
    from sms.link.logs import LogWriter  # noqa: PLC0415

    with _link(interface, channel, bitrate) as link, LogWriter(log) as writer, _progress() as bar:
        task = bar.add_task("recording", total=seconds)
        link.listener = writer.write
        begin = link.clock()
        try:
            while seconds is None or link.clock() - begin < seconds:
                link.wait(lambda: False, min(0.25, seconds or 0.25))
                words = f"recording: {writer.frames} frames"
                bar.update(task, description=words, completed=link.clock() - begin)
        except KeyboardInterrupt:
            pass  # that is how one stops it
    print(f"written: {log} ({writer.frames} frames, {writer.duration:.1f} s)")


@can_app.command(
    epilog="Example: **sms can replay run.blf --interface udp_multicast --speed 2**, and **sms can monitor** "
    "shows it. Commands are left out by default; a rig would refuse old ones anyway, for their challenge is over."
)
def replay(
    log: Annotated[Path, typer.Argument(help="The log: .blf, .asc, .mf4, .csv, .log, .trc.")],
    interface: Interface = VIRTUAL,
    channel: Channel = None,
    bitrate: Bitrate = DEFAULT_BITRATE,
    speed: Annotated[
        float, typer.Option(help="Times real time; 0: as fast as the bus takes it.")
    ] = 1.0,
    commands: Annotated[
        bool, typer.Option("--commands", help="Also send what desks sent.")
    ] = False,
) -> None:
    """Send the frames of a log onto a bus again, in their time."""
    from sms.link.replay import replay as send  # noqa: PLC0415

    with _bus(interface, channel, bitrate) as bus, _progress() as bar:
        task = bar.add_task("replaying", total=None)
        sent = send(
            log,
            bus,
            speed=speed,
            commands=commands,
            progress=lambda frames: bar.update(task, description=f"replaying: {frames} frames"),
        )
    print(f"sent: {sent.frames} frames, {sent.duration:.1f} s of traffic in {sent.elapsed:.1f} s")


@can_app.command(
    epilog="Example: **sms can table run.blf --out run.csv**, then open it in any program that reads tables."
)
def table(
    log: Annotated[Path, typer.Argument(help="The log: .blf, .asc, .mf4, .csv, .log, .trc.")],
    out: Annotated[Path, typer.Option(help="The table to write, .csv or .csv.gz.")] = Path(
        "run.csv"
    ),
) -> None:
    """Turn a log of the rig's bus into a table: one column a signal, named "extension_1 [m]", on one time base.

    Other commands need no table: a rig file names the log itself as a record.
    """
    from sms.io.tables import read_table  # noqa: PLC0415
    from sms.io.write import write_table  # noqa: PLC0415
    from sms.link.logs import is_can_log  # noqa: PLC0415

    if not is_can_log(log):
        raise InputError(f"{log}: there is no such CAN log; check the path")
    found = read_table(log, "comma", None)
    for remark in found.remarks:
        print(
            f"sms: {log}, frame {remark.line}: {remark.message}; {remark.remedy}", file=sys.stderr
        )
    write_table(out, {name: found.numbers(i)[0] for i, name in enumerate(found.names)})
    print(f"written: {out} ({len(found.lines)} rows, {len(found.names)} columns)")


@can_app.command(
    epilog="Example: **sms can get position_gain payload_mass**. Without a name: everything the rig knows."
)
def get(
    names: Annotated[
        list[str] | None, typer.Argument(help="Parameters; none: all of them.")
    ] = None,
    interface: Interface = VIRTUAL,
    channel: Channel = None,
    bitrate: Bitrate = DEFAULT_BITRATE,
    changed: Annotated[
        bool, typer.Option("--changed", help="Only those that are not at their default.")
    ] = False,
) -> None:
    """Print parameters as the rig has them, in SI units."""
    from sms.link.parameters import is_default, known_parameters, read_parameter  # noqa: PLC0415

    known = known_parameters()
    with _link(interface, channel, bitrate) as link:
        link.connect()
        for name in names or known:
            value = read_parameter(link, name)
            if not changed or not is_default(name, value):
                print(f"{name} = {value:.7g} {known[name].unit}")


@can_app.command(
    "set",
    epilog="Example: **sms can set position_gain=20 payload_mass=260 --disable**. See docs/parameters.md.",
)
def set_(
    settings: Annotated[
        list[str],
        typer.Argument(
            metavar="NAME=VALUE...", help="In SI units, or with one: 'bore_diameter=100 mm'."
        ),
    ],
    interface: Interface = VIRTUAL,
    channel: Channel = None,
    bitrate: Bitrate = DEFAULT_BITRATE,
    disable: Annotated[
        bool,
        typer.Option(
            "--disable",
            help="First ask for the mode disabled: the valves close, the platform may sink.",
        ),
    ] = False,
) -> None:
    """Set parameters of the rig: all of them, between two ticks of its controller, or none.

    A rig changes parameters only in the modes disabled and fault, and only of a desk with the same params.def.
    """
    from sms.link.parameters import parse_setting, write_parameters  # noqa: PLC0415

    values = dict(parse_setting(setting) for setting in settings)
    with _link(interface, channel, bitrate) as link:
        link.connect()
        if disable:
            link.request_mode("disabled")
        for name, value in write_parameters(link, values).items():
            print(f"{name} = {value:.7g}")


@can_app.command(
    epilog="Example: **sms can rig --interface udp_multicast --effect valve_leakage=2e-10 --fault sensor_stuck:2@5s** "
    "leaks from the start, and its second position sensor sticks after 5 s. Effects are parameters of the plant "
    "(docs/parameters.md); the controller does not know of them."
)
def rig(
    interface: Interface = "udp_multicast",
    channel: Channel = None,
    bitrate: Bitrate = DEFAULT_BITRATE,
    effect: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME=VALUE", help="A parameter of the plant alone; may be repeated."),
    ] = None,
    fault: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME[:ARGUMENT]@TIME", help="A fault and when; may be repeated. See --faults."
        ),
    ] = None,
    faults: Annotated[
        bool, typer.Option("--faults", help="Print the faults there are, and stop.")
    ] = False,
    seed: Annotated[int, typer.Option(help="Of the sensors' noise and of faulty frames.")] = 1,
    seconds: Seconds = None,
    quiet: Annotated[bool, typer.Option("--quiet", help="No status line.")] = False,
) -> None:
    """Run a virtual rig on a bus, in real time: the controller's own program, and the simulated plant under it.

    It starts at rest, disabled, with the enable switch closed. What it computes is what the controller would.
    """
    from sms.link.real_time import run  # noqa: PLC0415
    from sms.link.virtual_rig import FAULTS, VirtualRig  # noqa: PLC0415

    if faults:
        for name, meaning in FAULTS.items():
            print(f"{name:20} {meaning}")
        return
    if interface == VIRTUAL:
        raise InputError(
            "a virtual bus ends at this process, so nobody could talk to this rig; "
            "use --interface udp_multicast, or leave sms can rig out: the other commands start one of their own"
        )
    machine = VirtualRig(effects=effect or [], faults=fault or [], seed=seed)
    with _bus(interface, channel, bitrate) as bus:
        console = Console(stderr=True, quiet=quiet)
        with (
            console.status("the rig is running; Ctrl-C stops it") as status,
            suppress(KeyboardInterrupt),
        ):
            run(machine, bus, seconds, status.update)
    print(machine.summary())


# ---- what the commands share ---------------------------------------------------------------------------------------


@contextmanager
def _bus(interface: str, channel: str | None, bitrate: int) -> Iterator[can.BusABC]:
    """An open bus; what goes wrong on it is one sentence and exit code 1."""
    from sms.link.bus import BusAddress, open_bus  # noqa: PLC0415
    from sms.link.rig_link import LinkError  # noqa: PLC0415

    with open_bus(BusAddress(interface, channel, bitrate)) as bus:
        try:
            yield bus
        except LinkError as problem:
            print(f"sms: {problem}", file=sys.stderr)
            raise typer.Exit(FAILED) from None


@contextmanager
def _link(interface: str, channel: str | None, bitrate: int) -> Iterator[RigLink]:
    """A link with the rig on a bus; on a virtual bus a virtual rig is started with it."""
    from sms.link.rig_link import RigLink  # noqa: PLC0415

    with _bus(interface, channel, bitrate) as bus, RigLink(bus) as link:
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
def _recording(link: RigLink, log: Path | None) -> Iterator[None]:
    from sms.link.logs import LogWriter  # noqa: PLC0415

    if log is None:
        yield
        return
    with LogWriter(log) as writer:
        link.listener = writer.write
        yield
    print(f"written: {log} ({writer.frames} frames, {writer.duration:.1f} s)")


@contextmanager
def _progress() -> Iterator[Progress]:
    columns = SpinnerColumn(), TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn()
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        yield bar
