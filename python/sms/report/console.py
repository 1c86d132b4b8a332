"""The diagnosis on the console: what a person reads in ten seconds. The page has the rest."""

from __future__ import annotations

from collections.abc import Iterable

from rich.console import Console, Group, RenderableType
from rich.padding import Padding
from rich.panel import Panel
from rich.table import Table
from rich.text import Text

from sms.diagnosis.remainder import Remainder, Unexplained
from sms.diagnosis.result import Cause, Diagnosis, FreeRun, Gain, ParameterValue
from sms.diagnosis.wording import INSENSITIVE, arranged
from sms.diagnosis.wording_simulated import (
    free_run_in_words,
    still_hidden_in_words,
    worst_free_runs,
)
from sms.report.verdict import VERDICT_WORDS, is_shift, parameter_text
from sms.units_display import (
    capital,
    format_aligned,
    format_interval,
    format_percent,
    format_quantity,
    words,
)

_STYLES = {"no-evidence": "green", "unknown": "yellow", "data-fault": "red"}
_LIST_AT_MOST = 3


def print_diagnosis(diagnosis: Diagnosis, console: Console) -> None:
    """Print verdict, causes, gain, remainder and next experiment; looks right from 80 columns."""
    parts: Iterable[RenderableType | None] = (
        _verdict(diagnosis),
        _faults(diagnosis),
        _causes(diagnosis),
        _gain(diagnosis),
        _free_run(diagnosis),
        _empirical(diagnosis),
        _notes(diagnosis),
    )
    # A name that its owner chose may look like markup.
    console.print(Group(*(part for part in parts if part is not None)), markup=False)


def _verdict(diagnosis: Diagnosis) -> Panel:
    style = _STYLES.get(diagnosis.verdict, "cyan")
    text = Text(diagnosis.sentence)
    title = Text(f" {VERDICT_WORDS[diagnosis.verdict]} ", style=f"bold {style}")
    subtitle = Text(f" {diagnosis.title or diagnosis.rig} ", style="dim")
    return Panel(
        text,
        title=title,
        title_align="left",
        subtitle=subtitle,
        subtitle_align="right",
        border_style=style,
        padding=(0, 1),
    )


def _table(title: str) -> Table:
    return Table(
        title=title,
        title_justify="left",
        title_style="bold",
        box=None,
        padding=(0, 2, 0, 0),
        header_style="dim",
        pad_edge=False,
    )


def _block(table: Table) -> Padding:
    return Padding(table, (1, 0, 0, 1))


def _causes(diagnosis: Diagnosis) -> Padding | None:
    if not diagnosis.causes:
        return None
    table = _table("Causes")
    table.add_column("", no_wrap=True)
    table.add_column("cause")
    table.add_column("estimate", no_wrap=True)
    for number, cause in enumerate(diagnosis.causes, start=1):
        for row, (title, parameters) in enumerate(_explanations(cause)):
            shown = capital(title) if row == 0 else f"or {words(title)}"
            table.add_row(
                str(number) if row == 0 else "",
                Text(shown, style="bold" if row == 0 else ""),
                "\n".join(parameter_text(p, is_shift(p)) for p in parameters),
            )
        if len(cause.alternatives) > 0:
            table.add_row("", Text("not distinguishable by these signals", style="dim italic"), "")
        if cause.cross_validated:
            table.add_row("", Text(INSENSITIVE, style="dim italic"), "")
    return _block(table)


def _explanations(cause: Cause) -> list[tuple[str, tuple[ParameterValue, ...]]]:
    others = [m for m in cause.alternatives if (m.effect, m.signal) != (cause.effect, cause.signal)]
    return [(cause.title, cause.parameters), *((m.title, m.parameters) for m in others)]


def _gain(diagnosis: Diagnosis) -> Padding | None:
    if not diagnosis.gain:
        return None
    table = _table("RMS error on the validation records")
    table.add_column("record")
    table.add_column("baseline", justify="right", no_wrap=True)
    table.add_column("extended", justify="right", no_wrap=True, style="bold")
    table.add_column("noise floor", justify="right", no_wrap=True)
    table.add_column("change (95 %)", justify="right", no_wrap=True)
    for g in diagnosis.gain:
        texts = format_aligned([g.baseline_rms, g.extended_rms, g.noise_floor], g.unit)
        within = format_interval(-g.reduction_high, -g.reduction_low, signed=True)
        change = f"{format_percent(-g.reduction, signed=True)} ({within})"
        if not diagnosis.causes:
            texts[1] = change = "-"
        table.add_row(_record_of(g, diagnosis), *texts, change)
    return _block(table)


def _free_run(diagnosis: Diagnosis) -> Padding | None:
    """Of each signal the record that is furthest off."""
    if not diagnosis.free_run:
        return None
    table = _table("RMS error of a free run over the whole record, the worst of each signal")
    table.add_column("record")
    table.add_column("baseline", justify="right")
    table.add_column("extended", justify="right", style="bold")
    for run in worst_free_runs(diagnosis.free_run):
        before, after = free_run_in_words(run)
        table.add_row(_record_of(run, diagnosis), before, after if diagnosis.causes else "-")
    return _block(table)


def _record_of(g: Gain | FreeRun, diagnosis: Diagnosis) -> str:
    several = len({x.signal for x in diagnosis.gain}) > 1
    tested = " (test)" if g.role == "test" else ""
    return f"{g.record}{tested}, {words(g.signal)}" if several else f"{g.record}{tested}"


def _empirical(diagnosis: Diagnosis) -> Padding | None:
    """What the curve of an unknown is worth, where it was asked for."""
    if diagnosis.empirical is None:
        return None
    shape = diagnosis.empirical.shape
    table = _table(
        f"Not explained: {words(shape.equation)} as a function of {words(shape.signal.split(' [')[0])}"
    )
    table.add_column("record")
    table.add_column("baseline", justify="right", no_wrap=True)
    table.add_column("with the curve", justify="right", no_wrap=True, style="bold")
    table.add_column("change (95 %)", justify="right", no_wrap=True)
    for g in diagnosis.empirical.gain:
        within = format_interval(-g.reduction_high, -g.reduction_low, signed=True)
        texts = format_aligned([g.baseline_rms, g.extended_rms], g.unit)
        change = f"{format_percent(-g.reduction, signed=True)} ({within})"
        table.add_row(_record_of(g, diagnosis), *texts, change)
    return _block(table)


def _faults(diagnosis: Diagnosis) -> Padding | None:
    """The errors of the data check, or how many warnings there were."""
    errors = [f for f in diagnosis.findings if f.severity == "error"]
    if not errors:
        return None
    table = _table("Faults in the data")
    table.add_column("where")
    table.add_column("what, and what to do")
    for f in errors[:_LIST_AT_MOST]:
        line = f", line {f.line}" if f.line is not None else ""
        table.add_row(f"{f.file}{line}", f"{f.message}; {f.remedy}")
    if len(errors) > _LIST_AT_MOST:
        table.add_row("", f"and {len(errors) - _LIST_AT_MOST} more, see the report")
    return _block(table)


def _notes(diagnosis: Diagnosis) -> Padding | None:
    """What is left, what cannot be said, what to measure next: a line each."""
    table = _table("")
    table.title, table.show_header = None, False
    table.add_column("", style="bold", no_wrap=True)
    table.add_column("")
    if diagnosis.command:
        table.add_row("Command", diagnosis.command)
    if diagnosis.remainder is not None:
        left = diagnosis.remainder
        table.add_row("Residual", left.sentence if isinstance(left, Unexplained) else _left(left))
    if diagnosis.still_hidden:
        table.add_row("Not excluded", still_hidden_in_words(diagnosis.still_hidden))
    if diagnosis.not_testable:
        tried = {c.effect for c in diagnosis.candidates}
        blind = [n.effect for n in diagnosis.not_testable if n.effect not in tried]
        names = ", ".join(dict.fromkeys(words(effect) for effect in blind))
        table.add_row("Not testable", names or "errors of some sensors, see report")
    if (plan := diagnosis.next_experiment) is not None:
        table.add_row("Next experiment", f"{capital(plan.title)}: {plan.purpose}")
    warnings = sum(f.severity == "warning" for f in diagnosis.findings)
    if warnings:
        table.add_row("Data check", f"{warnings} warning{'s' if warnings > 1 else ''}, see report")
    return _block(table) if table.row_count else None


def _left(left: Remainder) -> str:
    size = f"{format_quantity(left.rms, left.unit)} RMS on the validation records"
    where = arranged(left)
    return f"{size}: {where}" if where else size
