"""What the project computes for each reference file of single equations: one function a file.

A case holds named inputs, over the parameters that the file gives for all; a function returns the
outputs that the file names. Nothing is computed here that the core has: this is only the mapping
of names and units.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp
from sms import _core

Case = Mapping[str, Any]
Outputs = Mapping[str, Any]

HALF_STROKE = 0.5 * _core.Params().stroke  #: the files count from mid-stroke, the project from 0
KELVIN = 273.15


def alpha_beta(case: Case) -> Outputs:
    """alpha_beta.json: the filter of sections 5.3.1 and 6.3."""
    value, rate = _core.alpha_beta(
        case["y"], case["dt"], case["alpha"], case["beta"], case["x0"], case["v0"]
    )
    return {"x": value, "v": rate}


def chamber(case: Case) -> Outputs:
    """chamber.json: eq. 4.31 and 4.32."""
    cylinder = _core.Params(
        dead_volume_lower=case["v_dead"],
        dead_volume_upper=case["v_dead"],
        inflow_heat_ratio=case["a_in"],
        outflow_heat_ratio=case["a_out"],
        compression_heat_ratio=case["a"],
    )
    side = "lower" if case["side"] == "a" else "upper"
    extension = HALF_STROKE + case["x"]
    return {
        "pdot_Pa_s": _core.chamber_pressure_rate(
            cylinder, side, case["p"], extension, case["v"], case["m_in"], case["m_out"]
        ),
        "volume_m3": _core.chamber_volume(cylinder, side, extension),
    }


def chirp(case: Case) -> Outputs:
    """chirp.json: eq. 7.3."""
    sweep = (case["f1"], case["f2"], case["t_target"])
    return {
        "x": _core.chirp(case["t"], case["A"], *sweep),
        "f_inst": _core.chirp_frequency(case["t"], *sweep),
    }


def classic_mass_flow(case: Case) -> Outputs:
    """classic_mass_flow.json: eq. 4.20 to 4.22."""
    orifice = _core.Params(
        discharge_coefficient=case["C_d"],
        heat_capacity_ratio=case["kappa"],
        gas_constant=case["R"],
    )
    pressures = (case["p_from_Pa"], case["p_to_Pa"])
    flow = _core.classic_mass_flow(orifice, case["area_m2"], *pressures, case["T_K"])
    return {"mdot_kg_s": flow}


def deadband(case: Case) -> Outputs:
    """deadband.json: eq. 7.5 to 7.7."""
    compensation = _core.Params(dead_band_step=case["b"], dead_band_sharpness=case["c"])
    return {
        "a": _core.dead_band_coefficient(compensation),
        "V_o": _core.over_dead_band(compensation, case["V_i"]),
        "gain": _core.dead_band_gain(compensation, case["V_i"]),
    }


def friction(case: Case) -> Outputs:
    """friction.json: eq. 6.5 to 6.7 (F_N) and 4.33 (F_433_N)."""
    cylinder = _core.Params(
        stiction_force=case["F_S"],
        coulomb_force=case["F_C1"],
        coulomb_force_deceleration_change=case["F_C2"] - case["F_C1"],
        viscous_friction=case["sigma1"],
        viscous_friction_deceleration_change=case["sigma2"] - case["sigma1"],
        stribeck_velocity=case["v_S"],
        stribeck_exponent=case["delta"],
        stribeck_acceleration_factor=case["zeta"],
        exponential_friction_rate=case["gamma_f"],
        exponential_friction_force=case["F_UE"],
        stiction_velocity=case["eps_f"],
    )
    ambient = cylinder.ambient_pressure
    return {
        "F_N": _core.friction(cylinder, 0.0, case["v"], case["a"], ambient, ambient),
        "F_433_N": _core.friction_stribeck(cylinder, case["v"]),
    }


def iso_mass_flow(case: Case) -> Outputs:
    """iso_mass_flow.json: eq. 5.8 and 5.9."""
    air = _core.Params(reference_density=case["rho0"], reference_temperature=case["T0_K"])
    component = (case["C"], case["b"], case["m"])
    pressures = (case["p_from_Pa"], case["p_to_Pa"])
    return {"mdot_kg_s": _core.iso_mass_flow(air, *component, *pressures, case["T_K"])}


def pid(case: Case) -> Outputs:
    """pid.json: eq. 7.4, no limit."""
    settings = _core.Params(
        proportional_gain=case["G_P"],
        integral_gain=case["G_I"],
        derivative_gain=case["G_D"],
        differentiator_corner=case["N"],
        control_period=case["T_s"],
    )
    return {"u": _core.pid(settings, case["e"], limit=np.inf)}


def simplified_closed_loop(case: Case) -> Outputs:
    """simplified_closed_loop.json: eq. 8.4; poles by rising real part, then imaginary part."""
    plant = (case["C_0"], case["omega_s"], case["zeta"])
    loop = _core.closed_loop(*plant, case["K_p"])
    amplitude, phase = _core.frequency_response(*loop, 1.0)
    poles = sorted(_core.poles(*loop), key=lambda s: (s.real, s.imag))
    return {
        "stable": _core.is_stable(*loop),
        "poles": [[s.real, s.imag] for s in poles],
        "gain_db_1Hz": 20.0 * np.log10(amplitude),
        "phase_deg_1Hz": np.rad2deg(phase),
        "K_p_limit": _core.largest_stable_gain(*plant),
    }


def simplified_plant(case: Case) -> Outputs:
    """simplified_plant.json: eq. 8.2 and 8.3."""
    cylinder = _core.Params(viscous_friction=case["b"])
    natural_frequency, damping_ratio = _core.simplified_plant(cylinder, case["p_mean"], case["m"])
    return {
        "omega_s": natural_frequency,
        "zeta": damping_ratio,
        "c_N_m": _core.air_spring(cylinder, case["p_mean"]),
    }


def sonic_conductance(case: Case) -> Outputs:
    """sonic_conductance.json: eq. 5.10."""
    orifice = _core.Params(discharge_coefficient=case["C_d"])
    return {"C": _core.sonic_conductance(orifice, case["area_m2"])}


def state_feedback_gains(case: Case) -> Outputs:
    """state_feedback_gains.json: eq. 8.8 to 8.10 as printed and exact, 8.13 to 8.15."""
    plant = (case["C_0"], case["omega_s"], case["zeta"])
    if case["method"] == "situm":
        printed = _core.gains_situm(*plant, case["alpha"], as_printed=True)
        exact = _core.gains_situm(*plant, case["alpha"])
    else:
        printed = exact = _core.gains_specification_based(*plant, case["alpha"])
    stable = _core.is_stable(*_core.closed_loop(*plant, *printed))
    return {"printed": printed, "exact": exact, "routh_printed": stable}


def tank(case: Case) -> Outputs:
    """tank.json: eq. 5.5 with 5.8, the row of the table that the spool names."""
    law = {"table_5_1.csv": "iso_0_2_mpa", "table_5_2.csv": "iso_0_4_mpa"}[case["table"]]
    table = _core.valve_table(law)
    opening = table["opening"][np.argmin(np.abs(table["spool"] - 1e-3 * case["spool_mm"]))]
    charging = case["direction"] == "charge"
    vessel = _core.Params(tank_volume=case["V_m3"])
    component = (_core.charge_flow if charging else _core.discharge_flow)(vessel, opening, law)
    # C stays the table's while the tank is computed with the ratio asked for.
    ratio = "inflow_heat_ratio" if charging else "outflow_heat_ratio"
    vessel[ratio] = case["alpha"]
    outside, start = case["p_s_Pa"], case["p_amb_Pa"]
    if not charging:
        outside, start = start, outside

    def rate(_time: float, pressure: Any) -> Any:
        return _core.tank_pressure_rate(vessel, *component, pressure, outside)

    solution = solve_ivp(
        rate, (0.0, case["t_s"][-1]), [start], "LSODA", case["t_s"], rtol=1e-9, atol=1e-3
    )
    return {"p_Pa": solution.y[0]}


def thermocouple_k(case: Case) -> Outputs:
    """thermocouple_k.json: eq. 5.11 and 5.12, in degC."""
    cold_junction = KELVIN + case["t_cj"]
    kelvin = _core.thermocouple_temperature(_core.Params(), case["volts"], cold_junction)
    return {"T_C": kelvin - KELVIN}


def valve_spool_area(case: Case) -> Outputs:
    """valve_spool_area.json: eq. 4.1, 4.2 and 4.4."""
    valve = _core.Params()
    spool = _core.spool_cubic(valve, case["V"])
    return {
        "spool_mm": 1e3 * spool,
        "spool_linear_mm": 1e3 * _core.spool_linear(valve, case["V"]),
        "area_m2": _core.orifice_area(valve, spool),
    }


IMPLEMENTED: Mapping[str, Callable[[Case], Outputs]] = {
    model.__name__: model
    for model in (
        alpha_beta,
        chamber,
        chirp,
        classic_mass_flow,
        deadband,
        friction,
        iso_mass_flow,
        pid,
        simplified_closed_loop,
        simplified_plant,
        sonic_conductance,
        state_feedback_gains,
        tank,
        thermocouple_k,
        valve_spool_area,
    )
}
