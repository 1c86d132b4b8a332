"""The kind "platform" with the controller of each leg simulated: three set-points in, the rest out.

As on the bench (bench_loop.py): the project's own controllers, inside the core's simulation of a window
(libsms/estimation/platform_loop.hpp), and where the commands were recorded they are outputs as well. The set-points are
those of the extensions; those of a pose are its inverse kinematics (sms.extensions_of).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import cast

from sms import _core
from sms.estimation.problem import WindowProblem
from sms.estimation.run import Run
from sms.io.rig import Rig
from sms.io.signals import LEGS, of_legs
from sms.rigs.bench_loop import COMMAND_NOISE
from sms.rigs.mixed_loops import mixed
from sms.rigs.platform import LONGEST_STEP, NOT_OF_LEGS, OUTPUTS, PLATFORM, columns, record_of
from sms.rigs.pneumatic import controller_of, in_windows

COMMANDS = of_legs("valve_command")
HIDDEN = {**PLATFORM.hidden, **{f"command of leg {leg}": "V" for leg in LEGS}}


def make_problem(
    rig: Rig, runs: Sequence[Run], channels: Sequence[str], noise: Mapping[str, float]
) -> WindowProblem:
    """The records as the core's problem."""
    said = rig.start()
    assert isinstance(said, _core.LegParams)
    problem = _core.PlatformLoopProblem(
        records=[_record(run, channels) for run in runs],
        noise={s: noise[s] for s in (*OUTPUTS, *COMMANDS)},
        said=said,
        **controller_of(rig),
        **in_windows(rig, LONGEST_STEP, runs),
    )
    return cast(WindowProblem, problem)  # as in platform.py


def _record(run: Run, channels: Sequence[str]) -> _core.PlatformRecord:
    recorded = COMMANDS[0] in channels
    command = columns(run, "valve_command") if recorded else NOT_OF_LEGS
    return record_of(run, channels, command=command, setpoint=columns(run, "setpoint"))


PLATFORM_LOOP = replace(
    PLATFORM,
    outputs=(*OUTPUTS, *COMMANDS),
    hidden=HIDDEN,
    make_problem=mixed(make_problem, PLATFORM.make_problem, COMMANDS, len(HIDDEN)),
    computed=dict.fromkeys(COMMANDS, COMMAND_NOISE),
)
PLATFORM_LOOP_BLIND = replace(PLATFORM_LOOP, equations=None, shown=of_legs("extension", "setpoint"))
"""The same where the commands were not recorded: what the equations were fed with is not known."""
