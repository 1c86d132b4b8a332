"""Whether the platform can follow a deck motion, what is cut where it cannot, and why.

A motion is checked against the stroke (less a clearance at both ends, by default the cushions'
length), the steady speed that the valve's flow allows, and the force of the supply pressure. What
is too much is refused, cut where it occurs, or scaled down as a whole. SI units.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from sms._core import OutOfWorkspaceError
from sms.errors import InputError
from sms.kinematics import jacobian
from sms.motion.deck import DeckMotion
from sms.motion.limits import (
    Demand,
    Limits,
    demand_at,
    demand_of,
    level_heights,
    narrowed,
    poses_of,
)
from sms.workspace import reach
from sms.workspace_survey import BOXES, DEGREE

Beyond = Literal["refuse", "clip", "scale"]
SPECIFIED = BOXES[1]  #: Table 2.1, specification of the movement range
SPECIFIED_RATE = (6.0 * DEGREE, 4.0 * DEGREE)  #: of roll and pitch, Table 2.1, rad/s
_HALVINGS = 24
_CANDIDATES = 200
_ROUNDING = 1e-9  # m


@dataclass(frozen=True)
class Cut:
    """One kind of change made to a motion so that the platform can follow it."""

    limit: Literal["stroke", "speed"]
    share: float  #: of the time that was changed
    largest: float  #: rad, the largest angle taken off
    at: float  #: s, where that was
    sentence: str


@dataclass(frozen=True)
class Feasible:
    """A motion the platform can follow, and how it differs from the one asked for."""

    motion: DeckMotion
    asked: DeckMotion
    demand: Demand  #: of `motion`
    limits: Limits
    cuts: tuple[Cut, ...]
    notes: tuple[str, ...]  #: what is near a limit or beyond Table 2.1, a sentence each


def fitted(motion: DeckMotion, limits: Limits, beyond: Beyond, where: str) -> Feasible:
    """The motion as far as the platform can follow it.

    Args:
        motion: what is asked for, heave about limits.height.
        limits: of the machine.
        beyond: "refuse" raises InputError; "clip" takes the tilt back to the edge of the workspace
            in its own direction and slows what is too fast; "scale" makes all of it smaller.
        where: what an error names, "[deck_motion] roll".
    """
    excess = _excess_words(motion, limits)
    if beyond == "refuse" and excess:
        raise InputError(
            f'{where}: {excess[0]}; make the motion smaller, or write beyond = "clip" (cut where '
            'it is too much) or "scale" (all of it smaller)'
        )
    allowed, cuts = motion, tuple[Cut, ...]()
    if excess:
        cut = _clipped if beyond == "clip" else _scaled
        allowed, cuts = cut(motion, limits)
    demand = demand_of(allowed, limits)
    return Feasible(allowed, motion, demand, limits, cuts, _notes(motion, demand, limits))


def _excess_words(motion: DeckMotion, limits: Limits) -> list[str]:
    """What of the motion is too much, a sentence for each limit."""
    try:
        demand = demand_of(motion, limits)
    except OutOfWorkspaceError:
        worst = int(np.argmax(np.hypot(motion.roll, motion.pitch)))
        return [f"{_tilt(motion, worst)} is beyond any pose of the mechanism"]
    words = []
    excess = demand.stroke_excess(limits)
    if excess.max() > _ROUNDING:
        row = int(np.argmax(excess))
        low, high = (1e3 * end for end in limits.stroke)
        number = int(np.argmax(np.abs(demand.extension[row] - 0.5 * limits.params.stroke)))
        words.append(
            f"{_tilt(motion, row)} needs {1e3 * demand.extension[row, number]:.0f} mm of actuator "
            f"{number + 1}, {low:.0f} to {high:.0f} mm is allowed"
        )
    share = demand.speed_share(limits)
    if share.max() > 1.0 + _ROUNDING:
        row = int(np.argmax(share))
        number = int(np.argmax(np.abs(demand.extension_rate[row])))
        words.append(
            f"{_tilt(motion, row)} needs {1e3 * demand.extension_rate[row, number]:.0f} mm/s of "
            f"actuator {number + 1}, the flow allows {-1e3 * limits.speed.down:.0f} to "
            f"{1e3 * limits.speed.up:.0f} mm/s"
        )
    return words


def _tilt(motion: DeckMotion, row: int) -> str:
    heave = motion.heave[row]
    up = f", heave {1e3 * heave:.0f} mm" if abs(heave) > 5e-4 else ""
    return (
        f"roll {motion.roll[row] / DEGREE:.1f}°, pitch {motion.pitch[row] / DEGREE:.1f}°{up} at "
        f"{motion.time[row]:.1f} s"
    )


def _clipped(motion: DeckMotion, limits: Limits) -> tuple[DeckMotion, tuple[Cut, ...]]:
    reached, stroke_cut = _within_stroke(motion, limits)
    slowed, speed_cut = _within_speed(reached, limits)
    # A straight way between two poses within the stroke may leave it by tenths of a millimetre.
    inside, _ = _within_stroke(slowed, limits)
    return inside, tuple(cut for cut in (stroke_cut, speed_cut) if cut is not None)


def _within_stroke(motion: DeckMotion, limits: Limits) -> tuple[DeckMotion, Cut | None]:
    """Heave into what level allows, then the tilt back along its own direction to the edge."""
    narrow = narrowed(limits)
    low, high = level_heights(limits)
    height = np.clip(limits.height + motion.heave, low, high)
    tilt = np.hypot(motion.roll, motion.pitch)
    direction = np.arctan2(motion.pitch, motion.roll)
    edge = reach(height, direction, params=narrow)
    factor = np.minimum(1.0, edge / np.maximum(tilt, 1e-12))
    changed = (factor < 1.0 - 1e-12) | (np.abs(height - limits.height - motion.heave) > 1e-12)
    if not changed.any():
        return motion, None
    cut = replace(
        motion,
        roll=factor * motion.roll,
        pitch=factor * motion.pitch,
        heave=height - limits.height,
    )
    taken = (1.0 - factor) * tilt
    worst = int(np.argmax(taken))
    sentence = (
        f"Cut by the stroke: {_percent(changed)} of the time the motion asks for more than "
        f"{1e3 * limits.stroke[0]:.0f} to {1e3 * limits.stroke[1]:.0f} mm of extension at a height "
        f"of {limits.height:.3f} m"
        + (" (the cushions are left free)" if limits.clearance > 0.0 else "")
        + f"; {_tilt(motion, worst)} became roll {cut.roll[worst] / DEGREE:.1f}°, pitch "
        f"{cut.pitch[worst] / DEGREE:.1f}°, {taken[worst] / DEGREE:.1f}° less."
    )
    at = float(motion.time[worst])
    return cut, Cut("stroke", float(changed.mean()), float(taken[worst]), at, sentence)


def _within_speed(motion: DeckMotion, limits: Limits) -> tuple[DeckMotion, Cut | None]:
    """Follow the motion no faster than the flow allows, straight towards where it is."""
    wanted = np.column_stack([motion.roll, motion.pitch, motion.heave])
    if demand_of(motion, limits).speed_share(limits).max() <= 1.0:
        return motion, None
    rate = jacobian(poses_of(motion, limits.height), params=limits.params)
    up, down = limits.speed.up * motion.period, limits.speed.down * motion.period
    followed = wanted.copy()
    for row in range(1, len(wanted)):
        step = wanted[row] - followed[row - 1]
        travel = rate[row] @ step
        share = float(np.maximum(travel / up, -travel / down).max())
        followed[row] = followed[row - 1] + step / max(1.0, share)
    taken = np.hypot(*(wanted - followed).T[:2])
    changed = np.abs(wanted - followed).max(axis=1) > 1e-9
    worst = int(np.argmax(taken))
    cut = replace(motion, roll=followed[:, 0], pitch=followed[:, 1], heave=followed[:, 2])
    sentence = (
        f"Slowed by the valve's flow: {_percent(changed)} of the time an actuator would have to "
        f"move faster than {1e3 * limits.speed.up:.0f} mm/s up or {1e3 * limits.speed.down:.0f} "
        f"mm/s down; the motion lags by up to {taken[worst] / DEGREE:.1f}° at "
        f"{motion.time[worst]:.1f} s."
    )
    at = float(motion.time[worst])
    return cut, Cut("speed", float(changed.mean()), float(taken[worst]), at, sentence)


def _scaled(motion: DeckMotion, limits: Limits) -> tuple[DeckMotion, tuple[Cut, ...]]:
    """The largest common factor on roll, pitch and heave that keeps every limit."""

    def times(factor: float) -> DeckMotion:
        return replace(
            motion,
            roll=factor * motion.roll,
            pitch=factor * motion.pitch,
            heave=factor * motion.heave,
        )

    rows = _critical(motion)
    move = poses_of(motion, 0.0)[rows]
    rates = motion.rates(1)[rows], motion.rates(2)[rows]
    middle_pose = np.array([0.0, 0.0, limits.height])

    def speed_and_stroke(factor: float) -> tuple[float, float]:
        try:
            demand = demand_at(
                middle_pose + factor * move, factor * rates[0], factor * rates[1], limits
            )
        except OutOfWorkspaceError:
            return 0.0, math.inf
        return demand.speed_share(limits).max() - 1.0, demand.stroke_excess(limits).max()

    low, high = 0.0, 1.0
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if max(speed_and_stroke(middle)) <= 0.0 else (low, middle)
    _, stroke = speed_and_stroke(high)
    limit: Literal["stroke", "speed"] = "stroke" if stroke > 0.0 else "speed"
    tilt = np.hypot(motion.roll, motion.pitch)
    worst = int(np.argmax(tilt))
    sentence = (
        f"Scaled down to {low:.1%}: all of the motion is smaller by one factor, because "
        f"{_excess_words(motion, limits)[0]}; the largest tilt became "
        f"{low * tilt[worst] / DEGREE:.1f}° in place of {tilt[worst] / DEGREE:.1f}°."
    )
    taken = float((1.0 - low) * tilt[worst])
    return times(low), (Cut(limit, 1.0, taken, float(motion.time[worst]), sentence),)


def _critical(motion: DeckMotion) -> NDArray[np.int64]:
    """Samples among which the worst ones are at any scale: the largest tilts, heaves and rates."""
    rates = np.abs(motion.rates(1))
    sizes = [np.hypot(motion.roll, motion.pitch), np.abs(motion.heave), *rates.T]
    return np.unique(np.concatenate([np.argsort(size)[-_CANDIDATES:] for size in sizes]))


def _notes(asked: DeckMotion, demand: Demand, limits: Limits) -> tuple[str, ...]:
    notes = []
    names = ("roll", "pitch")
    for name, most, rate, fastest in zip(
        names, (SPECIFIED.roll, SPECIFIED.pitch), asked.rates(1).T[:2], SPECIFIED_RATE, strict=True
    ):
        largest = float(np.abs(asked.axis(name)).max())
        if largest > most:
            notes.append(
                f"The {name} asked for reaches {largest / DEGREE:.1f}°, more than the "
                f"±{most / DEGREE:g}° that the platform is specified for (Table 2.1)."
            )
        speed = float(np.abs(rate).max())
        if speed > fastest:
            notes.append(
                f"The {name} rate asked for reaches {speed / DEGREE:.1f}°/s, more than the specified "
                f"{fastest / DEGREE:g}°/s (Table 2.1)."
            )
    share = demand.speed_share(limits)
    notes.append(
        f"The fastest actuator uses {share.max():.0%} of the speed that the valve's flow allows, the "
        f"most loaded one {demand.force_share.max():.0%} of its force."
    )
    if not math.isfinite(float(demand.force_share.max())) or demand.force_share.max() > 1.0:
        notes.append("The supply pressure cannot give the force; the motion will not be followed.")
    return tuple(notes)


def _percent(changed: NDArray[np.bool_]) -> str:
    share = 100.0 * float(np.mean(changed))
    return f"{share:.1f} %" if share < 10.0 else f"{share:.0f} %"
