"""The verdict on a simulated rig in plain words."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import inf, isnan

from sms.diagnosis.adequacy.hysteresis import Hysteresis
from sms.diagnosis.adequacy.lack_of_fit import LackOfFit
from sms.diagnosis.adequacy.parameter_constancy import Inconstancy
from sms.diagnosis.adequacy.record_consistency import Inconsistency
from sms.diagnosis.effects.catalogue import Effect
from sms.diagnosis.localisation.signal_functions import alike
from sms.diagnosis.remainder import FedEquations, Hidden, Unexplained
from sms.diagnosis.result import Cause, Finding, FreeRun, Gain, StillHidden, Verdict
from sms.diagnosis.wording import capital, chosen_again, explained, judged_by_cross_validation
from sms.parameters import Parameter
from sms.units_display import format_aligned, format_percent, format_quantity
from sms.units_display import words as spaced


def sentence(verdict: Verdict, causes: Sequence[Cause], hidden: Hidden) -> str:
    """What a person reads first."""
    if verdict == "no-evidence":
        return (
            "No evidence of a model error: what the simulation leaves is within what the declared uncertainties make "
            "tolerable."
        )
    if verdict == "unknown":
        return (
            "The simulation is wrong, and no effect of the catalogue explains the error. "
            f"It arises in {block_in_words(hidden.equation)}; {shape_in_words(hidden)}."
        )
    if len(causes) == 1:
        return f"Model error found: {explained(causes[0])}."
    listed = "; and ".join(f"({i}) {explained(c)}" for i, c in enumerate(causes, 1))
    return f"Model errors found: {listed}."


def sentence_of_inconsistency(found: Inconsistency) -> str:
    return (
        "The records are inconsistent: each can be explained by itself, but no single model explains all of them. "
        f"The best candidate ({found.effect.title}) would need a different value in each."
    )


def words_of_inconsistency(found: Inconsistency, rig: str) -> Finding:
    """The finding, with the value that each record asks for."""
    name = found.effect.parameters[0]
    values = format_aligned([v for v, _ in found.values.values()], found.unit)
    each = ", ".join(f"{v} in '{r}'" for r, v in zip(found.values, values, strict=True))
    return Finding(
        "error",
        rig,
        None,
        found.effect.signal if found.effect.of_sensor else None,
        f"the records are inconsistent: for '{found.effect.title}', {name} is estimated as {each}",
        "find out what was changed between the runs and state it as their conditions, or leave out the one at odds",
    )


def remainder_in_words(left: Unexplained, units: Mapping[str, str]) -> str:
    """What is left beside the causes: of the signal that is worst off, against noise and tolerance, and where."""
    beyond = {s: max(left.rms[s] ** 2 - left.floor[s] ** 2, 0.0) ** 0.5 for s in left.rms}
    worst = max(beyond, key=lambda s: beyond[s] / max(left.tolerated[s], 1e-300))
    size, noise, least = format_aligned(
        [left.rms[worst], left.floor[worst], left.tolerated[worst]], units[worst]
    )
    said = (
        f"The residual on the validation records is largest in {spaced(worst)}: {size} RMS at a noise of {noise}, "
        f"{format_percent(left.share_of_excess)} of the initial error beyond the noise"
    )
    if not left.practically_significant:
        return f"{said}; that is within what the declared uncertainties make tolerable ({least})."
    where = f"{said}. It sits in {block_in_words(left.equation)}"
    if (
        left.curve is not None and left.curve.equation != left.equation
    ):  # its signal says nothing of that equation
        return f"{where}."
    return f"{where}, along {spaced(left.along.split(' [')[0])}."


def still_hidden_in_words(effects: Sequence[StillHidden]) -> str:
    """What could still be there: the effects that these records show least well, by what is plausible of them."""
    least = sorted(effects, key=lambda e: -e.size / max(e.plausible, 1e-300))
    nothing = [e.title for e in least if e.size >= e.plausible][:3]
    limited = [e for e in least if e.size < e.plausible][:3]
    listed = [f"{title}, whatever its size" for title in nothing] + [
        f"{e.title}, below {format_quantity(e.size, e.unit, e.parameter)}" for e in limited
    ]
    return (
        f"These records do not exclude: {'; '.join(listed)}. The limits of all effects are in diagnosis.json "
        "(still_hidden)."
    )


def worst_free_runs(runs: Sequence[FreeRun]) -> list[FreeRun]:
    """Of each signal the run that is furthest off; one that diverges first of all."""
    signals = dict.fromkeys(run.signal for run in runs)
    return [max((r for r in runs if r.signal == s), key=_how_far_off) for s in signals]


def _how_far_off(run: FreeRun) -> float:
    return inf if isnan(run.baseline_rms) else run.baseline_rms


def free_run_in_words(run: FreeRun) -> tuple[str, str]:
    """Baseline and extended: "12.3 mm (leaves the stroke at 3.20 s)"."""
    sizes = [run.baseline_rms, run.extended_rms]
    known = [size for size in sizes if not isnan(size)]
    texts = iter(format_aligned(known, run.unit) if known else [])
    said = ["" if isnan(size) else next(texts) for size in sizes]
    notes = (run.baseline_note, run.extended_note)
    before, after = (
        f"{text} ({note})" if text and note else text or note
        for text, note in zip(said, notes, strict=True)
    )
    return before, after


def block_in_words(equation: str) -> str:
    """ "force" -> "the balance of forces on the piston"."""
    if equation == "force":
        return "the balance of forces on the piston"
    if equation == "command":
        return "the controller, whose command differs from the recorded one"
    if equation.startswith("flow"):
        return f"the {equation.replace('flow', 'air flow')} (valve, tubes, leaks and heat transfer act alike there)"
    return f"the {equation.replace('_', ' ')}"


def shape_in_words(hidden: Hidden) -> str:
    """As a function of which signal the missing term explains most; it may sit in another equation than all functions
    together.
    """
    shape = hidden.shape
    signal = spaced(shape.signal.split(" [")[0])
    share = f"{format_percent(min(shape.share, 1.0))} of the error beyond the noise"
    if shape.equation == hidden.equation:
        return f"as a function of {signal} it explains {share}"
    return (
        f"of all functions of one signal, one in the {spaced(shape.equation)} over {signal} explains most, {share}, so "
        "that the error may arise there as well"
    )


def nearest_in_words(
    nearest: Effect,
    law: Inconstancy | Hysteresis | None,
    before: LackOfFit,
    after: LackOfFit,
    table: Mapping[str, Parameter],
) -> str:
    """The best candidate for an unknown, and why it was rejected."""
    if law is None:
        takes = 1.0 - max(after.total, 0.0) / max(before.total, 1e-12)
        return (
            f"Best candidate, rejected: {nearest.title}, which explains {format_percent(takes)} of the error beyond "
            "the noise: not enough to be its cause."
        )
    name = law.effect.parameters[0]
    if isinstance(law, Hysteresis):
        alone, beside = format_aligned([law.alone, law.beside[0]], table[name].unit, name)
        return (
            f"Best candidate, rejected: {law.effect.title}. Its estimate is {alone} alone and {beside} together with a "
            f"play of {format_quantity(law.play[0], 'V')} between command and spool: the valve has hysteresis."
        )
    signal, unit = (
        law.signal.removesuffix("]").split(" [") if "[" in law.signal else (law.signal, "1")
    )
    low, high = format_aligned([law.low[0], law.high[0]], table[name].unit, name)
    return (
        f"Best candidate, rejected: {law.effect.title}. Its estimate is {low} where {spaced(signal)} is below "
        f"{format_quantity(law.cut, unit)} and {high} above: the parameter is not constant."
    )


def conclusion(
    verdict: Verdict,
    causes: Sequence[Cause],
    gain: Sequence[Gain],
    hidden: Hidden,
    fed: FedEquations | None,
    left: Hidden | None,
    before: LackOfFit,
    after: LackOfFit,
    nearest: str = "",
) -> tuple[str, ...]:
    """What an engineer would conclude, a sentence each; `nearest` is the best candidate for an unknown."""
    out = []
    if verdict in ("cause", "class", "combination"):
        out += [judged_by_cross_validation(c) for c in causes if c.cross_validated]
        out += [] if all(c.cross_validated for c in causes) else [_worth(gain)]
        shares = format_percent(max(0.0, 1.0 - max(after.total, 0.0) / max(before.total, 1e-12)))
        out.append(f"The extended model explains {shares} of the error beyond the noise.")
        out.append(chosen_again(causes, "windows"))
    elif verdict == "unknown":
        others = sorted(hidden.shares.items(), key=lambda item: -item[1][0])[:3]
        listed = ", ".join(f"{name.replace('_', ' ')} {format_percent(s[0])}" for name, s in others)
        out.append(
            f"Share of the error beyond the noise that an unknown input in one equation explains alone: {listed}."
        )
        out += [nearest] if nearest else []
    if verdict != "no-evidence" and fed is not None:
        out.append(two_ways(hidden, fed))
    if causes:
        inside = block_of(causes[0].block)
        if not any(word in hidden.equation for word in inside):
            out.append(
                f"{capital(causes[0].title)}: acts in another equation than the unknown input that explains most "
                f"({hidden.equation.replace('_', ' ')}); examine both."
            )
    return tuple(out)


def agree(hidden: Hidden, fed: FedEquations) -> bool:
    """Whether the second way has the first one's equation too: as its largest, or as one that may be.

    What a hidden input has in all legs alike ("force") is what the second way has in each of them.
    """
    share = {e.equation: e.share for e in fed.equations}
    for name, numbers in alike(list(share)).items():
        of_legs = [fed.equations[n].share for n in numbers]
        share[name] = (
            sum(s[0] for s in of_legs),
            sum(s[1] for s in of_legs),
            sum(s[2] for s in of_legs),
        )
    own = share.get(hidden.equation)
    return own is not None and own[2] >= share[fed.equation][1]


def two_ways(hidden: Hidden, fed: FedEquations) -> str:
    """What the equations say when each is fed with measured signals, and whether the hidden inputs say the same."""
    if not fed.beyond_noise:
        return (
            "Fed with measured signals, no single equation has an error beyond noise and the tolerance between "
            "equivalent models; only the simulation, which accumulates errors, has."
        )
    most = next(e for e in fed.equations if e.equation == fed.equation)
    size, noise = format_aligned([most.rms, most.noise], most.unit)
    found = (
        f"Fed with measured signals, each equation by itself, {spaced(most.equation)} has an error of {size} at a "
        f"noise of {noise}, {format_percent(most.share[0])} of all error beyond the noise"
    )
    if hidden.equation == "command":
        return f"{found}. The controller, to which unknown inputs in the simulation point, is none of these equations."
    if agree(hidden, fed):
        same = hidden.equation == fed.equation
        where = "there too" if same else f"to {spaced(hidden.equation)}, which is as likely here"
        return f"{found}; unknown inputs in the simulation point {where}: the two methods agree."
    readings = [e for e in (fed.equation, hidden.equation) if e.startswith("reading of ")]
    suspect = (
        f"that of {spaced(readings[0].removeprefix('reading of '))} first"
        if readings
        else "or a delay between two of them"
    )
    return (
        f"{found}; unknown inputs in the simulation point to {spaced(hidden.equation)}. The two methods point to "
        f"different equations: a sensor reading is suspect, {suspect}."
    )


def block_of(block: str) -> tuple[str, ...]:
    """Which equations of the simulation a block of the catalogue can be seen in."""
    known = {
        "force": ("force",),
        "valve": ("flow",),
        "supply": ("flow", "supply"),
        "chamber": ("flow", "force"),
        "control": ("flow", "command"),
        "sensors": ("reading", "force", "flow"),
        "mechanism": ("reading", "force"),
    }
    return known.get(block, (block,))


def _worth(gain: Sequence[Gain]) -> str:
    """The signals' errors before and after, the worst record of each."""
    parts = []
    for signal in dict.fromkeys(g.signal for g in gain):
        worst = max((g for g in gain if g.signal == signal), key=lambda g: g.baseline_rms)
        old, new = format_aligned([worst.baseline_rms, worst.extended_rms], worst.unit)
        parts.append(f"{spaced(signal)} {old} to {new}")
    return f"On the validation records the RMS error within a window falls: {', '.join(parts)}."
