"""`sms identify friction`: the friction of a cylinder from its displacement and its pressures.

Newton's second law of the piston (eq. 6.4), fed with the measured motion and pressures, leaves the friction force. The
source's law (eq. 6.5) and its rivals (eq. 6.1, eq. 6.2, LuGre) are fitted to the records of role `identify`
(friction_fit.py) and judged on those of role `validate`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from sms import _core
from sms.callbacks import Progress
from sms.errors import InputError
from sms.identification.friction_fit import EQUATION, LAWS, LawFit, fit_law
from sms.io.check import check_record, raise_if_unusable
from sms.io.records import Finding, Record, load_record
from sms.io.rig import Rig, load_rig
from sms.parameters import PARAMETERS
from sms.rigs.cylinder import Motion, prepare
from sms.views import Shown

SPACING = 5e-3
"""s: samples closer than this are thinned; the motion is a mean over 0.15 s, they say the same."""


@dataclass(frozen=True)
class FrictionResult(Shown):
    """Everything `sms identify friction` found."""

    title: str
    rig: str
    motions: tuple[Motion, ...]
    laws: tuple[LawFit, ...]
    best: str
    """The law that fits the validation records best (without them: the identification records)."""
    findings: tuple[Finding, ...]
    speed: tuple[float, float]
    """m/s, 1st and 99th percentile of the compared samples."""
    acceleration: float
    """m/s^2, root mean square of the compared samples."""

    def law(self, name: str) -> LawFit:
        """One of the laws."""
        return next(fit for fit in self.laws if fit.law == name)


def identify_friction(
    path: Path,
    progress: Progress = lambda text, done: None,
    choice: Sequence[str] = tuple(LAWS),
) -> FrictionResult:
    """Fit laws of friction, by default all, to a rig of kind "cylinder" or "bench".

    InputError says what is wrong with it.
    """
    rig = load_rig(path)
    if rig.kind not in ("cylinder", "bench"):
        raise InputError(
            f"{path}, [rig] kind: '{rig.kind}' has no single cylinder; sms identify friction reads "
            "rigs of kind 'cylinder' or 'bench'"
        )
    motions, findings, loaded = _motions(rig)
    identify = [m for m in motions if m.role == "identify"]
    validate = [m for m in motions if m.role != "identify"]
    if not identify:
        raise InputError(
            f"{path}, [[records]]: none has the role 'identify'; there is nothing to fit"
        )
    start = _core.Params(**{name: rig.declared(name).value for name in PARAMETERS})
    asked = tuple(n for n, d in rig.parameters.items() if d.fit)
    laws = []
    for number, law in enumerate(choice):
        progress(f"fitting {EQUATION[law]}", number / len(choice))
        laws.append(fit_law(law, identify, validate, start, asked, loaded))
    judge = (lambda f: f.rms_validate) if validate else (lambda f: f.rms_identify)
    speeds = np.concatenate([np.abs(m.velocity[m.used]) for m in identify])
    acceleration = np.concatenate([m.acceleration[m.used] for m in identify])
    return FrictionResult(
        title=rig.title,
        rig=path.name,
        motions=tuple(motions),
        laws=tuple(laws),
        best=min(laws, key=judge).law,
        findings=findings,
        speed=(float(np.quantile(speeds, 0.01)), float(np.quantile(speeds, 0.99))),
        acceleration=float(np.sqrt(np.mean(acceleration**2))),
    )


def _motions(rig: Rig) -> tuple[list[Motion], tuple[Finding, ...], bool]:
    """Every record with its motion, and whether a load cell was read; without one F_L = 0."""
    records = [load_record(rig, source) for source in rig.records]
    findings = tuple(f for record in records for f in check_record(rig, record))
    raise_if_unusable(findings)
    motions = []
    for record in records:
        signals = dict(record.signals)
        signals.setdefault("rod_force", np.zeros(len(record)))
        motion = prepare(rig, replace(record, signals=signals))
        if not motion.used.any():
            raise InputError(_standstill(rig, record))
        motions.append(_thinned(motion))
    return motions, findings, any("rod_force" in record.signals for record in records)


def _thinned(motion: Motion) -> Motion:
    rows = slice(None, None, max(round(SPACING / float(np.median(np.diff(motion.time)))), 1))
    return replace(
        motion,
        time=motion.time[rows],
        velocity=motion.velocity[rows],
        acceleration=motion.acceleration[rows],
        signals={name: values[rows] for name, values in motion.signals.items()},
        used=motion.used[rows],
        stroke=motion.stroke[rows],
    )


def _standstill(rig: Rig, record: Record) -> str:
    above = f" faster than {1e3 * (rig.speed_above or 0.0):g} mm/s" if rig.speed_above else ""
    return (
        f"{record.file}: the piston never moves{above}, so no friction force can be read off it; what "
        "it still shows is that break-away needs more than the largest force applied; record a run "
        "that moves, or lower speed_above"
    )
