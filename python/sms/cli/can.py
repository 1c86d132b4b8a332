"""The commands `sms can ...`: a rig on a CAN bus, real or virtual."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from sms.cli import can_logs
from sms.cli.can_bus import (
    DEFAULT_BITRATE,
    VIRTUAL,
    Bitrate,
    Channel,
    Interface,
    KeyFile,
    Seconds,
    key_of,
    linked,
    open_address,
    progress_bar,
    recording,
    say_open,
    take_control,
)
from sms.cli.columns import Columns, columns_of
from sms.errors import InputError

can_app = typer.Typer(
    help="A rig on a CAN bus: watch it, drive it, record it, set its parameters; and a virtual rig to try all on.",
    no_args_is_help=True,
    rich_markup_mode="markdown",
    epilog="Without hardware: **sms can rig --interface udp_multicast** in one terminal, "
    "**sms can monitor --interface udp_multicast** in another. docs/can_tutorial.md goes on from there.",
)


def register(app: typer.Typer) -> None:
    """Add the commands."""
    can_logs.register(can_app)
    app.add_typer(can_app, name="can")


@can_app.command(
    epilog="Example: **sms can monitor --interface socketcan --channel can0**. It only listens: nothing is sent."
)
def monitor(
    interface: Interface = VIRTUAL,
    channel: Channel = None,
    bitrate: Bitrate = DEFAULT_BITRATE,
    seconds: Seconds = None,
    log: Annotated[
        Path | None, typer.Option(help="Show what is in this log instead of a bus.")
    ] = None,
    speed: Annotated[float, typer.Option(help="Of the log, times real time.")] = 1.0,
) -> None:
    """Show what the rig says, as a live table: values with units, how often each frame comes, faults, events.

    A value in yellow is older than five of its periods. Stop with Ctrl-C.
    """
    from sms.link.monitor import show  # noqa: PLC0415 (python-can takes its time; --help must not)

    if log is not None:
        from sms.link.replay import LogBus  # noqa: PLC0415
        from sms.link.rig_link import RigLink  # noqa: PLC0415

        with LogBus(log, speed=speed) as bus, RigLink(bus) as link:
            show(link, Console(), seconds, lambda: bus.is_over)
        return
    with linked(interface, channel, bitrate) as link:
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
    key_file: KeyFile = None,
    scale: Annotated[float, typer.Option(help="Excursions from level, times this.")] = 1.0,
    rate: Annotated[
        float | None,
        typer.Option(help="Set-points a second; default that of the bus definition, 100."),
    ] = None,
    law: Annotated[
        str, typer.Option(help="Control law: *proportional*, *pid*, *state_feedback*, *unchanged*.")
    ] = "unchanged",
    record: Annotated[Path | None, typer.Option(help="Also record the bus into this log.")] = None,
    column: Columns = [],  # noqa: B006 (typer copies it)
) -> None:
    """Drive the platform along a deck motion, and say how even the stream of set-points was.

    The motion is held against the workspace before anything moves. The platform is levelled, led to the motion's
    begin, driven, led back to level, and stays level. Ctrl-C levels it at once.
    """
    from sms.link.drive import drive as stream  # noqa: PLC0415
    from sms.link.motion import check_motion, read_motion  # noqa: PLC0415

    wanted = read_motion(motion, columns=columns_of(column)).scaled(scale)
    check_motion(wanted)
    with (
        linked(interface, channel, bitrate, key_file) as link,
        recording(link, record),
        progress_bar() as bar,
    ):
        task = bar.add_task("connecting", total=1.0)
        take_control(link, interface)
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
    epilog="Example: **sms can get position_gain payload_mass**. Without a name: everything the rig knows."
)
def get(
    names: Annotated[
        list[str] | None, typer.Argument(help="Parameters; none: all of them.")
    ] = None,
    interface: Interface = VIRTUAL,
    channel: Channel = None,
    bitrate: Bitrate = DEFAULT_BITRATE,
    key_file: KeyFile = None,
    changed: Annotated[
        bool, typer.Option("--changed", help="Only those that are not at their default.")
    ] = False,
) -> None:
    """Print parameters as the rig has them, in SI units."""
    from sms.link.parameters import (  # noqa: PLC0415
        is_default,
        known_parameter,
        known_parameters,
        read_parameter,
    )

    wanted = [known_parameter(name) for name in names or known_parameters()]
    with linked(interface, channel, bitrate, key_file) as link:
        take_control(link, interface)
        for parameter in wanted:
            value = read_parameter(link, parameter.name)
            if not changed or not is_default(parameter.name, value):
                print(f"{parameter.name} = {value:.7g} {parameter.unit}")


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
    key_file: KeyFile = None,
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
    with linked(interface, channel, bitrate, key_file) as link:
        take_control(link, interface)
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
    key_file: KeyFile = None,
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
    machine = VirtualRig(effects=effect or [], faults=fault or [], seed=seed, key=key_of(key_file))
    if key_file is None:
        say_open()
    with open_address(interface, channel, bitrate) as bus:
        console = Console(stderr=True, quiet=quiet)
        with (
            console.status("the rig is running; Ctrl-C stops it") as status,
            suppress(KeyboardInterrupt),
        ):
            run(machine, bus, seconds, status.update)
    print(machine.summary())
