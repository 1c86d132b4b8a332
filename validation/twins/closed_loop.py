"""Bench and platform under sampled position controllers; records of such loops.

What the owner of a loop believes of the controller (controller.py) stands in the rig file; what it really does may be
something else.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from validation.reference.compiled import compiled
from validation.twins import bench, effects
from validation.twins.air import Array
from validation.twins.bench_rig import BenchRig
from validation.twins.closed_platform import ClosedPlatformRig
from validation.twins.controller import (
    IN_RIG_FILE,
    PLATFORM_CONTROLLER,
    Controller,
    answered,
    delay,
    read,
    sample_at_valve,
)
from validation.twins.declared import BENCH, PLATFORM, Declared, as_declared, drawn
from validation.twins.draw import Hidden, Trial, draw_runs, write_trial
from validation.twins.effects import Effect
from validation.twins.instruments import CHANNELS
from validation.twins.machine import Machine
from validation.twins.maps import Maps, exact
from validation.twins.measured import Measured, VirtualRig
from validation.twins.truth import Truth


@compiled
def run(
    p: Machine,
    maps: Maps,
    y: Array,
    setpoint: Array,
    noise: Array,
    count: float,
    gains: Array,
    commands: Array,
    states: Array,
) -> None:
    """Fills `commands` and, bench.FINE times as long, `states`; y is where the run starts.

    noise: of the sensor, m; count: one step of the converter, m; gains: Controller's numbers in their order.
    """
    period = bench.SAMPLE_STEP
    dt = period / bench.STEPS
    every = bench.STEPS // bench.FINE
    late = delay(p)
    k1, k2 = np.zeros(bench.STATES), np.zeros(bench.STATES)
    k3, k4 = np.zeros(bench.STATES), np.zeros(bench.STATES)
    memory = np.array([setpoint[0] - y[0], 0.0, 0.0])
    states[0] = y
    for k in range(setpoint.size):
        error = setpoint[k] - read(y[0], noise[k], count)
        commands[k] = answered(gains, period, memory, error)
        if k == setpoint.size - 1:
            return
        for i in range(bench.STEPS):
            sent = sample_at_valve(k, i * dt, late, period)
            u = commands[sent] if sent >= 0 else 5.0
            now = k * period + i * dt
            bench.derivative(p, now, maps, y, 0.0, u, k1)
            bench.derivative(p, now + 0.5 * dt, maps, y + 0.5 * dt * k1, 0.0, u, k2)
            bench.derivative(p, now + 0.5 * dt, maps, y + 0.5 * dt * k2, 0.0, u, k3)
            bench.derivative(p, now + dt, maps, y + dt * k3, 0.0, u, k4)
            y += dt / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
            if (i + 1) % every == 0:
                states[k * bench.FINE + (i + 1) // every] = y


class ClosedBenchRig(BenchRig):
    """The bench with a controller."""

    title = "Virtual pneumatic actuator in its position loop"

    def __init__(self, controller: Controller) -> None:
        super().__init__()
        self.controller = controller

    def measure(
        self, truth: Truth, plan: bench.Plan, reading_noise: Mapping[str, Array]
    ) -> Measured:
        """One run; for a sensor of the extension without errors, which is also the controller's."""
        count = plan.setpoint.size
        commands = np.zeros(count)
        states = np.zeros(((count - 1) * bench.FINE + 1, bench.STATES))
        run(
            truth.built,
            exact(),
            bench.balanced(truth.machine, plan.start),
            plan.setpoint,
            reading_noise["extension"],
            CHANNELS["extension"].step,
            self.controller.gains,
            commands,
            states,
        )
        return Measured(
            {"valve_command": commands},
            {"setpoint": plan.setpoint},
            self._signals(truth, states),
            np.ascontiguousarray(states[:: bench.FINE]),
        )


@dataclass(frozen=True)
class Loop:
    """One kind of rig in a closed loop."""

    rig: Callable[[Controller], VirtualRig]
    declared: tuple[Declared, ...]  # what its owner knows of the machine
    said: Controller  # what he believes of the controller


LOOPS: Mapping[str, Loop] = {
    "bench": Loop(ClosedBenchRig, BENCH, Controller()),
    "platform": Loop(ClosedPlatformRig, PLATFORM, PLATFORM_CONTROLLER),
}


def draw_closed(
    seed: int,
    out: Path,
    truth_path: Path,
    effect: str | None = None,
    size: float = 0.0,
    command: bool = True,
    kind: str = "bench",
) -> None:
    """Records of a loop with one thing wrong, or nothing, and a rig file whose controller is simulated.

    effect: an effect of the machine ("piston_leakage") of a given size, or a number of the controller as the rig file
    calls it ("proportional_gain"), wrong by that share. command: whether it is recorded.
    """
    for_rig, _, for_runs = (np.random.default_rng(s) for s in np.random.SeedSequence(seed).spawn(3))
    _, runs = draw_runs(kind, for_runs)
    loop = LOOPS[kind]
    truth = drawn(as_declared(Truth(), loop.declared), loop.declared, (), for_rig)
    controller, hidden = loop.said, []
    if effect in IN_RIG_FILE:
        name, unit = IN_RIG_FILE[effect]
        right = float(getattr(controller, name))
        controller = replace(controller, **{name: (1.0 + size) * right})
        wrong = Effect("controller_mismatch", (), unit, (kind,), 0.0, target=effect, shifts=True)
        hidden.append(Hidden(wrong, size * right, None))
    elif effect is not None:
        of_machine = effects.find(kind, effect)[0]
        truth = of_machine.hidden_in(truth, size)
        hidden.append(Hidden(of_machine, size, None))
    write_trial(Trial(loop.rig(controller), runs, truth, hidden, seed), out, truth_path)
    _state_the_loop(out / "rig.toml", command, loop.said)


def _state_the_loop(path: Path, command: bool, said: Controller) -> None:
    """Adds to a rig file what its owner believes of the controller."""
    text = path.read_text().replace("The command runs straight", "The command is held")
    for line in re.findall(r"^valve_command.*\n", text, re.MULTILINE):
        wanted = line.replace("valve_command", "setpoint")
        text = text.replace(line, wanted + line if command else wanted)
    gains = [
        f"{parameter} = {json.dumps(f'{getattr(said, name):g} {unit}')}\n"
        for parameter, (name, unit) in IN_RIG_FILE.items()
    ]
    gains.append(f'control_period = "{bench.SAMPLE_STEP:g} s"\n')
    text = text.replace("[parameters]\n", "[parameters]\n" + "".join(gains))
    control = '\n[control]\nloop = "closed"\ncontroller = "simulated"\nlaw = "pid"\n'
    path.write_text(text + control)
