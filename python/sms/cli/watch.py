"""The command `sms watch`."""

from __future__ import annotations

import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.console import Console

from sms.cli.can_bus import DEFAULT_BITRATE, Bitrate, Channel, ended_like_ctrl_c
from sms.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Iterable

    from sms.io.rig import Rig
    from sms.watch.alarm_frame import AlarmFrame
    from sms.watch.feed import Chunk
    from sms.watch.watch import Status, Watch


CANNOT_GO_ON = 1
"""Exit code of a watch that began."""


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command(
        epilog="Examples: **sms watch rig.toml --play day.csv** watches a complete record, as fast as it can; "
        "**sms watch rig.toml --follow log.csv --page 127.0.0.1:8765** a file while the logger writes it, with a live "
        "page; **sms watch rig.toml --interface socketcan --channel can0** a bus, on which it only listens. "
        "docs/watch.md leads through all of it."
    )(watch)


def watch(
    rig: Annotated[
        Path,
        typer.Argument(help="The rig file (TOML): what is known of the machine, and its signals."),
    ],
    play: Annotated[
        list[Path], typer.Option(help="Watch this record; may be repeated, one after the other.")
    ] = [],  # noqa: B006 (typer copies it)
    speed: Annotated[
        float, typer.Option(help="Of a played record, times real time; 0: as fast as possible.")
    ] = 0.0,
    follow: Annotated[
        Path | None, typer.Option(help="Watch this file (a table in text) while it grows.")
    ] = None,
    interface: Annotated[
        str | None,
        typer.Option(
            envvar="CAN_INTERFACE",
            help="Watch a bus, by python-can's name of it: *socketcan*, *udp_multicast*, *pcan*, ...",
        ),
    ] = None,
    channel: Channel = None,
    bitrate: Bitrate = DEFAULT_BITRATE,
    learn: Annotated[
        float,
        typer.Option(
            help="Seconds of the healthy machine that it learns from: the records of the rig file with role "
            "*reference*, and as much as they lack from the beginning of the stream."
        ),
    ] = 600.0,
    false_alarms_per_day: Annotated[
        float,
        typer.Option(
            help="At most so many alarms a day of a machine that has not changed; sets every threshold."
        ),
    ] = 0.5,
    diagnose_after: Annotated[
        float,
        typer.Option(
            help="Seconds of rows since the onset, after which an alarm is diagnosed in full, in a process of its own; "
            "0: never."
        ),
    ] = 60.0,
    on_alarm: Annotated[
        str | None,
        typer.Option(
            metavar="COMMAND",
            help="Start this for each alarm and each verdict, without a shell; the event is its last argument, as "
            "JSON.",
        ),
    ] = None,
    alarm_frame: Annotated[
        str | None,
        typer.Option(
            metavar="IDENTIFIER",
            help="Send each alarm, its verdict and its end as a CAN frame with this identifier, *0x1F0* say, on the "
            "bus of **--interface**. What is in it: *sms/watch/alarm.dbc*.",
        ),
    ] = None,
    out: Annotated[
        Path, typer.Option(help="Folder for events.jsonl, the rows, and a folder an alarm.")
    ] = Path("watch"),
    keep: Annotated[
        float, typer.Option(help="Hours of rows that are kept as records in the folder; 0: none.")
    ] = 24.0,
    page: Annotated[
        str | None,
        typer.Option(
            metavar="ADDRESS:PORT",
            help="Show a live page there: *127.0.0.1:8765*. Who can open the port can read it.",
        ),
    ] = None,
    seconds: Annotated[float | None, typer.Option(help="Stop after so many seconds.")] = None,
    quiet: Annotated[
        bool, typer.Option("--quiet", help="No live view, only what happens.")
    ] = False,
) -> None:
    """Watch a machine: say within seconds that something has changed, since when and what fits, then diagnose it.

    The model of the rig file runs beside the machine. First it learns what the healthy machine leaves (**--learn**), so
    that a machine which the model fits only roughly raises no alarm. Then every five seconds each effect of the
    catalogue, each signal and each equation is asked whether it has changed, and since when (a generalised likelihood
    ratio; the threshold follows from **--false-alarms-per-day**). An alarm names the effects that fit with a first
    guess of their size; after **--diagnose-after** seconds a full diagnosis runs on the recorded rows.

    Gaps, restarts of the clock, silence and bus faults are states, and no alarms. What happened stands in
    *events.jsonl*, one JSON object a line. A watch that began and cannot go on, since the stream ended before the
    healthy machine was learned or cannot be read, keeps what came in until then; its exit code is 1.
    """
    from sms.rigs.threads import one_thread_for_matrices, threads  # noqa: PLC0415

    with ExitStack() as stack:
        beside, loaded = _prepared(
            rig, out, keep, on_alarm, (learn, false_alarms_per_day, diagnose_after)
        )
        stack.callback(beside.close)
        if alarm_frame is not None:
            beside.listeners = [
                *beside.listeners,
                _frames(stack, loaded, alarm_frame, interface, channel, bitrate),
            ]
        console = Console(markup=False)
        if page is not None:
            from sms.watch.page import Page  # noqa: PLC0415 (an optional extra)

            shown = Page.at(page, loaded.title, out)
            stack.enter_context(shown)
            beside.show = shown.show
            others = "; others on the network can read it" if shown.is_open_to_others else ""
            console.print(f"live page: {shown.address}{others}", style="dim")
        chunks, backlog, stop = _stream(
            stack, loaded, play, speed, follow, interface, channel, bitrate
        )
        if seconds is not None:
            timer = threading.Timer(seconds, stop)
            timer.daemon = True
            timer.start()
            stack.callback(timer.cancel)
        threads()  # what is wrong with it is said before the watch begins
        stack.enter_context(one_thread_for_matrices())
        try:
            with ended_like_ctrl_c(), _live(console, beside, quiet):
                beside.run(chunks, backlog)
                beside.finish()
        except KeyboardInterrupt:
            stop()
        except InputError as problem:
            print(f"sms: {' '.join(str(problem).split())}", file=sys.stderr)
            raise typer.Exit(CANNOT_GO_ON) from None
        _summary(console, beside)


def _prepared(
    rig: Path, out: Path, keep: float, on_alarm: str | None, numbers: tuple[float, float, float]
) -> tuple[Watch, Rig]:
    """The watch, after everything that may be refused."""
    from sms.io.rig import load_rig  # noqa: PLC0415 (scipy takes a second; --help must not)
    from sms.io.write import check_output_folder  # noqa: PLC0415
    from sms.rigs.kinds import KINDS  # noqa: PLC0415
    from sms.watch.log import EventLog, OnAlarm  # noqa: PLC0415
    from sms.watch.recorder import Recorder  # noqa: PLC0415
    from sms.watch.watch import Options, Watch  # noqa: PLC0415

    learn, rate, after = numbers
    options = Options(learn, rate, after if after != 0.0 else None)
    options.check()
    loaded = load_rig(rig)
    if loaded.kind not in KINDS:
        raise InputError(
            f"{rig}: a {loaded.kind} is not simulated beside its machine; sms watch is for {', '.join(KINDS)}"
        )
    check_output_folder(out)
    listeners = [] if on_alarm is None else [OnAlarm(on_alarm)]
    recorder = None if keep == 0.0 else Recorder(out / "rows", keep)
    log = EventLog(out / "events.jsonl")
    return Watch(loaded, options, out, log, recorder, listeners), loaded


def _frames(
    stack: ExitStack,
    rig: Rig,
    identifier: str,
    interface: str | None,
    channel: str | None,
    bitrate: int,
) -> AlarmFrame:
    """What sends alarms on the bus."""
    from sms.io.can_frames import load_dbc  # noqa: PLC0415
    from sms.link.bus import BusAddress  # noqa: PLC0415 (python-can takes its time)
    from sms.watch.alarm_frame import AlarmFrame  # noqa: PLC0415

    if interface is None:
        raise InputError("--alarm-frame: on which bus? Give --interface, and --channel")
    try:
        number = int(identifier, 0)
    except ValueError:
        raise InputError(
            f"--alarm-frame '{identifier}' is no identifier; write it as 0x1F0 or 496"
        ) from None
    frame = AlarmFrame(BusAddress(interface, channel, bitrate), number, load_dbc(rig.layout.dbc))
    stack.callback(frame.close)
    return frame


def _stream(
    stack: ExitStack,
    rig: Rig,
    play: list[Path],
    speed: float,
    follow: Path | None,
    interface: str | None,
    channel: str | None,
    bitrate: int,
) -> tuple[Iterable[Chunk], Callable[[], tuple[int, int]], Callable[[], None]]:
    """Chunks, what waits and was lost, and what stops them."""
    from sms.watch.feed import Chunk, Feed  # noqa: PLC0415
    from sms.watch.source import follow as follow_file  # noqa: PLC0415
    from sms.watch.source import play as play_files  # noqa: PLC0415

    given = [bool(play), follow is not None, interface is not None and not play and follow is None]
    if sum(given) != 1:
        raise InputError(
            "nothing is watched: give --play RECORD, --follow FILE or --interface NAME"
            if not any(given)
            else "--play and --follow: a watch has one stream; give one of them"
        )
    stopped = threading.Event()
    if play:
        chunks = play_files(rig, play, speed)
        return _until(chunks, stopped), lambda: (0, 0), stopped.set
    feed = Feed()
    if follow is not None:
        follow_file(rig, follow, feed, stopped)
    else:
        from sms.watch.can_source import listen  # noqa: PLC0415 (python-can takes its time)

        assert interface is not None
        listen(rig, interface, channel, bitrate, feed, stopped)
    stack.callback(stopped.set)

    def stop() -> None:
        stopped.set()
        feed.put(Chunk(condition="ended"))

    return feed.chunks(), lambda: (feed.waiting, feed.lost), stop


def _until(chunks: Iterator[Chunk], stopped: threading.Event) -> Iterator[Chunk]:
    for chunk in chunks:
        if stopped.is_set():
            return
        yield chunk


@contextmanager
def _live(console: Console, beside: Watch, quiet: bool) -> Iterator[None]:
    """The terminal's view, beside what is shown already."""
    from sms.watch.terminal import Terminal  # noqa: PLC0415

    with Terminal(console, live=not quiet and console.is_terminal) as terminal:
        before = beside.show

        def show(status: Status) -> None:
            before(status)
            terminal.show(status)

        beside.show, beside.progress = show, terminal.progress
        yield


def _summary(console: Console, beside: Watch) -> None:
    from sms.watch.segments import SEGMENT  # noqa: PLC0415
    from sms.watch.terminal import hours  # noqa: PLC0415

    watched = hours(beside.segments * SEGMENT)
    count = len(beside.alarms)
    console.print(
        f"watched {watched}: {count or 'no'} alarm{'s' if count != 1 else ''}", style="bold"
    )
    console.print(f"written: {beside.log.path}", style="dim", soft_wrap=True)
