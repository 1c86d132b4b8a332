// The tank of the flow test as a plant (dissertation, section 5.2): a vessel of constant volume behind one port of the
// valve, charged from the supply while the spool is above its centre, vented below it.
//
//   p' = R / V (alpha_i m_in' T - alpha_o m_out' T)                                              (eq. 5.5, 5.15)
//
// or, with the full energy equation, pressure and temperature with the heat of the wall. The flow is what the tables say:
// mass_flow_gain belongs to a cylinder.
#pragma once

#include "sms/actuator.hpp"

namespace sms {

template <typename S>
struct TankState {
  using Scalar = S;
  Gas<S> gas;
  Lag<S> spool;  // V, V/s
};

template <typename S>
struct TankInput {
  S command;          // V
  S supply_pressure;  // Pa absolute
};

template <typename S>
struct TankTerms {
  ChamberFlow<S> flow;
};

template <typename S>
struct Tank {
  Params<S> params;
  ActuatorLaws laws;  // of valve and chamber
};

template <typename S>
sms_status derivative(const Tank<S>& tank, const TankState<S>& state, const TankInput<S>& input, TankTerms<S>& t,
                      TankState<S>& rate) {
  const Params<S>& p = tank.params;
  const S opening = valve_opening(p, state.spool.value);
  const OpenEdges<S> edges = open_edges(p, tank.laws.valve, heat_ratios(p, tank.laws.chamber), opening);
  const bool charging = opening >= S(0);
  const Gas<S> outside = {charging ? input.supply_pressure : p.ambient_pressure, p.air_temperature};
  t.flow = {S(0), S(0), S(0)};
  add_flow<S>(t.flow, edge_flow(p, tank.laws.valve, charging ? edges.feed : edges.vent, edges.area, outside, state.gas),
              state.gas, outside);
  rate.gas = chamber_rate(p, tank.laws.chamber, state.gas, tank_space(p), t.flow);
  rate.spool = spool_rate(p, state.spool, input.command);
  return is_finite(rate.gas.pressure) ? SMS_OK : SMS_NOT_A_NUMBER;
}

template <typename S>
TankState<S> tank_at_rest(const Params<S>& p, const S& pressure) {
  return {{pressure, p.air_temperature}, {p.valve_centre, S(0)}};
}

}  // namespace sms
