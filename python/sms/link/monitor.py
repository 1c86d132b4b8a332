"""What a rig says, as a table in the terminal."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Mapping

from rich.console import Console, Group
from rich.live import Live
from rich.table import Table
from rich.text import Text

from sms.link.codec import CONTROLLER, Value, message, period, sent_by
from sms.link.rig_link import Reading, RigLink

REFRESH = 0.2  #: s
STALE = 5.0  #: periods
EVENTS = 8  #: the last ones shown
#: the frames that are shown as tables of their signals, in this order
SHOWN = (
    "Attitude",
    "Extension",
    "Setpoint",
    "ValveCommand",
    "ChamberPressureLower",
    "ChamberPressureUpper",
)
HIDDEN = ("sample_time", "setpoint_alive", "setpoint_session")


def show(
    link: RigLink,
    console: Console,
    seconds: float | None = None,
    is_over: Callable[[], bool] = lambda: False,
) -> None:
    """Refresh the table until Ctrl-C, for so many seconds, or until it is over; the last one stays.

    Only listens.
    """
    events: deque[Reading] = deque(maxlen=EVENTS)
    counted, since = dict(link.counts), link.clock()
    begin = since
    try:
        with Live(console=console, auto_refresh=False) as live:
            while not is_over() and (seconds is None or link.clock() - begin < seconds):
                link.wait(is_over, REFRESH if seconds is None else min(REFRESH, seconds))
                events.extend(link.take_events())
                now = link.clock()
                rates = {i: (n - counted.get(i, 0)) / (now - since) for i, n in link.counts.items()}
                counted, since = dict(link.counts), now
                live.update(picture(link, rates, list(events)), refresh=True)
    except KeyboardInterrupt:
        pass  # that is how one stops it


def picture(link: RigLink, rates: Mapping[int, float], events: list[Reading]) -> Group:
    """State, telemetry and the last events; `rates` in frames a second by identifier."""
    table = Table(box=None, header_style="dim")
    for title in ("frame", "frames/s", "signal", "", "unit"):
        table.add_column(title, justify="right" if title in ("frames/s", "") else "left")
    for name in SHOWN:
        _add_rows(table, link, name, rates)
    return Group(_state(link), table, _traffic(link, rates), *_told(events))


def _state(link: RigLink) -> Text:
    status = link.latest("Status")
    if status is None or not link.is_alive():
        return Text("no rig is heard on this bus", style="bold red")
    signals = status.signals
    faults = fault_names(int(signals["faults"]))
    limits = [
        name.removeprefix("limited_")
        for name in ("limited_range", "limited_rate", "limited_acceleration")
        if signals[name]
    ]
    words = [
        f"mode {signals['mode']}, control law {signals['control_law']}",
        f"enable switch {'closed' if signals['enabled'] else 'open'}",
        f"tick {signals['tick_load']:g} %",
    ]
    if limits:
        words.append(f"set-point limited: {', '.join(limits)}")
    text = Text(";  ".join(words), style="bold")
    if faults:
        text.append(f"\nfaults: {', '.join(faults)}", style="bold red")
    return text


def fault_names(faults: int) -> list[str]:
    """The names of the faults in `faults` of Status: bit n - 1 is fault n."""
    choices: Mapping[int, object] = (
        message("Status").get_signal_by_name("first_fault").choices or {}
    )
    return [str(choices.get(bit + 1, bit + 1)) for bit in range(24) if faults >> bit & 1]


def _add_rows(table: Table, link: RigLink, name: str, rates: Mapping[int, float]) -> None:
    described = message(name)
    reading = link.latest(name)
    if reading is None:
        return
    old = link.clock() - reading.time > STALE * (period(name) or 1.0)
    rate = f"{rates.get(described.frame_id, 0.0):.0f}"
    first = True
    for signal in described.signals:
        if signal.name not in HIDDEN and signal.name in reading.signals:
            value = _written(reading.signals[signal.name], signal.unit)
            cells = (name if first else "", rate if first else "", signal.name, *value)
            table.add_row(*cells, style="yellow" if old else None)
            first = False


def _written(value: Value, unit: str | None) -> tuple[str, str]:
    """A value as a person reads it: angles also in degrees are not; SI, but pressures in kPa."""
    if isinstance(value, str) or unit is None:
        return str(value), unit or ""
    if unit == "Pa":
        return f"{1e-3 * value:.1f}", "kPa"
    if unit == "m":
        return f"{1e3 * value:.2f}", "mm"
    if unit == "rad":
        return f"{57.29577951308232 * value:.3f}", "°"
    return f"{value:.4g}", unit


def _traffic(link: RigLink, rates: Mapping[int, float]) -> Text:
    known = sent_by(CONTROLLER)
    total = sum(rate for number, rate in rates.items() if number in known)
    statistics = link.latest("LinkStatistics")
    words = f"{total:.0f} frames/s from the rig"
    if statistics is not None:
        counts = (
            f"{name.removeprefix('frames_').replace('_', ' ')} {value}"
            for name, value in statistics.signals.items()
        )
        words += f"; commands it missed or refused: {', '.join(counts)}"
    if total > 0.0:
        words += "; commands: " + (
            "authenticated, the rig has a key"
            if link.has_key()
            else "open to whoever is on this bus"
        )
    return Text(words, style="dim")


def _told(events: list[Reading]) -> list[Text]:
    return [
        Text(
            f"{event.signals['event_time']:9.3f} s  {event.signals['event']} ({event.signals['event_detail']}), "
            f"{event.signals['event_mode_before']} -> {event.signals['event_mode']}"
        )
        for event in events
    ]
