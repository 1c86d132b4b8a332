"""What rubs, stops and pulls on one piston rod.

Sliding friction is Coulomb's plus a viscous part; within the creep velocity it is led through zero
by s / (1 + s^4)^(1/4). With a bristle compliance the seal bends first and slides later (LuGre: Canudas de Wit et
al., IEEE Trans. Automatic Control 40, 1995). A lubricant film needs time to build (Tran and
Yanada, 2013): its viscous part then follows the speed late.

There is no static friction beyond Coulomb's. So pressure on the lips and the place in the bore raise Coulomb friction
alone: of pressure-dependent friction these machines have the part `pressure_friction`, and nothing for the core's
`pressure_stiction` to find.
"""

from __future__ import annotations

from math import exp, pi, sin, sqrt

from validation.reference.compiled import compiled
from validation.twins.air import Array
from validation.twins.machine import Machine

SPEED_STEP = 0.01
"""m/s, between two points of an error of friction over the speed."""
TOP_SPEED = 0.5
"""m/s: beyond it the error stays as it is there."""
SPEED_POINTS = 101


@compiled
def dry_strength(p: Machine, time: float, x: float, lower: float, upper: float) -> float:
    """N, what the seals hold or rub with, before any dependence on speed."""
    strength = p.coulomb_force * (1.0 + p.position_friction * (x - 0.5 * p.stroke))
    strength += p.pressure_friction * (lower + upper - 2.0 * p.ambient_pressure)
    if p.scratched_bore != 0.0:
        strength += p.scratched_bore * exp(-0.5 * ((x - p.scratch_centre) / p.scratch_width) ** 2)
    if p.warming_grease != 0.0:
        strength += p.warming_grease * exp(-time / p.warming_time)
    return strength


@compiled
def sliding_way(p: Machine, v: float) -> float:
    """-1 to 1, with the slope 1 / creep_velocity through rest."""
    s = v / p.creep_velocity
    return s / sqrt(sqrt(1.0 + s * s * s * s))


@compiled
def relative_error(over_speed: Array, v: float) -> float:
    """Of the sliding friction at a speed, straight between the points of its curve."""
    place = min(max((v + TOP_SPEED) / SPEED_STEP, 0.0), SPEED_POINTS - 1.001)
    row = int(place)
    return float(over_speed[row] + (place - row) * (over_speed[row + 1] - over_speed[row]))


@compiled
def friction(
    p: Machine,
    over_speed: Array,
    time: float,
    x: float,
    v: float,
    lower: float,
    upper: float,
    seal: Array,
    rates: Array,
) -> float:
    """N against extension; `seal` = (bristle deflection, film speed), its rates into `rates`.

    over_speed: relative error of the friction map (maps.py).
    """
    share = 1.0 + relative_error(over_speed, v)
    strength = dry_strength(p, time, x, lower, upper)
    speed = abs(v)
    if p.exponential_friction_force != 0.0:
        strength += p.exponential_friction_force * (exp(p.exponential_friction_rate * speed) - 1.0)
    strength *= share
    way = sliding_way(p, v)
    if p.friction_lag > 0.0:
        film = float(seal[1])
        rates[1] = (v - film) / p.friction_lag
    else:
        film = v
        rates[1] = 0.0
    if p.bristle_compliance > 0.0:
        bend = strength * p.bristle_compliance
        rates[0] = v - speed * seal[0] / bend
        dry = float(seal[0] / p.bristle_compliance + p.bristle_damping * rates[0])
    else:
        rates[0] = 0.0
        dry = strength * way
    return dry + p.direction_friction * abs(way) + share * p.viscous_friction * film


@compiled
def end_force(p: Machine, x: float, v: float) -> float:
    """N outwards from the ends of the stroke: metal beyond them, a cushion before them."""
    force = 0.0
    left = p.stroke - x
    if x < 0.0:
        force += p.end_stop_stiffness * -x * max(0.0, 1.0 - p.end_stop_damping * v)
    if left < 0.0:
        force -= p.end_stop_stiffness * -left * max(0.0, 1.0 + p.end_stop_damping * v)
    if v < 0.0 and x < p.cushion_length:
        force -= p.cushion_damping * min(1.0, 1.0 - x / p.cushion_length) * v
    if v > 0.0 and left < p.cushion_length:
        force -= p.cushion_damping * min(1.0, 1.0 - left / p.cushion_length) * v
    return force


@compiled
def odd_force(p: Machine, x: float) -> float:
    """N outwards from what no catalogue knows: a bent rod, a dragging cable."""
    bent = p.bent_rod * sin(2.0 * pi * x / p.bent_rod_length)
    return bent - p.dragging_cable * (x - 0.5 * p.stroke)


@compiled
def pressure_force(p: Machine, lower: float, upper: float) -> float:
    """N outwards from the air on both faces and on the rod."""
    bore = 0.25 * pi * p.bore_diameter**2
    ring = bore - 0.25 * pi * p.rod_diameter**2
    return (lower - p.ambient_pressure) * bore - (upper - p.ambient_pressure) * ring
