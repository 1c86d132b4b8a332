"""One pneumatic axis as numbers: what it is, and what can be wrong with it. SI, absolute pressures.

The default is a healthy machine with the published numbers (SPEC.md, sections 3 to 5). A field
under "wrong" that is zero is absent.
"""

from __future__ import annotations

from typing import NamedTuple


class Machine(NamedTuple):
    """One axis; three of them, with the same numbers, carry the platform."""

    # The cylinder.
    bore_diameter: float = 0.100
    rod_diameter: float = 0.025
    stroke: float = 0.400
    moving_mass: float = 3.639
    end_stop_stiffness: float = 5.0e6
    end_stop_damping: float = 2.0
    cushion_length: float = 0.032
    # Friction while sliding, and the speed within which it grows from nothing.
    coulomb_force: float = 38.0
    viscous_friction: float = 530.0
    creep_velocity: float = 2.86e-3
    # Air.
    ambient_pressure: float = 86.0e3
    gas_constant: float = 288.0
    air_temperature: float = 293.0
    kappa: float = 1.4
    inflow_heat_ratio: float = 1.4
    outflow_heat_ratio: float = 1.0
    compression_heat_ratio: float = 1.2
    dead_volume_lower: float = 1.0e-4
    dead_volume_upper: float = 1.0e-4
    tank_volume: float = 5.0e-3
    tank_wall_area: float = 0.17
    # Supply.
    supply_pressure: float = 486.0e3
    reservoir_volume: float = 5.0e-3
    # Valve.
    valve_centre: float = 5.0
    valve_frequency: float = 65.0
    valve_damping_ratio: float = 0.7071067811865476
    mass_flow_gain: float = 1.2

    # Wrong, and known to the catalogue.
    supply_line_resistance: float = 0.0  # Pa s/kg
    valve_leakage: float = 0.0  # m3/(s Pa), each of the four edges
    piston_leakage: float = 0.0  # kg/(s Pa)
    fitting_leakage_lower: float = 0.0  # kg/(s Pa)
    fitting_leakage_upper: float = 0.0  # kg/(s Pa)
    dead_band_change: float = 0.0  # V
    exhaust_flow_change: float = 0.0
    tube_length: float = 0.0  # m
    tube_diameter: float = 7.0e-3  # m
    command_delay: float = 0.0  # s
    heat_transfer_coefficient: float = 0.0  # W/(m2 K); any turns the temperatures into states
    wall_temperature: float = 293.0
    bristle_compliance: float = 0.0  # m/N
    bristle_damping: float = 300.0  # N s/m
    pressure_friction: float = 0.0  # N/Pa
    direction_friction: float = 0.0  # N
    position_friction: float = 0.0  # 1/m
    exponential_friction_force: float = 0.0  # N
    exponential_friction_rate: float = 13.0  # s/m
    friction_lag: float = 0.0  # s, the lubricant film's
    cushion_damping: float = 0.0  # N s/m

    # How what leaks flows, over the ratio of pressures: as the source has it, or a law of the imperfection.
    leak_critical_ratio: float = 0.0
    leak_exponent: float = (
        0.0  # 0.5 turbulent, 1 laminar; 0: proportional, and past the valve's lands a labyrinth
    )

    # Wrong, and in no catalogue.
    clogging_silencer: float = 0.0  # share of the exhaust's conductance lost now and then
    clog_period: float = 1.7  # s
    bent_rod: float = 0.0  # N, a force that repeats along the stroke
    bent_rod_length: float = 0.05  # m
    scratched_bore: float = 0.0  # N, more friction at one place
    scratch_centre: float = 0.20  # m
    scratch_width: float = 0.012  # m
    warming_grease: float = 0.0  # N of friction that is gone after a while
    warming_time: float = 4.0  # s
    pulsating_supply: float = 0.0  # Pa
    pulsation_frequency: float = 1.3  # Hz
    sticky_spool: float = 0.0  # V of play between command and spool
    dragging_cable: float = 0.0  # N/m, a spring towards mid-stroke
    check_valve_leak: float = 0.0  # kg/(s Pa) out of the lower chamber above its opening pressure
    check_valve_pressure: float = 2.6e5  # Pa absolute


class Body(NamedTuple):
    """What the platform carries, and what is wrong with the mechanism."""

    payload_mass: float = 255.08
    payload_cog_x: float = 0.0
    payload_cog_y: float = 0.0
    payload_cog_z: float = -1.3922
    panhard_friction: float = 0.0  # N m s/rad, of the joints of each rod
    backlash: float = 0.0  # m, play between a rod and its position sensor
    frame_compliance: float = 0.0  # m/N, of what each actuator stands on
    # By how much it is not built as drawn, m: joints, and links longer than their joints are apart at rest.
    base_joint_2_y_error: float = 0.0
    platform_joint_1_x_error: float = 0.0
    base_joint_5_z_error: float = 0.0
    actuator_3_length_error: float = 0.0
    panhard_2_length_error: float = 0.0
