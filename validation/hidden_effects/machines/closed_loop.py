"""The bench under a sampled position controller, its command held from one sample to the next.

Parallel PID (eq. 7.4 of the source by the bilinear transform), a step over the dead band (eq. 7.5), clipped to the
valve's range. The controller reads the converter that the logger reads, at the same instants. What its owner
believes of it stands in the rig file; what it really does may be something else.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import atan, pi
from pathlib import Path

import numpy as np

from validation.compiled import compiled
from validation.hidden_effects.machines import bench, effects
from validation.hidden_effects.machines.air import Array, valve_map
from validation.hidden_effects.machines.bench_rig import BenchRig
from validation.hidden_effects.machines.declared import BENCH, as_declared, drawn
from validation.hidden_effects.machines.draw import Hidden, Trial, draw_runs, write_trial
from validation.hidden_effects.machines.effects import Effect
from validation.hidden_effects.machines.instruments import CHANNELS
from validation.hidden_effects.machines.machine import Machine
from validation.hidden_effects.machines.measured import Measured
from validation.hidden_effects.machines.truth import Truth


@dataclass(frozen=True)
class Controller:
    """Numbers of the controller, SI."""

    proportional: float = 12.0  # V/m
    integral: float = 5.0  # V/(m s)
    derivative: float = 0.2  # V s/m
    corner: float = 60.0  # rad/s, of the derivative's filter
    step: float = 0.5  # V, over the dead band
    sharpness: float = 20.0  # 1/V


IN_RIG_FILE = {
    "proportional_gain": ("proportional", "V/m"),
    "integral_gain": ("integral", "V/(m s)"),
    "derivative_gain": ("derivative", "V s/m"),
    "differentiator_corner": ("corner", "rad/s"),
    "dead_band_step": ("step", "V"),
    "dead_band_sharpness": ("sharpness", "1/V"),
}
"""Name in the rig file -> that of Controller, unit."""


@compiled
def run(
    p: Machine,
    map_: Array,
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
    proportional, integral, derivative, corner, step, sharpness = gains
    period = bench.SAMPLE_STEP
    dt = period / bench.STEPS
    every = bench.STEPS // bench.FINE
    late = p.command_delay + p.tube_length / np.sqrt(p.kappa * p.gas_constant * p.air_temperature)
    scale = (5.0 - 2.0 * step / pi * atan(5.0 * sharpness)) / 5.0
    k1, k2 = np.zeros(bench.STATES), np.zeros(bench.STATES)
    k3, k4 = np.zeros(bench.STATES), np.zeros(bench.STATES)
    error, sum_, slope = setpoint[0] - y[0], 0.0, 0.0
    states[0] = y
    for k in range(setpoint.size):
        before = error
        error = setpoint[k] - np.round((y[0] + noise[k]) / count) * count
        sum_ += 0.5 * period * (error + before)
        slope = ((2.0 - corner * period) * slope + 2.0 * corner * (error - before)) / (
            2.0 + corner * period
        )
        u = min(5.0, max(-5.0, proportional * error + integral * sum_ + derivative * slope))
        u = scale * u + 2.0 * step / pi * atan(sharpness * u)
        commands[k] = min(10.0, max(0.0, 5.0 + u))
        if k == setpoint.size - 1:
            return
        for i in range(bench.STEPS):
            sent = k + int(np.floor((i * dt - late) / period + 1e-9))
            u = commands[sent] if sent >= 0 else 5.0
            now = k * period + i * dt
            bench.derivative(p, now, map_, y, 0.0, u, k1)
            bench.derivative(p, now + 0.5 * dt, map_, y + 0.5 * dt * k1, 0.0, u, k2)
            bench.derivative(p, now + 0.5 * dt, map_, y + 0.5 * dt * k2, 0.0, u, k3)
            bench.derivative(p, now + dt, map_, y + dt * k3, 0.0, u, k4)
            y += dt / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
            if (i + 1) % every == 0:
                states[k * bench.FINE + (i + 1) // every] = y


class ClosedBenchRig(BenchRig):
    """The bench with a controller; its owner believes it to be Controller()."""

    title = "Virtual pneumatic actuator in its position loop"

    def __init__(self, controller: Controller) -> None:
        self.controller = controller

    def measure(
        self, truth: Truth, plan: bench.Plan, reading_noise: Mapping[str, Array]
    ) -> Measured:
        """One run; for a sensor of the extension without errors, which is also the controller's."""
        c, count = self.controller, plan.setpoint.size
        commands = np.zeros(count)
        states = np.zeros(((count - 1) * bench.FINE + 1, bench.STATES))
        run(
            truth.machine,
            valve_map(),
            bench.balanced(truth.machine, plan.start),
            plan.setpoint,
            reading_noise["extension"],
            CHANNELS["extension"].step,
            np.array([c.proportional, c.integral, c.derivative, c.corner, c.step, c.sharpness]),
            commands,
            states,
        )
        return Measured(
            {"valve_command": commands},
            {"setpoint": plan.setpoint},
            self._signals(truth, states),
            np.ascontiguousarray(states[:: bench.FINE]),
        )


def draw_closed(
    seed: int,
    out: Path,
    truth_path: Path,
    effect: str | None = None,
    size: float = 0.0,
    command: bool = True,
) -> None:
    """Records of a loop with one thing wrong, or nothing, and a rig file whose controller is simulated.

    effect: an effect of the machine ("piston_leakage") of a given size, or a number of the controller as the rig file
    calls it ("proportional_gain"), wrong by that share. command: whether it is recorded.
    """
    for_rig, _, for_runs = (np.random.default_rng(s) for s in np.random.SeedSequence(seed).spawn(3))
    _, runs = draw_runs("bench", for_runs)
    truth = drawn(as_declared(Truth(), BENCH), BENCH, (), for_rig)
    controller, hidden = Controller(), []
    if effect in IN_RIG_FILE:
        name, unit = IN_RIG_FILE[effect]
        right = float(getattr(controller, name))
        controller = replace(controller, **{name: (1.0 + size) * right})
        wrong = Effect("controller_mismatch", (), unit, ("bench",), 0.0, target=effect, shifts=True)
        hidden.append(Hidden(wrong, size * right, None))
    elif effect is not None:
        of_machine = effects.find("bench", effect)[0]
        truth = of_machine.hidden_in(truth, size)
        hidden.append(Hidden(of_machine, size, None))
    write_trial(Trial(ClosedBenchRig(controller), runs, truth, hidden, seed), out, truth_path)
    _state_the_loop(out / "rig.toml", command)


def _state_the_loop(path: Path, command: bool) -> None:
    """Adds to a rig file what its owner believes of the controller."""
    text = path.read_text().replace("[signals]\n", '[signals]\nsetpoint = "setpoint"\n')
    text = text.replace("The command runs straight", "The command is held")
    if not command:
        text = text.replace('valve_command = "valve_command"\n', "")
    said = Controller()
    gains = [
        f"{parameter} = {json.dumps(f'{getattr(said, name):g} {unit}')}\n"
        for parameter, (name, unit) in IN_RIG_FILE.items()
    ]
    gains.append(f'control_period = "{bench.SAMPLE_STEP:g} s"\n')
    text = text.replace("[parameters]\n", "[parameters]\n" + "".join(gains))
    control = '\n[control]\nloop = "closed"\ncontroller = "simulated"\nlaw = "pid"\n'
    path.write_text(text + control)
