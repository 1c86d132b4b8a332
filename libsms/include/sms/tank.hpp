// The tank of the flow test as a plant (dissertation, section 5.2): a vessel of constant volume behind one port of the
// valve, charged from the supply while the spool is above its centre, vented below it.
//
//   p' = R / V (alpha_i m_in' T - alpha_o m_out' T)                                              (eq. 5.5, 5.15)
//
// or, with the full energy equation, pressure and temperature with the heat of the wall. The flow is what the tables say:
// they were measured on a tank, and mass_flow_gain belongs to a cylinder.
//
// What the tables and eq. 5.15 say together is how fast the tank of the flow test charged: with another alpha_i the tables
// are rescaled, and the tank charges as before. Another tank, with more or less heat through its wall, does not:
// tank_inflow_heat_change (polytropic_index).
//
// Other effects, absent until data switches them on: tank_flow_change (flow_conductance), exhaust_restriction, valve_leakage,
// the leak of the lower chamber's port (chamber_leakage_lower), tube, supply_droop, and heat_share: between the source's
// isothermal tank (0) and the full energy equation with heat through the wall (1). Valid for p, T > 0.
#pragma once

#include <algorithm>

#include "sms/actuator.hpp"

namespace sms {

template <typename S>
struct TankState {
  using Scalar = S;
  Gas<S> gas;
  Lag<S> spool;       // V, V/s
  S supply_pressure;  // in the reservoir at the valve, Pa; with supply_line_resistance
};

template <typename S>
struct TankInput {
  S command;  // V
};

template <typename S>
struct TankTerms {
  Gas<S> air;  // as the flows see it
  ChamberSpace<S> space;
  S feed;  // kg/s, supply to tank
  S vent;  // kg/s, tank to ambient, through the valve
  ChamberFlow<S> flow;
};

template <typename S>
struct Tank {
  using Scalar = S;
  using State = TankState<S>;
  using Input = TankInput<S>;
  using Terms = TankTerms<S>;
  static constexpr int legs = 1;  // one valve
  Params<S> params;
  ActuatorLaws laws;  // of valve and chamber
};

// What flows through the valve and past it.
template <typename S>
void fill_tank(const Tank<S>& tank, const TankState<S>& state, TankTerms<S>& t) {
  using std::abs;
  const Params<S>& p = tank.params;
  const S opening = valve_opening(p, state.spool.value);
  const OpenEdges<S> edges = open_edges(p, tank.laws.valve, heat_ratios(p, tank.laws.chamber), opening);
  const Gas<S> supply = {state.supply_pressure, p.air_temperature}, outside = {p.ambient_pressure, p.air_temperature};
  const S gain = S(1) + p.tank_flow_change;
  t.air = seen_air(p, tank.laws.chamber, state.gas);
  t.space = tank_space(p);
  t.space.volume += tube_volume(p);
  t.feed = t.vent = S(0);
  if (opening >= S(0)) {
    t.feed = gain * flow_map(p, Edge::feed_lower, flow_map_place<S>(opening)) *
             edge_flow(p, tank.laws.valve, edges.feed, edges.area, supply, t.air);
  } else {
    t.vent = gain * (S(1) + p.exhaust_flow_change) * flow_map(p, Edge::vent_lower, flow_map_place<S>(abs(opening))) *
             edge_flow(p, tank.laws.valve, edges.vent, edges.area, t.air, outside);
  }
  if (!is_absent(p.tube_length)) {
    const S passes = tube_transmission<S>(p, t.feed - t.vent, t.air.pressure);
    t.feed *= passes;
    t.vent *= passes;
  }
  if (!is_absent(p.valve_leakage)) {
    const IsoFlow<S> gap = valve_gap(p);
    t.feed += iso_mass_flow(p, gap, supply, t.air);
    t.vent += iso_mass_flow(p, gap, t.air, outside);
  }
  t.flow = {S(0), S(0), S(0)};
  add_flow(t.flow, t.feed, t.air, supply);
  t.flow.in_heat *= S(1) + p.tank_inflow_heat_change;
  add_flow<S>(t.flow, -t.vent, t.air, outside);
  const S leak = leak_flow(p.chamber_leakage_lower, p.chamber_leakage_index_lower, outside.pressure, t.air.pressure);
  add_flow(t.flow, leak, t.air, outside);
}

template <typename S>
sms_status derivative(const Tank<S>& tank, const TankState<S>& state, const TankInput<S>& input, TankTerms<S>& t,
                      TankState<S>& rate) {
  const Params<S>& p = tank.params;
  fill_tank(tank, state, t);
  rate.gas = gas_rate(p, tank.laws.chamber, state.gas, t.air, t.space, t.flow);
  rate.spool = spool_rate(p, state.spool, input.command);
  rate.supply_pressure = reservoir_pressure_rate(p, state.supply_pressure, t.feed);
  return is_finite(rate.gas.pressure) ? SMS_OK : SMS_NOT_A_NUMBER;
}

// What of the rates depends on the input alone, for a command that has jumped.
template <typename S>
void renew_command(const Tank<S>& tank, const TankState<S>& state, const TankInput<S>& input, TankState<S>& rate) {
  rate.spool = spool_rate(tank.params, state.spool, input.command);
}

// The valve closed, the reservoir full.
template <typename S>
TankState<S> tank_at_rest(const Params<S>& p, const S& pressure) {
  return {{pressure, p.air_temperature}, {p.valve_centre, S(0)}, p.supply_pressure};
}

template <typename S>
void prepare(const Tank<S>&, TankTerms<S>&) {}

template <typename S>
TankState<S> state_scale(const Tank<S>&) {
  const ActuatorState<S> actuator = actuator_scale<S>();
  return {actuator.lower, actuator.spool, actuator.supply_pressure};
}

// Of an actuator's switches a tank has those of the valve.
template <typename S>
void switches(const Tank<S>& tank, const TankState<S>& state, const TankTerms<S>&,
              S (&value)[actuator_switch_count()]) {
  std::fill_n(value, actuator_switch_count(), S(1));
  valve_switches<S>(tank.params, tank.laws.valve, state.spool.value, value);
}

// What a plant is asked by whoever closes a loop around it: there is no piston, and a tank runs in an open loop.
template <typename S>
S extension_of(const TankState<S>&, const TankTerms<S>&, int) {
  return S(0);
}

template <typename S>
void set_command(TankInput<S>& input, int, const S& command) {
  input.command = command;
}

}  // namespace sms
