"""What identified parameters are worth on records that were not used for the fit."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from sms import _core
from sms.estimation.block_statistics import interval, resampled, weighted_ms
from sms.estimation.windows import Runs
from sms.identification.bench_records import whole_windows


@dataclass(frozen=True)
class ChannelGain:
    """One signal of one record: root mean square of what is left, SI, before and after."""

    record: str
    channel: str
    before: float
    after: float
    noise: float
    gain: float
    """1 - after / before"""
    interval: tuple[float, float]
    """95 percent, over resampled windows."""


def gains(runs: Runs | None, before: _core.Params, after: _core.Params) -> tuple[ChannelGain, ...]:
    """What the identified parameters are worth on records that were not used, window by window from free states."""
    if runs is None:
        return ()
    whole = whole_windows(runs)
    squared = [np.square(runs.problem.errors(p)) for p in (before, after)]
    counts = resampled(runs.record, runs.block, np.random.default_rng(1))
    out = []
    for number, run in enumerate(runs.motions):
        for c, channel in enumerate(runs.channels):
            rows = whole & (runs.record == number) & (runs.channel == c)
            rms = [float(np.sqrt(np.mean(s[rows]))) for s in squared]
            share = [weighted_ms(np.where(rows, s, 0.0), runs.block, counts) for s in squared]
            change = 1.0 - np.sqrt(share[1] / np.maximum(share[0], 1e-300))
            noise = runs.noise[channel]
            out.append(
                ChannelGain(
                    run.name, channel, rms[0] * noise, rms[1] * noise, noise,
                    1.0 - rms[1] / max(rms[0], 1e-300), interval(change),
                )
            )  # fmt: skip
    return tuple(out)
