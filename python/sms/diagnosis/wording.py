"""The verdict in words: what an engineer would say, from the numbers of this diagnosis and nothing else."""

from __future__ import annotations

from collections.abc import Sequence

from sms.diagnosis.remainder import Remainder
from sms.diagnosis.result import (
    Cause,
    Finding,
    Gain,
    NextExperiment,
    NotTestable,
    ParameterValue,
    Related,
    Verdict,
)
from sms.io.rig import Rig
from sms.io.signals import without_leg
from sms.units_display import format_change, format_estimate, format_percent, format_quantity
from sms.units_display import words as spaced


def of_command(rig: Rig) -> str:
    """Where the valve's command comes from."""
    control = rig.control
    if control.loop == "open":
        return "Open loop: the valve's command is taken from the records."
    if control.controller == "recorded":
        return "Closed loop, its controller not simulated: the valve's command is taken from the records."
    law = {"pid": "PID", "state_feedback": "state feedback"}[control.law]
    held = (
        "; the recorded command is compared with what it computes from the recorded extension"
        if any(without_leg(s) == "valve_command" for s in rig.signals)
        else ""
    )
    whose = "the controller of each leg" if rig.kind == "platform" else "its controller"
    taken = [r.name for r in rig.records if r.control.controller == "recorded"]
    others = (
        f" In {', '.join(taken)} the valve's command is taken from the record." if taken else ""
    )
    return (
        f"Closed loop, {whose} ({law}) simulated: it computes the valve's command from the recorded set-point and "
        f"the simulated extension{held}.{others}"
    )


def capital(text: str) -> str:
    return text[:1].upper() + text[1:]


def amount(cause: Cause) -> str:
    """How much: "0.75 ± 0.01 N per bar", or old -> new for a shifted parameter; of other parameters also which."""
    shifted = cause.kind == "shifted parameter"
    return _listed(cause.parameters, [_amount(p, shifted) for p in cause.parameters])


def _listed(parameters: Sequence[ParameterValue], sizes: Sequence[str]) -> str:
    """An effect is known by its first parameter; the others are named."""
    names = ["", *(f"{spaced(p.name.partition(':')[0])} " for p in parameters[1:])]
    return ", ".join(name + size for name, size in zip(names, sizes, strict=False))


def _amount(p: ParameterValue, shifted: bool) -> str:
    if shifted:
        return format_change(p.old_value, p.value, p.standard_error, p.unit, p.name)
    return format_estimate(
        p.value, p.standard_error, p.unit, p.name, signed=p.unit == "1" and p.old_value == 0.0
    )


def explained(cause: Cause) -> str:
    """A cause with its size; for a class every explanation with its own."""
    if not cause.alternatives:
        return f"{cause.title} ({amount(cause)})"
    rivals = [f"{cause.title} ({amount(cause)})"]
    for rival in cause.alternatives:
        sizes = [_amount(p, p.old_value != 0.0) for p in rival.parameters]
        rivals.append(f"{rival.title} ({_listed(rival.parameters, sizes)})")
    return f"one of {'; '.join(rivals)} (these signals cannot distinguish between them)"


def sentence(verdict: Verdict, causes: Sequence[Cause], remainder: Remainder | None) -> str:
    if verdict == "no-evidence":
        return (
            "No evidence of a model error: within the declared uncertainties the model explains these records down to "
            "what does not repeat from stroke to stroke."
        )
    if verdict == "unknown":
        where = f" ({arranged(remainder)})" if remainder is not None else ""
        return (
            "The simulation is wrong, and no effect of the catalogue explains the error, which is systematic"
            f"{where}."
        )
    if len(causes) == 1:
        return f"Model error found: {explained(causes[0])}."
    return (
        "Model errors found: "
        + "; and ".join(f"({i}) {explained(c)}" for i, c in enumerate(causes, 1))
        + "."
    )


def data_fault(faults: Sequence[Finding]) -> str:
    first = faults[0]
    parts = (f"line {first.line}" if first.line else None, first.signal)
    where = ", ".join([first.file, *(part for part in parts if part is not None)])
    return (
        f"The data are not usable, so nothing is concluded from them. {where}: {first.message}; "
        f"{first.remedy}."
    )


ARRANGED = {
    "record": "a constant in each record, that is at each pressure",
    "direction": "of opposite sign in the two directions",
    "extension": "along the stroke, the same in every stroke",
    "time": "as a drift from stroke to stroke",
}


def arranged(remainder: Remainder) -> str:
    """ "0.8 N along the stroke, the same in every stroke; 0.5 N ..." - the parts that repeat, the largest first."""
    shares = sorted(
        ((s, name) for name, s in remainder.shares.items() if name in ARRANGED), reverse=True
    )
    return "; ".join(
        f"{remainder.rms * share**0.5:.2f} {remainder.unit} {ARRANGED[name]}"
        for share, name in shares
        if share > 0.05
    )


REPEAT = "repeat"
"""What differs on a rig that is the same kind once more: its scatter is what any other difference is held against."""


# ---- what an engineer would conclude ---------------------------------------------------------------------------


def conclusion(
    causes: Sequence[Cause],
    gain: Sequence[Gain],
    remainder: Remainder,
    blind: Sequence[NotTestable],
    related: Sequence[Related],
) -> tuple[str, ...]:
    out = [_across_rigs(c, related) for c in causes if len(related) > 1]
    if causes:
        worth = ", ".join(
            f"{g.record}: {g.baseline_rms:.2f} to {g.extended_rms:.2f} {g.unit}" for g in gain
        )
        out.append(
            f"On the validation records the RMS error of the extended model falls ({worth})."
        )
        out.append(chosen_again(causes, "strokes"))
    out.append(_of_remainder(remainder))
    hidden = [
        n
        for n in blind
        if n.effect in ("viscous_friction", "stribeck_friction", "exponential_friction")
    ]
    if hidden:
        out.append(
            f"Nothing is claimed about {', '.join(spaced(n.effect) for n in hidden)}: {hidden[0].reason}."
        )
    return tuple(out)


INSENSITIVE = (
    "the validation records are insensitive to it; "
    "it was judged by cross-validation within the identification records"
)


def judged_by_cross_validation(cause: Cause) -> str:
    """What to say of a cause that the validation records cannot judge."""
    return f"{capital(cause.title)}: {INSENSITIVE}; a validation record that is sensitive to it would settle it."


def chosen_again(causes: Sequence[Cause], unit: str) -> str:
    """How often the same is selected in bootstrap resamples of what was judged by, `unit` by unit."""
    if len(causes) == 1:
        what = "Selected" if len(causes[0].members) == 1 else "One of this ambiguity group selected"
        listed = f"{what} in {format_percent(causes[0].support)}"
    else:
        each = ", ".join(f"({i}) in {format_percent(c.support)}" for i, c in enumerate(causes, 1))
        listed = f"Selected {each}"
    return f"{listed} of bootstrap resamples of the {unit}."


def _across_rigs(cause: Cause, related: Sequence[Related]) -> str:
    """What the relatives say of a cause: does it stay with the bench, or go with what was changed?"""
    name = cause.parameters[0].name
    found = [(r, p) for r in related for p in r.parameters if p.name == name]
    own = found[0][1]
    others = ", ".join(
        f"{_amount(p, cause.kind == 'shifted parameter')} ({r.title})" for r, p in found[1:]
    )
    text = (
        f"{capital(cause.title)}: {_amount(own, cause.kind == 'shifted parameter')} here, {others}."
    )
    repeats = [p.value for r, p in found if r.differs == REPEAT]
    if not repeats:
        return text
    spread = max([own.value, *repeats]) - min([own.value, *repeats])
    text += f" Repeats scatter by {format_quantity(spread, own.unit, name)}."
    for differs in dict.fromkeys(r.differs for r, _ in found if r.differs not in ("", REPEAT)):
        values = [p.value for r, p in found if r.differs == differs]
        if all(abs(v - own.value) <= spread for v in values):
            text += (
                f" With another {differs} it agrees within that scatter: it belongs to the rig, not to the "
                f"{differs}."
            )
        else:
            text += (
                f" With another {differs} it differs by more than that: it goes with the {differs}."
            )
    return text


def _of_remainder(remainder: Remainder) -> str:
    text = f"The residual on the validation records is {remainder.rms:.2f} {remainder.unit} RMS"
    if arranged(remainder):
        text += (
            f"; part of it is systematic, so the model is still incomplete: {arranged(remainder)}"
        )
        if (ripple := remainder.ripple) is not None:
            text += (
                f". Along the stroke it has a period of {format_quantity(ripple.period, 'm')}, amplitude "
                f"{ripple.amplitude:.2f} {remainder.unit}: look for a screw, thread or gear of that pitch"
            )
    else:
        text += ", and it does not repeat from stroke to stroke: no better model would reduce it"
    return text + "."


def next_experiment(
    verdict: Verdict, causes: Sequence[Cause], remainder: Remainder
) -> NextExperiment | None:
    """The measurement that would tell most: the first class apart, else the unknown closer."""
    for cause in causes:
        if cause.alternatives:
            apart = tuple(dict.fromkeys([cause.effect, *(a.effect for a in cause.alternatives)]))
            return NextExperiment("Distinguish between the explanations", cause.separated_by, apart)
    if verdict == "unknown":
        return NextExperiment(
            "Slow strokes over the whole travel, both ways, at two pressures and two speeds",
            f"shows whether the unexplained force goes with position, pressure or speed ({arranged(remainder)})",
            (),
        )
    return None
