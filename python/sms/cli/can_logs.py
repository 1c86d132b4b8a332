"""The commands `sms can record`, `replay` and `table`: a bus into a log, and out of it."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from sms.cli.can_bus import (
    DEFAULT_BITRATE,
    VIRTUAL,
    Bitrate,
    Channel,
    Interface,
    Seconds,
    linked,
    open_address,
    progress_bar,
)
from sms.cli.columns import Dbc
from sms.errors import InputError


def register(can_app: typer.Typer) -> None:
    """Add the commands."""
    can_app.command(
        epilog="Example: **sms can record run.mf4 --seconds 60 --interface udp_multicast**. A rig file names the log "
        'as a record, *file = "run.mf4"*, its signals as columns: *extension_1*, *Setpoint.extension_setpoint_1*.'
    )(record)
    can_app.command(
        epilog="Example: **sms can replay run.blf --interface udp_multicast --speed 2**, and **sms can monitor** "
        "shows it. Commands are left out by default; a rig would refuse old ones anyway, for their challenge is over."
    )(replay)
    can_app.command(
        epilog="Example: **sms can table run.blf --out run.csv**, then open it in any program that reads tables."
    )(table)


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

    The log appears when it is finished, whole; Ctrl-C finishes it. Nothing is sent, so no key is needed.
    """
    from sms.io.can_files import LogWriter  # noqa: PLC0415

    with (
        linked(interface, channel, bitrate) as link,
        LogWriter(log) as writer,
        progress_bar() as bar,
    ):
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


def replay(
    log: Annotated[Path, typer.Argument(help="The log: .blf, .asc, .mf4, .csv, .log, .trc, .db.")],
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
    """Send the frames of a log onto a bus again, in their time.

    Commands are left out unless asked for. A rig with a key refuses them: what authenticates a command holds once.
    """
    from sms.link.replay import replay as send  # noqa: PLC0415

    with open_address(interface, channel, bitrate) as bus, progress_bar() as bar:
        task = bar.add_task("replaying", total=None)
        sent = send(
            log,
            bus,
            speed=speed,
            commands=commands,
            progress=lambda frames: bar.update(task, description=f"replaying: {frames} frames"),
        )
    print(f"sent: {sent.frames} frames, {sent.duration:.1f} s of traffic in {sent.elapsed:.1f} s")


def table(
    log: Annotated[Path, typer.Argument(help="The log: .blf, .asc, .mf4, .csv, .log, .trc, .db.")],
    out: Annotated[
        Path, typer.Option(help="The table to write: .csv, .csv.gz, .parquet or .mat.")
    ] = Path("run.csv"),
    dbc: Dbc = None,
) -> None:
    """Turn a log of the rig's bus, or of another one, into a table on one time base.

    One column a signal, named "extension_1 [m]".

    Other commands need no table: a rig file names the log itself as a record.
    """
    from sms.io.table_files import is_can_log, open_table  # noqa: PLC0415
    from sms.io.write import write_table  # noqa: PLC0415

    if not is_can_log(log):
        raise InputError(f"{log}: there is no such CAN log; check the path")
    found = open_table(log, dbc=dbc)
    for remark in found.remarks:
        print(
            f"sms: {log}, frame {remark.line}: {remark.message}; {remark.remedy}", file=sys.stderr
        )
    write_table(out, {name: found.numbers(i)[0] for i, name in enumerate(found.names)})
    print(f"written: {out} ({len(found.lines)} rows, {len(found.names)} columns)")
