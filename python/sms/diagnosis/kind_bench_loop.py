"""The kind "bench" with its controller simulated: set-point in, extension, chamber pressures and command out.

The controller is the project's own (libsms/include/sms/position_loop.hpp), inside the core's simulation of a window
(libsms/estimation/bench_controller.hpp). Where the command was recorded it is an output as well: what the controller
makes of the recorded extension, held against it. That row knows the controller only, the others the machine and it.
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from sms import _core
from sms.diagnosis.kind import Run
from sms.diagnosis.kind_bench import BENCH, LONGEST_STEP, OUTPUTS, WINDOW
from sms.io.rig import Rig

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
        law=rig.control.law,
        compensated=rig.control.compensated,
        electronics=rig.control.electronics,
        friction=rig.model.friction,
        valve=rig.model.valve,
        chambers=rig.model.chambers,
        window=WINDOW,
        longest_step=LONGEST_STEP,
        threads=int(os.environ.get("SMS_THREADS", "2")),
    )


def _record(run: Run, channels: Sequence[str]) -> _core.BenchRecord:
    s, nothing = run.signals, np.empty(0)
    return _core.BenchRecord(
        step=run.step,
        command=s[COMMAND] if COMMAND in channels else nothing,
        setpoint=s["setpoint"],
        extension=s["extension"],
        pressure_lower=s["chamber_pressure_lower"],
        pressure_upper=s["chamber_pressure_upper"],
        supply_pressure=s["supply_pressure"] if "supply_pressure" in channels else nothing,
        conditions=run.conditions,
    )


BENCH_LOOP = replace(
    BENCH,
    outputs=(*OUTPUTS, COMMAND),
    hidden=HIDDEN,
    make_problem=make_problem,
    computed={COMMAND: COMMAND_NOISE},
)
BENCH_LOOP_BLIND = replace(BENCH_LOOP, equations=None, shown=("extension", "setpoint"))
"""The same where the command was not recorded: what the equations were fed with is not known."""
