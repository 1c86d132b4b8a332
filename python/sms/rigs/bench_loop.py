"""The kind "bench" with its controller simulated: set-point in, extension, chamber pressures and command out.

The controller is the project's own (libsms/include/sms/position_loop.hpp), inside the core's simulation of a window
(libsms/estimation/actuator_controller.hpp). Where the command was recorded it is an output as well: what the controller
makes of the recorded extension, held against it. That row knows the controller only, the others the machine and it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from sms import _core
from sms.estimation.run import Run
from sms.io.rig import Rig
from sms.rigs.bench import BENCH, LONGEST_STEP, OUTPUTS, record_of
from sms.rigs.mixed_loops import mixed
from sms.rigs.pneumatic import NOTHING, controller_of, in_windows

COMMAND = "valve_command"
COMMAND_NOISE = 2e-3
"""V: a step of the pulse width, 10 V in 1500 of them (section 7.3.2), over sqrt(12)."""
HIDDEN = {**BENCH.hidden, "command": "V"}


def make_problem(
    rig: Rig, runs: Sequence[Run], channels: Sequence[str], noise: Mapping[str, float]
) -> _core.BenchLoopProblem:
    """The records as the core's problem."""
    return _core.BenchLoopProblem(
        records=[_record(run, channels) for run in runs],
        noise={s: noise[s] for s in (*OUTPUTS, COMMAND)},
        said=rig.start(),
        **controller_of(rig),
        **in_windows(rig, LONGEST_STEP, runs),
    )


def _record(run: Run, channels: Sequence[str]) -> _core.BenchRecord:
    command = run.signals[COMMAND] if COMMAND in channels else NOTHING
    return record_of(run, channels, command=command, setpoint=run.signals["setpoint"])


BENCH_LOOP = replace(
    BENCH,
    outputs=(*OUTPUTS, COMMAND),
    hidden=HIDDEN,
    make_problem=mixed(make_problem, BENCH.make_problem, (COMMAND,), len(HIDDEN)),
    computed={COMMAND: COMMAND_NOISE},
)
BENCH_LOOP_BLIND = replace(BENCH_LOOP, equations=None, shown=("extension", "setpoint"))
"""The same where the command was not recorded: what the equations were fed with is not known."""
