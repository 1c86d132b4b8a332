"""Draws one hidden effect on a bench, a platform or a tank; writes rig file, records, sealed truth.

The truth goes where the caller says, outside the records' folder; the folder only gets its
SHA-256, written first, so that nobody can change the answer after the verdict.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from validation.twins import effects, limits
from validation.twins.air import Array
from validation.twins.bench_rig import BenchRig
from validation.twins.declared import as_declared, drawn, half_width
from validation.twins.effects import Effect
from validation.twins.imperfection import LARGEST, bowed, draw_imperfection
from validation.twins.instruments import CHANNELS, Channel, channel_of, converted, noise
from validation.twins.measured import VirtualRig, every, sample_times
from validation.twins.platform_rig import PlatformRig
from validation.twins.rig_file import rig_file, write_record
from validation.twins.tank_rig import TankRig
from validation.twins.truth import Truth

RIGS: Mapping[str, VirtualRig] = {
    "bench": BenchRig(),
    "platform": PlatformRig(),
    "tank": TankRig(),
}
CONTROLLED: Mapping[str, Callable[[float, float], VirtualRig]] = {
    "bench": BenchRig.controlled,
    "platform": PlatformRig.controlled,
    "tank": TankRig.controlled,
}
"""The same with a controller that holds its command, by the step of the log and its period."""
PAIRS: Mapping[str, Sequence[tuple[str, str]]] = {
    "bench": (("multisine", "holds"), ("steps", "triangle"), ("chirp", "ends")),
    "tank": (("strokes", "bursts"), ("bursts", "strokes")),
    "platform": (("multisine", "holds"),),
}
"""What excites the two records to identify with; those to validate with come from another pair."""
UNSEEN = ("chirp", "steps")
"""That other pair where there is but one."""
LIMIT_SEED = 1
ADDED = 7
"""Which of a seed's streams runs that are added later draw from."""


@dataclass(frozen=True)
class Run:
    """One record to be made."""

    name: str
    role: str
    excited_by: str


@dataclass(frozen=True)
class Hidden:
    """One effect of one size."""

    effect: Effect
    value: float
    limit: float | None


def pair_key(pair: tuple[str, str]) -> str:
    """How a pair of excitations is called in the limits' tables."""
    return "+".join(pair)


def draw_runs(kind: str, rng: np.random.Generator) -> tuple[str, list[Run]]:
    """Two runs to identify with, two others to validate with, and the pair that limits go by."""
    pairs = PAIRS[kind]
    order = rng.permutation(len(pairs))
    first, second = pairs[order[0]], pairs[order[1]] if len(pairs) > 1 else UNSEEN
    runs = [
        Run(f"{role}_{i + 1}_{name}", role, name)
        for role, pair in (("identify", first), ("validate", second))
        for i, name in enumerate(pair)
    ]
    return pair_key(first), runs


def drawable(kind: str, pair: str, multiple: float = 3.0) -> list[Effect]:
    """The catalogue's effects that this pair of excitations shows at a size that they can have."""
    found = limits.read(kind)[pair]

    def has_room(effect: Effect) -> bool:
        limit = found.get(effect.key)
        return limit is not None and multiple * limit <= effect.largest

    return [
        effect
        for effect in effects.on(kind, effects.CATALOGUE)
        if effect.drawn_from is not None or has_room(effect)
    ]


def draw_effect(
    kind: str, pair: str, name: str | None, rng: np.random.Generator
) -> tuple[Effect, float, float]:
    """Which effect, which sign, and where in its range one without a small size lies."""
    which, option = rng.integers(2**32), rng.integers(2**32)
    sign, part = float(rng.choice([-1.0, 1.0])), float(rng.uniform())
    if name is None:
        ids = sorted({effect.id for effect in drawable(kind, pair)} | {effects.NONE.id})
        name = ids[int(which) % len(ids)]
    options = effects.find(kind, name)
    if len(options) > 1:
        can_be_seen = drawable(kind, pair)
        options = [effect for effect in options if effect in can_be_seen] or options
    effect = options[int(option) % len(options)]
    return effect, sign if effect.signed else effect.sense, part


def size_of(
    kind: str, pair: str, effect: Effect, multiple: float, loudness: float, part: float
) -> tuple[float, float | None]:
    """The size (positive; beyond the half width for a shift) and the limit, if there is one.

    Raises: ValueError for an effect that these excitations cannot show.
    """
    if effect is effects.NONE:
        return 0.0, None
    if effect.drawn_from is not None:
        low, high = effect.drawn_from
        return low * (high / low) ** part, None
    limit = limits.read(kind)[pair].get(effect.key)
    if limit is None:
        raise ValueError(
            f"'{effect.key}' cannot be seen on a {kind} excited by {pair.replace('+', ' and ')}; "
            "choose another effect or another seed"
        )
    limit *= loudness
    return min(multiple * limit, effect.largest), limit


@dataclass(frozen=True)
class Trial:
    """All that decides the files of one draw."""

    rig: VirtualRig
    runs: Sequence[Run]
    truth: Truth
    hidden: Sequence[Hidden]
    seed: int
    loudness: float = 1.0
    multiple: float = 0.0
    day: int = 0
    """Of measuring: the same machine and instruments, other motions and noise."""

    @property
    def channels(self) -> dict[str, Channel]:
        """The instruments with this trial's noise."""
        return {name: channel.louder(self.loudness) for name, channel in CHANNELS.items()}


def draw(
    kind: str,
    seed: int,
    out: Path | str,
    truth_path: Path | str,
    effect: str | Sequence[str] | None = None,
    multiple: float = 3.0,
    imperfection: float = 0.0,
) -> Trial:
    """Write records, `rig.toml` and `truth.sha256` to `out`, the truth to `truth_path`.

    `effect` is an id, or `id:target`, or several of them; by default one is drawn. Its size is
    `multiple` times its detection limit. The same seed gives the same rig and the same noise
    whatever the effect. `imperfection`: percent by which the machine is off from what can be declared
    (imperfection.py). Raises `ValueError` for an unknown rig or effect, a size that is not
    positive or a truth inside `out`.
    """
    if kind not in RIGS:
        raise ValueError(f"there is no rig '{kind}'; choose one of: {', '.join(RIGS)}")
    if not (np.isfinite(multiple) and multiple > 0.0):
        raise ValueError(f"multiple is {multiple}; it must be a positive number")
    if seed < 0:
        raise ValueError(f"seed is {seed}; it must not be negative")
    if not 0.0 <= imperfection <= LARGEST:
        raise ValueError(f"imperfection is {imperfection} %; it must be 0 to {LARGEST:g} %")
    trial = draw_trial(kind, seed, effect, multiple, imperfection)
    write_trial(trial, out, truth_path)
    return trial


def draw_trial(
    kind: str,
    seed: int,
    effect: str | Sequence[str] | None,
    multiple: float,
    imperfection: float = 0.0,
) -> Trial:
    """Rig, runs and what is hidden; see `draw`."""
    rig = RIGS[kind]
    for_rig, for_effect, for_runs = (np.random.default_rng(s) for s in seeds_of(seed)[:3])
    pair, runs = draw_runs(kind, for_runs)
    loudness = float(for_runs.uniform(0.7, 1.3))
    names = [effect] if effect is None or isinstance(effect, str) else list(effect)
    found = []
    for name in names:
        one, sign, part = draw_effect(kind, pair, name, for_effect)
        size, limit = size_of(kind, pair, one, multiple, loudness, part)
        if one is not effects.NONE:
            shift = half_width(rig.declared, one)
            found.append(Hidden(one, sign * (size + shift), limit))
    kept = [name for hidden in found for name in hidden.effect.names if hidden.effect.shifts]
    truth = drawn(as_declared(Truth(), rig.declared), rig.declared, kept, for_rig)
    for hidden in found:
        truth = hidden.effect.hidden_in(truth, hidden.value)
    if imperfection > 0.0:
        stream = seeds_of(seed)[6]
        off = draw_imperfection(imperfection, rig.axes, rig.signals, rig.log_steps, stream)
        truth, rig = (
            replace(truth, imperfection=off),
            CONTROLLED[kind](off.log_step, off.control_period),
        )
    return Trial(rig, runs, truth, found, seed, loudness, multiple)


def seeds_of(seed: int) -> list[np.random.SeedSequence]:
    """For the rig, the effect, the choice of runs, their noise, the salt, what is declared, the imperfection, runs that
    are added later."""
    return np.random.SeedSequence(seed).spawn(ADDED + 1)


def write_trial(trial: Trial, out: Path | str, truth_path: Path | str) -> None:
    """Hash of the truth, truth, records, rig file, in this order."""
    out, truth_path = Path(out), Path(truth_path)
    if truth_path.resolve().is_relative_to(out.resolve()):
        raise ValueError(f"the truth ({truth_path}) must lie outside the records' folder ({out})")
    for_records, for_salt, for_declared = seeds_of(trial.seed)[3:6]
    for _ in range(trial.day):
        for_records.spawn(len(trial.runs))
    records = {
        run.name: _record(trial, run.excited_by, child)
        for run, child in zip(trial.runs, for_records.spawn(len(trial.runs)), strict=True)
    }
    sealed = _sealed(trial, np.random.default_rng(for_salt).bytes(16).hex())
    out.mkdir(parents=True, exist_ok=True)
    truth_path.parent.mkdir(parents=True, exist_ok=True)
    (out / "truth.sha256").write_text(hashlib.sha256(sealed).hexdigest() + "\n")
    truth_path.write_bytes(sealed)
    for name, columns in records.items():
        write_record(out / f"{name}.csv", columns)
    spread = float(np.random.default_rng(for_declared).uniform(0.85, 1.15))
    calibrated = trial.truth.imperfection is None  # no sensor bows, and its owner knows
    text = rig_file(trial.rig, trial.runs, trial.channels, spread, calibrated)
    (out / "rig.toml").write_text(text)


def _record(trial: Trial, excited_by: str, seed: np.random.SeedSequence) -> dict[str, Array]:
    """The columns of one record, by name without unit."""
    for_plan, for_noise = (np.random.default_rng(s) for s in seed.spawn(2))
    plan = trial.rig.plan(excited_by, for_plan)
    columns = recorded(trial, trial.truth, plan, trial.rig.duration, for_noise)
    if not all(np.isfinite(column).all() for column in columns.values()):
        hidden = " and ".join(h.effect.key for h in trial.hidden) or "nothing"
        raise ValueError(
            f"{trial.rig.kind}, seed {trial.seed}, {hidden} hidden: the simulation of {excited_by} diverges"
        )
    return columns


def recorded(
    trial: Trial, truth: Truth, plan: Any, duration: float, for_noise: np.random.Generator
) -> dict[str, Array]:
    """What the logger writes of a run of `duration` seconds: the columns by name without unit."""
    rig, off, channels = trial.rig, truth.imperfection, trial.channels
    period, logged = rig.clock.period, every(rig.clock.period, rig.sample_step)
    count = every(period, duration) + 1
    noises = {
        signal: noise(channel_of(signal, channels), count, period, for_noise)
        for signal in rig.signals
    }
    measured = rig.measure(truth, plan, noises)
    columns = {"time": sample_times(duration, rig.sample_step)}
    for signal, values in measured.commands.items():
        columns[signal] = converted(channel_of(signal, channels), values)
    columns |= measured.setpoints
    for signal, values in measured.signals.items():
        bow = 0.0 if off is None else off.bows.get(signal, 0.0)
        seen = bowed(signal, values, bow) if bow != 0.0 else values
        down = off is not None and off.rounds_down
        noisy = seen + noises[signal][::logged]
        columns[signal] = converted(channel_of(signal, channels), noisy, down)
    return columns


def _sealed(trial: Trial, salt: str) -> bytes:
    """The truth as text; the salt keeps it from being guessed by its hash."""
    content: dict[str, Any] = {
        "kind": trial.rig.kind,
        "effects": [
            {
                "effect": hidden.effect.id,
                "target": hidden.effect.target,
                "key": hidden.effect.key,
                "value": hidden.value,
                "unit": hidden.effect.unit,
                "is_shift": hidden.effect.shifts,
                "detection_limit": hidden.limit,
            }
            for hidden in trial.hidden
        ],
        "multiple": trial.multiple,
        "seed": trial.seed,
        "salt": salt,
        "loudness": trial.loudness,
        "truth": _plain(trial.truth),
        "records": {run.name: asdict(run) for run in trial.runs},
    }
    if trial.truth.imperfection is not None:
        content["imperfection"] = trial.truth.imperfection.sealed
    return (json.dumps(content, indent=2) + "\n").encode()


def _plain(truth: Truth) -> dict[str, Any]:
    parts = {name: getattr(truth, name) for name in ("machine", "body", "errors")}
    errors = {signal: asdict(error) for signal, error in parts.pop("errors").of.items()}
    return {name: part._asdict() for name, part in parts.items()} | {"errors": errors}


def open_truth(truth_path: Path | str, out: Path | str) -> dict[str, Any]:
    """The truth, after checking that it is the one sealed in the records' folder `out`."""
    sealed = Path(truth_path).read_bytes()
    if hashlib.sha256(sealed).hexdigest() != (Path(out) / "truth.sha256").read_text().strip():
        raise ValueError(f"{truth_path} is not the truth that was sealed in {out}")
    truth: dict[str, Any] = json.loads(sealed)
    return truth
