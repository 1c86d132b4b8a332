"""The platform under the published controller by CasADi: its equations as expressions, CVODES in time.

    python -m validation.speed.simulators.with_casadi < TASK.json > RESULT.json

What a user of CasADi writes: where the ten bodies are, whose derivatives make the equations of
motion (in six coordinates of the platform, the Panhard rods' three constraints eliminated), the
air of three cylinders, one integrator call a control period. The two implicit parts, yaw, x and y
of the pose and the accelerations that friction depends on, are Newton steps from where they were
at the last sample. CVODES runs with Adams' formulas and functional iteration: without Jacobians,
which cost it more here than steps.
"""

from __future__ import annotations

import json
import sys
import time
from typing import Any, TypedDict

import casadi as ca
import numpy as np

POSE_STEPS, BALANCE_STEPS = 2, 5  # Newton's; from one sample to the next both are near
ACTIVE = ("P_LOWER", "P_UPPER", "SPOOL", "SPOOL_RATE")  # of an actuator, in the published laws
LAMINAR = 0.999
TOLERANCES = (1e-7, 1e-8, 1e-9, 1e-10, 1e-11)  # of CVODES, in states over their scale
ROUNDS = 2


class CasadiTask(TypedDict):
    """All numbers of the plant, SI; arrays as nested lists."""

    numbers: dict[str, float]  #: by the names of params.def
    mechanism: dict[str, Any]  #: the fields of validation.reference.plants.mechanism.Mechanism
    valve: list[list[float]]  #: validation.reference.plants.flow.valve_map
    control: list[float]  #: gain, dead-band step, sharpness, offset, period
    start: list[float]  #: roll, pitch, height, their rates, then ACTIVE of each actuator
    scale: list[float]  #: magnitudes of these states
    setpoint: list[list[float]]  #: m, (n, 3)
    exact: list[list[float]]  #: extensions, m, (n, 3)
    wanted: float  #: m, largest error that is accurate enough


class CasadiResult(TypedDict):
    """A run that is accurate enough, or as near as CVODES comes."""

    software: str
    tolerance: float
    error: float  #: m
    milliseconds: float  #: of the whole run


class Model:
    """The derivative of the plant, and what the controller sees of it, as CasADi functions."""

    def __init__(self, task: CasadiTask) -> None:
        self.p = task["numbers"]
        self.m = {k: np.asarray(v, dtype=np.float64) for k, v in task["mechanism"].items()}
        self.map = np.asarray(task["valve"])
        self.scale = np.asarray(task["scale"])
        state, command = ca.SX.sym("state", 18), ca.SX.sym("command", 3)
        memory = ca.SX.sym("memory", 6)  # yaw, x, y and the pistons' accelerations at the sample
        rate, pose, extension, a = self.derivative(state * self.scale, command, memory)
        parameters = ca.vertcat(command, memory)
        self.ode = {"x": state, "p": parameters, "ode": ca.cse(rate / self.scale)}
        self.seen = ca.Function("seen", [state, memory], [extension])
        self.after = ca.Function("after", [state, parameters], [ca.vertcat(pose, a)])

    def derivative(self, y: ca.SX, command: ca.SX, memory: ca.SX) -> tuple[ca.SX, ...]:
        """Rates, the pose (yaw, x, y), extensions and the pistons' accelerations."""
        q, rates = y[:3], y[3:6]
        mass, bias, slope, extension, extension_bias, pose = self.mechanics(q, rates, memory[:3])
        speed = slope @ rates
        force, air = [], []
        for i in range(3):
            own = y[6 + 4 * i : 10 + 4 * i]
            air.append(self.air_rates(own, extension[i], speed[i], command[i]))
            force.append(self.rod_drive(own, extension[i], speed[i]))
        back = ca.inv(slope)
        along = back.T @ mass @ back
        drive = ca.vertcat(*force) - back.T @ bias + along @ extension_bias
        a = self.balance(along, drive, speed, memory[3:])
        return ca.vertcat(rates, back @ (a - extension_bias), *air), pose, extension, a

    # ---- mechanism ----

    def mechanics(self, q: ca.SX, rates: ca.SX, guess: ca.SX) -> tuple[ca.SX, ...]:
        """M, b, extensions' slope, extensions, their bias in q = (roll, pitch, height); the pose."""
        x, v = ca.SX.sym("x", 6), ca.SX.sym("v", 6)  # roll, pitch, height, yaw, x, y
        links, mass, inertial = self.bodies(x, v)
        length = ca.vertcat(*[ca.norm_2(link) for link in links])
        rods = 0.5 * (length[3:] ** 2 - ca.DM(self.m["length"][3:] ** 2))
        slopes = ca.jacobian(rods, x)
        solved = -ca.inv(slopes[:, 3:]) @ ca.horzcat(slopes[:, :3], rods)
        follow, newton = solved[:, :3], solved[:, 3]
        extension = length[:3] - ca.DM(self.m["length"][:3])

        # second rates at q'' = 0, and the equations of motion seen through those of q
        q_rate = ca.SX.sym("q_rate", 3)
        second = ca.jtimes(follow @ q_rate, x, v)
        e_slope = ca.jacobian(extension, x)
        e_second = ca.jtimes(e_slope @ v, x, v)
        map_ = ca.vertcat(ca.SX.eye(3), follow)
        bias = map_.T @ (inertial + mass @ ca.vertcat(ca.SX.zeros(3), second))
        e_bias = e_second + e_slope @ ca.vertcat(ca.SX.zeros(3), second)
        make = [map_.T @ mass @ map_, bias, e_slope @ map_, extension, e_bias]
        at = ca.Function("mechanics", [x, v, q_rate], make)
        step = ca.Function("step", [x], [newton])
        turn = ca.Function("follow", [x], [follow])

        pose = guess
        for _ in range(POSE_STEPS):
            pose = pose + step(ca.vertcat(q, pose))
        whole = ca.vertcat(q, pose)
        return (*at(whole, ca.vertcat(rates, turn(whole) @ rates), rates), pose)

    def bodies(self, x: ca.SX, v: ca.SX) -> tuple[list[ca.SX], ca.SX, ca.SX]:
        """Links B to P; mass matrix and bias in the six coordinates, by virtual power."""
        m = self.m
        turn = rotation(x[0], x[1], x[3])
        point = ca.vertcat(x[4], x[5], -x[2])
        matrix, bias, links = ca.SX.zeros(6, 6), ca.SX.zeros(6), []

        def add(axes: ca.SX, cog: ca.SX, mass: float, inertia: Any) -> None:
            nonlocal matrix, bias
            moves = ca.jacobian(cog, x)
            changes = [ca.jtimes(axes[:, k], x, v) for k in range(3)]
            omega = 0.5 * sum((ca.cross(axes[:, k], changes[k]) for k in range(3)), ca.SX.zeros(3))
            turns = ca.jacobian(omega, v)
            world = axes @ ca.DM(inertia) @ axes.T
            force = mass * (ca.jtimes(moves @ v, x, v) - ca.vertcat(0.0, 0.0, float(m["gravity"])))
            moment = world @ ca.jtimes(omega, x, v) + ca.cross(omega, world @ omega)
            matrix += mass * moves.T @ moves + turns.T @ world @ turns
            bias += moves.T @ force + turns.T @ moment

        cog = point + turn @ ca.DM(m["platform_cog"])
        add(turn, cog, float(m["platform_mass"]), m["platform_inertia"])
        for i in range(6):
            link = point + turn @ ca.DM(m["joint"][i]) - ca.DM(m["base"][i])
            links.append(link)
            n = link / ca.norm_2(link)
            across = ca.cross(n, ca.DM(m["ground_axis"][i]))
            across = across / ca.norm_2(across)
            axes = ca.horzcat(ca.cross(across, n), across, n)
            hung = ca.DM(m["base"][i]) + axes @ ca.DM(m["hung_cog"][i])
            add(axes, hung, float(m["hung_mass"][i]), m["hung_inertia"][i])
            if i < 3:
                slid = ca.DM(m["base"][i]) + link + axes @ ca.DM(m["slid_cog"][i])
                add(axes, slid, float(m["slid_mass"][i]), m["slid_inertia"][i])
        return links, matrix, bias

    # ---- friction ----

    def balance(self, mass: ca.SX, drive: ca.SX, speed: ca.SX, guess: ca.SX) -> ca.SX:
        """a of mass a + F_f(v, a) = drive, eq. 6.5 to 6.7, by Newton's method."""
        p, a = self.p, guess
        ramp = ca.if_else(
            ca.fabs(speed) < p["stiction_velocity"],
            ca.sin(0.5 * np.pi * speed / p["stiction_velocity"]),
            ca.sign(speed),
        )
        coulomb = ramp * p["coulomb_force"] + ca.fabs(ramp) * p["viscous_friction"] * speed
        rise = ramp * (p["stiction_force"] - p["coulomb_force"])
        for _ in range(BALANCE_STEPS):
            width = p["stribeck_velocity"] * p["stribeck_acceleration_factor"] * ca.fabs(a)
            width = ca.fmax(width, 1e-6 * ca.fabs(speed) + 1e-12)
            power = (ca.fabs(speed) / width) ** p["stribeck_exponent"]
            fall = ca.if_else(speed * a > 0.0, ca.exp(-power), 0.0)
            slope = rise * fall * p["stribeck_exponent"] * power / (ca.fabs(a) + 1e-12)
            off = drive - mass @ a - coulomb - rise * fall
            a = a + ca.inv(mass + ca.diag(slope * ca.sign(a))) @ off
        return a

    # ---- air ----

    def air_rates(self, y: ca.SX, extension: ca.SX, speed: ca.SX, command: ca.SX) -> ca.SX:
        """Rates of ACTIVE."""
        p = self.p
        lower, upper, spool, spool_rate = y[0], y[1], y[2], y[3]
        opening = spool - p["valve_centre"]
        (c_in, b_in, m_in), (c_out, b_out, m_out) = self.edges(ca.fabs(opening))
        gain, supply, outside = p["mass_flow_gain"], p["supply_pressure"], p["ambient_pressure"]
        up = opening >= 0.0
        fed, vented = ca.if_else(up, lower, upper), ca.if_else(up, upper, lower)
        into = gain * self.flow(c_in, b_in, m_in, supply, fed)
        out = -gain * self.flow(c_out, b_out, m_out, vented, outside)
        bore = 0.25 * np.pi * p["bore_diameter"] ** 2
        ring = bore - 0.25 * np.pi * p["rod_diameter"] ** 2
        rooms = (
            (lower, ca.if_else(up, into, out), p["dead_volume_lower"] + bore * extension, bore),
            (
                upper,
                ca.if_else(up, out, into),
                p["dead_volume_upper"] + ring * (p["stroke"] - extension),
                -ring,
            ),
        )
        rates = []
        for pressure, flow, volume, area in rooms:
            ratio = ca.if_else(flow > 0.0, p["inflow_heat_ratio"], p["outflow_heat_ratio"])
            work = p["compression_heat_ratio"] * pressure * area * speed
            heat = p["gas_constant"] * ratio * flow * p["air_temperature"]
            rates.append((heat - work) / volume)
        omega = 2.0 * np.pi * p["valve_frequency"]
        wanted = ca.fmin(10.0, ca.fmax(0.0, command))
        turning = omega**2 * (wanted - spool) - 2.0 * p["valve_damping_ratio"] * omega * spool_rate
        return ca.vertcat(*rates, spool_rate, turning)

    def edges(self, distance: ca.SX) -> tuple[tuple[ca.SX, ...], tuple[ca.SX, ...]]:
        """C, b, m of the port that is fed and of the one that is vented; Steffen's pieces."""
        p, rows = self.p, self.map
        there = ca.vertcat(*[distance >= float(v) for v in rows[1:, 0]])
        piece = ca.DM(rows[0]) + ca.DM(np.diff(rows, axis=0).T) @ there
        beyond = ca.fmax(distance - piece[0], 0.0)
        below = ca.fmin(distance / float(rows[0, 0]), 1.0)
        values = []
        for k in range(6):
            a, b, c, d = (piece[1 + 4 * k + j] for j in range(4))
            values.append(((a * beyond + b) * beyond + c) * beyond + d)
        values[0] *= below * 1.4 / p["inflow_heat_ratio"]
        values[3] *= below * 1.0 / p["outflow_heat_ratio"]
        return tuple(values[:3]), tuple(values[3:])

    def flow(self, c: ca.SX, b: ca.SX, m: ca.SX, first: Any, second: Any) -> ca.SX:
        """kg/s from the first pressure to the second, eq. 5.8 and 5.9."""
        p = self.p
        high, low = ca.fmax(first, second), ca.fmin(first, second)
        ratio = low / high
        held = ca.fmin(ratio, LAMINAR)
        part = ca.fmax((held - b) / (1.0 - b), 1e-9)
        phi = ca.if_else(held <= b, 1.0, ca.sqrt(1.0 - part**m))
        phi *= ca.fmin((1.0 - ratio) / (1.0 - LAMINAR), 1.0)
        warm = np.sqrt(p["reference_temperature"] / p["air_temperature"])
        return ca.sign(first - second) * high * c * p["reference_density"] * warm * phi

    def rod_drive(self, y: ca.SX, extension: ca.SX, speed: ca.SX) -> ca.SX:
        """N outwards: gas and ends of the stroke."""
        p = self.p
        bore, rod = (0.25 * np.pi * p[f"{name}_diameter"] ** 2 for name in ("bore", "rod"))
        gas = y[0] * bore - y[1] * (bore - rod) - p["ambient_pressure"] * rod

        def contact(depth: ca.SX, rate: ca.SX) -> ca.SX:
            bracket = ca.fmax(0.0, 1.0 + p["end_stop_damping"] * rate)
            return p["end_stop_stiffness"] * ca.fmax(depth, 0.0) * bracket

        return gas + contact(-extension, -speed) - contact(extension - p["stroke"], speed)


def rotation(roll: ca.SX, pitch: ca.SX, yaw: ca.SX) -> ca.SX:
    """Rz(yaw) Ry(pitch) Rx(roll)."""
    cr, sr, cp, sp, cy, sy = (f(a) for a in (roll, pitch, yaw) for f in (ca.cos, ca.sin))
    return ca.vertcat(
        ca.horzcat(cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr),
        ca.horzcat(sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr),
        ca.horzcat(-sp, cp * sr, cp * cr),
    )


def closed_loop(model: Model, task: CasadiTask, tolerance: float) -> Any:
    """A function of start and setpoints, (18,) and (3, n), that gives extensions (3, n)."""
    gain, step, sharpness, offset, period = task["control"]
    options = {
        "reltol": tolerance,
        "abstol": tolerance,
        "linear_multistep_method": "adams",
        "nonlinear_solver_iteration": "functional",
    }
    integrator = ca.integrator("period", "cvodes", model.ode, 0.0, period, options)
    whole, setpoint = ca.MX.sym("whole", 24), ca.MX.sym("setpoint", 3)
    state, memory = whole[:18], whole[18:]
    extension = model.seen(state, memory)
    u = ca.fmin(5.0, ca.fmax(-5.0, gain * (setpoint - extension)))
    lift = (5.0 - 2.0 / np.pi * step * np.arctan(5.0 * sharpness)) / 5.0
    over = lift * u + 2.0 / np.pi * step * ca.atan(sharpness * u)
    parameters = ca.vertcat(ca.fmin(10.0, ca.fmax(0.0, offset + over)), memory)
    end = integrator(x0=state, p=parameters)["xf"]
    after = ca.vertcat(end, model.after(end, parameters))
    one = ca.Function("one", [whole, setpoint], [after, extension])
    return one.mapaccum(len(task["setpoint"]))


def answer(task: CasadiTask) -> CasadiResult:
    """The run at the largest tolerance that is accurate enough."""
    model = Model(task)
    exact, setpoint = np.asarray(task["exact"]), np.asarray(task["setpoint"]).T
    reference = np.asarray(task["mechanism"]["reference"])
    begin = ca.vertcat(np.asarray(task["start"]) / model.scale, 0.0, reference[:2], np.zeros(3))
    for _ in range(5):  # the pose and the accelerations at the start
        held = ca.vertcat(np.full(3, task["control"][3]), begin[18:])
        begin[18:] = model.after(begin[:18], held)
    for tolerance in TOLERANCES:
        run = closed_loop(model, task, tolerance)
        error = float(np.max(np.abs(np.asarray(run(begin, setpoint)[1]).T - exact)))
        if error <= task["wanted"] or tolerance == TOLERANCES[-1]:
            seconds = min(timed(lambda f=run: f(begin, setpoint)) for _ in range(ROUNDS))
            return CasadiResult(
                software=f"CasADi {ca.__version__}, CVODES",
                tolerance=tolerance,
                error=error,
                milliseconds=1e3 * seconds,
            )
    raise AssertionError("unreachable")


def timed(work: Any) -> float:
    """Seconds of one call."""
    start = time.perf_counter()
    work()
    return time.perf_counter() - start


if __name__ == "__main__":
    json.dump(answer(json.load(sys.stdin)), sys.stdout)
