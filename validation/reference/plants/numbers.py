"""The parameters that these plants read: the names of params.def, the values of whoever asks."""

from __future__ import annotations

from typing import NamedTuple

from sms import Params


class Numbers(NamedTuple):
    """One actuator, its valve and the tank; SI."""

    ambient_pressure: float
    bore_diameter: float
    rod_diameter: float
    stroke: float
    moving_mass: float
    coulomb_force: float
    coulomb_force_deceleration_change: float
    stiction_force: float
    viscous_friction: float
    viscous_friction_deceleration_change: float
    stribeck_velocity: float
    stribeck_exponent: float
    stribeck_acceleration_factor: float
    exponential_friction_force: float
    exponential_friction_rate: float
    stiction_velocity: float
    pressure_friction: float
    pressure_stiction: float
    direction_friction: float
    position_friction: float
    gas_constant: float
    heat_capacity_ratio: float
    air_temperature: float
    reference_density: float
    reference_temperature: float
    air_viscosity: float
    supply_pressure: float
    reservoir_volume: float
    supply_line_resistance: float
    supply_line_turbulence: float
    valve_centre: float
    valve_frequency: float
    valve_damping_ratio: float
    spool_cubic_3: float
    spool_cubic_2: float
    spool_cubic_1: float
    spool_cubic_0: float
    spool_limit: float
    barrel_diameter: float
    port_width: float
    land_width: float
    port_angle: float
    port_count: float
    discharge_coefficient: float
    mass_flow_gain: float
    valve_leakage: float
    leakage_critical_ratio: float
    leakage_index: float
    dead_band_change: float
    exhaust_flow_change: float
    dead_volume_lower: float
    dead_volume_upper: float
    inflow_heat_ratio: float
    outflow_heat_ratio: float
    compression_heat_ratio: float
    heat_transfer_coefficient: float
    wall_temperature: float
    piston_leakage: float
    piston_leakage_index: float
    chamber_leakage_lower: float
    chamber_leakage_index_lower: float
    chamber_leakage_upper: float
    chamber_leakage_index_upper: float
    tube_length: float
    tube_diameter: float
    tube_loss_factor: float
    tank_volume: float
    tank_wall_area: float
    bristle_stiffness: float
    bristle_damping: float
    breakaway_ratio: float
    end_stop_stiffness: float
    end_stop_damping: float
    cushion_length: float
    cushion_damping: float


def numbers_of(params: Params) -> Numbers:
    """The same machine."""
    return Numbers(*(float(getattr(params, name)) for name in Numbers._fields))
