"""Records as the core's problem: a model held against them, window by window.

Of tank, bench and platform the record is cut into windows of about a second, each simulated from an initial state that
fits it best (libsms/estimation/shooting.hpp), and what comes out is in units of the declared noise. A cylinder's
windows are its strokes (rigs/cylinder.py). A window, or a few in a row, is the block that judgements resample.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from sms import _core
from sms.arrays import Array, Index
from sms.errors import InputError
from sms.estimation.block_statistics import merge_windows
from sms.estimation.chosen_windows import without_clipped
from sms.estimation.discrepancy import Discrepancy, Whitened
from sms.estimation.divergence import WithinNumbers
from sms.estimation.kind import Kind
from sms.estimation.least_squares import MOST_STEPS, Free, Solution, fit_windows
from sms.estimation.problem import WindowProblem, is_commanded
from sms.estimation.run import Run
from sms.io.rig import Rig
from sms.io.signals import without_leg


@dataclass(frozen=True, eq=False)
class Runs:
    """Several records as one problem of the core, with what a judgement needs to know of each row."""

    rig: Rig
    motions: tuple[Run, ...]
    noise: dict[str, float]
    kind: Kind

    windows_per_block: int = 1
    """Windows in a row that are resampled together, where noise lasts longer than one."""
    complete: bool = False
    """Whether windows in which a reading is clipped are kept."""

    @property
    def whitened(self) -> bool:
        """Whether residuals are in units of the noise of a sample (kind.Kind)."""
        return self.kind.whitened

    @cached_property
    def channels(self) -> tuple[str, ...]:
        """The outputs that every record has."""
        return tuple(s for s in self.kind.outputs if all(s in m.signals for m in self.motions))

    def compares(self, run: Run, channel: str) -> bool:
        """Whether an output is compared in a run: no command where no controller is simulated."""
        return not (run.commanded and channel in self.kind.computed)

    @cached_property
    def simulation(self) -> WindowProblem:
        """The records as the core's problem; InputError for what it refuses."""
        try:
            problem = self.kind.make_problem(self.rig, self.motions, self.channels, self.noise)
            for number, run in enumerate(self.motions):
                if run.ahead is not None and is_commanded(problem):
                    for command, ahead in enumerate(run.ahead.T):
                        problem.set_ahead(number, command, ahead)
            return problem
        except ValueError as problem:
            names = ", ".join(f"{number}: {run.name}" for number, run in enumerate(self.motions))
            raise InputError(f"{self.rig.path}: {problem} (records {names})") from None

    @cached_property
    def problem(self) -> WindowProblem:
        """The same where it does not diverge, and where no reading is clipped."""
        if not self.whitened:
            return self.simulation
        counted = WithinNumbers(self.simulation, self.rig.table)
        return counted if self.complete else without_clipped(counted, self.motions)

    def fit(
        self,
        initial: _core.Params,
        free: list[Free],
        pull: Array,
        most_steps: int = MOST_STEPS,
        nearby: Mapping[str, Array] | None = None,
        kept: Collection[str] = (),
        discrepancy: Discrepancy | None = None,
        stated: bool = False,
    ) -> Solution:
        """Least squares over the free parameters; of a simulated rig pulled by rows (r, free), in at most so many
        steps, with sensitivities (rows,) of a model nearby to begin with, of which some are kept, and generalised by
        the covariance of a discrepancy. stated: its values are (fit_windows).
        """
        if not self.whitened:
            return self.kind.solve(self.problem, initial, free)
        window = self.window if stated else None
        if discrepancy is None:
            return fit_windows(self.problem, initial, free, most_steps, pull, nearby, kept, window)
        root, white = discrepancy.whitener, {}
        if nearby:
            columns = root.whiten(np.column_stack(list(nearby.values())))
            white = dict(zip(nearby, columns.T, strict=True))
        problem = Whitened(self.problem, root)
        found = fit_windows(problem, initial, free, most_steps, pull, white, kept, window)
        return replace(
            found, residual=root.colour(found.residual), jacobian=root.colour(found.jacobian)
        )

    def discrepancy(
        self, params: _core.Params, residual: Array, alike: bool = False
    ) -> Discrepancy:
        """The random hidden inputs for which the residual (rows,) of these parameters is most likely; if `alike`, those
        that are equally large in all windows."""
        equations = len(self.kind.hidden)
        return Discrepancy.of(self.problem, params, equations, residual, alike, self.jumping)

    def discrepancy_of(self, params: _core.Params, tau: Array) -> Discrepancy:
        """Random hidden inputs of standard deviations (groups,) that other records told."""
        return Discrepancy.sized(self.problem, params, tau, self.jumping)

    @property
    def jumping(self) -> tuple[float, ...]:
        """How nearly it is known of each record when its commands jumped, s; empty where no record has commands."""
        return tuple(run.jump_deviation for run in self.motions) if self.kind.switched else ()

    @cached_property
    def whole(self) -> Runs:
        """The same runs with all their samples compared."""
        if self.kind.whole is None:
            return self
        return replace(self, motions=tuple(self.kind.whole(run) for run in self.motions))

    def excerpt(self, chosen: Sequence[int]) -> Runs:
        """Some of the windows, each a record of its own, with as much before it as the first of its record has."""
        runs, windows = [], self.problem.windows
        for k in chosen:
            window = windows[k]
            lead = next(w.first for w in self.simulation.windows if w.record == window.record)
            part = slice(max(window.first - lead, 0), window.first + window.samples)
            runs.append(self.motions[window.record].part(part))
        return replace(self, motions=tuple(runs))

    def part(self, number: int) -> Runs:
        """One of the records alone."""
        return replace(self, motions=(self.motions[number],))

    @cached_property
    def record(self) -> Index:
        """(rows,): which record a row belongs to."""
        return self._of_windows([w.record for w in self.problem.windows])

    @cached_property
    def window(self) -> Index:
        """(rows,): which window a row belongs to."""
        return self._of_windows(list(range(len(self.problem.windows))))

    @cached_property
    def block(self) -> Index:
        """(rows,): which block of windows in a row; what judgements resample (block_statistics.py)."""
        if self.windows_per_block == 1:
            return self.window
        return merge_windows(self.record, self.window, self.windows_per_block)

    @cached_property
    def sample(self) -> Index:
        """(rows,): number of the sample in its record."""
        parts = [
            np.repeat(w.first + np.arange(w.samples), len(self.channels))
            for w in self.problem.windows
        ]
        return np.concatenate(parts).astype(np.int64)

    @cached_property
    def channel(self) -> Index:
        """(rows,): which output, as its place in `channels`."""
        return np.arange(self.problem.rows, dtype=np.int64) % len(self.channels)

    def _of_windows(self, values: list[int]) -> Index:
        return np.repeat(np.array(values, dtype=np.int64), [w.rows for w in self.problem.windows])

    def covariate(self, values: Sequence[Array]) -> Array:
        """(rows,) of one array (n,) a record."""
        out = np.empty(self.problem.rows)
        for number, of_record in enumerate(values):
            rows = self.record == number
            out[rows] = of_record[self.sample[rows]]
        return out

    @cached_property
    def inputs(self) -> dict[str, Array]:
        """(rows,) each: the signals along which a residual may be arranged, SI."""
        names = [n for n in self.motions[0].signals if all(n in m.signals for m in self.motions)]
        found = {
            f"{n} [{self.kind.units[n]}]": self.covariate([m.signals[n] for m in self.motions])
            for n in names
            if without_leg(n) != "setpoint"
        }
        derived = [self.kind.derived(m) for m in self.motions]
        for name in derived[0]:
            found[name] = self.covariate([d[name] for d in derived])
        found["time [s]"] = self.covariate([m.time - m.time[0] for m in self.motions])
        return found

    def floor(self, residual: Array) -> Array:
        """(channels,): mean square of what differs within `kind.short`, in units of the declared noise."""
        out = np.empty(len(self.channels))
        for c in range(len(self.channels)):
            lag = max(1, round(self.kind.short / self.motions[0].step))
            of_channel = residual[self.channel == c]
            same = self.block[self.channel == c]
            together = same[lag:] == same[:-lag]
            out[c] = 0.5 * np.mean((of_channel[lag:] - of_channel[:-lag])[together] ** 2)
            if out[c] == 0.0:  # a reading that never changes has the noise that is declared of it
                out[c] = 1.0
            if self.channels[c] in self.kind.computed:
                out[c] = max(out[c], 1.0)
        return out
