// The proportional valve, from command to mass flow (dissertation, sections 4.1.2 and 5).
//
// Five ports in a row, closed by a spool with three lands. A command above the valve's centre moves the spool so that
// the supply feeds the lower chamber and the upper one is vented; below the centre it is the other way round. So there
// are four edges at which air is throttled, two of them open at a time:
//
//   above the centre   supply -> lower,  upper -> exhaust
//   below it           supply -> upper,  lower -> exhaust
//
// The spool. Its position over the command was measured; a cubic gives it to 0.5 % of full scale, a straight line to
// 2.6 %,
//
//   x_s = c3 V^3 + c2 V^2 + c1 V + c0   (eq. 4.1),      x_s = l1 V + l0   (eq. 4.2)
//
// It follows a changed command as a second-order lag. What lags here is the position expressed as the command that
// would hold it there, V: all static laws, in metres or in volts, then see the same spool.
//
// The opening. An orifice is a slot of length theta_S d_B / 2 around the barrel, and each land is wider than its slot
// by twice the overlap (w_S - w_O) / 2, so that
//
//   A = N theta_S d_B / 2  max(0, |x_s| - overlap),   |x_s| <= x_Smax                              (eq. 4.4)
//
// (the cases printed with eq. 4.4 have their signs wrong). The measured tables need neither spool nor area: they state
// the flow over |V - centre|. On a cylinder they are multiplied by mass_flow_gain, 1.5 to 1.65; on the tank where they
// were measured it is 1. The classic law has its discharge coefficient instead.
//
// The tables' flow is not exact, and no two of the four metering edges are alike: flow_map_feed_lower_1.., vent_lower,
// feed_upper and vent_upper are its relative error over each at some openings (map_error.hpp).
//
// Effects, absent until data switches them on: valve_leakage (a gap past the lands on all four edges: the ISO law, at
// first of a labyrinth, with b = 0 and m = 2, sqrt(p1^2 - p2^2)), dead_band_width, exhaust_restriction.
#pragma once

#include "sms/effect.hpp"
#include "sms/filter.hpp"
#include "sms/limit.hpp"
#include "sms/map_error.hpp"
#include "sms/valve_table.hpp"

namespace sms {

// Which law makes the flow.
enum class ValveLaw : int {
  iso_0_4_mpa,  // the table measured at 0.4 MPa gauge
  iso_0_2_mpa,  // the table measured at 0.2 MPa gauge
  classic       // orifice area and discharge coefficient
};

// ---- spool ----

// m, eq. 4.1; the spool itself stops at spool_limit.
template <typename S>
S spool_cubic(const Params<S>& p, const S& voltage) {
  return p.spool_cubic_0 + voltage * (p.spool_cubic_1 + voltage * (p.spool_cubic_2 + voltage * p.spool_cubic_3));
}

// m, eq. 4.2
template <typename S>
S spool_linear(const Params<S>& p, const S& voltage) {
  return p.spool_linear_0 + p.spool_linear_1 * voltage;
}

// Area of one port's orifices, m^2, eq. 4.4; beyond spool_limit it stays.
template <typename S>
S orifice_area(const Params<S>& p, const S& spool) {
  using std::abs;
  const S length = p.port_count * p.port_angle * S(0.5) * p.barrel_diameter;
  const S overlap = S(0.5) * (p.land_width - p.port_width);
  const S deflection = limited<S>(abs(spool), overlap, p.spool_limit);
  return length * (deflection - overlap);
}

// How the spool follows: (V, V/s) and (V/s, V/s^2).
template <typename S>
Lag<S> spool_rate(const Params<S>& p, const Lag<S>& spool, const S& command) {
  return lag_rate(angular_frequency(p.valve_frequency), p.valve_damping_ratio, spool, limited<S>(command, S(0), S(10)));
}

// ---- opening ----

// Distance of the spool from the centre in V, signed: positive feeds the lower chamber. A changed dead band stretches
// the range below the first row of the tables and shifts what is above.
template <typename S>
S valve_opening(const Params<S>& p, const S& voltage) {
  using std::abs;
  const S first(valve_table_0_4_mpa<ValueOf<S>>().opening[0]);  // V, the same in both tables
  const S distance = voltage - p.valve_centre;
  const S far = first + p.dead_band_change;
  if (abs(distance) < far) {
    return distance * (first / far);
  }
  return distance < S(0) ? distance + p.dead_band_change : distance - p.dead_band_change;
}

// The two edges that are open at |opening|: as C, b, m where a table says so.
template <typename S>
struct OpenEdges {
  IsoFlow<S> feed;
  IsoFlow<S> vent;
  S area;  // of both, m^2, for the classic law
};

template <typename S>
OpenEdges<S> open_edges(const Params<S>& p, ValveLaw law, const HeatRatios<S>& ratios, const S& opening) {
  using std::abs;
  using V = ValueOf<S>;
  OpenEdges<S> edges{};
  if (law == ValveLaw::classic) {
    edges.area = orifice_area(p, spool_cubic(p, S(5) + opening));
  } else {
    const ValveTable<V>& table = law == ValveLaw::iso_0_4_mpa ? valve_table_0_4_mpa<V>() : valve_table_0_2_mpa<V>();
    const ValveTablePlace<S> place = valve_table_place<S>(table, abs(opening));
    edges.feed = charge_flow(table, ratios, place);
    edges.vent = discharge_flow(table, ratios, place);
  }
  return edges;
}

// ---- what is not known of the tables ----

// Where an opening lies among the knots of the flow's error.
template <typename S>
MapPlace<S> flow_map_place(const S& opening) {
  using V = ValueOf<S>;
  static constexpr MapKnots<V, 6> knots({V(0.6), V(0.75), V(0.95), V(1.25), V(1.8), V(3.0)});  // V
  return map_place<S>(knots, opening);
}

enum class Edge { feed_lower, vent_lower, feed_upper, vent_upper };

// Flow over an edge over that of the tables: 1 and its relative error there.
template <typename S>
S flow_map(const Params<S>& p, Edge edge, const MapPlace<S>& place) {
  using P = Params<S>;
  static constexpr S P::*error[][6] = {
      {&P::flow_map_feed_lower_1, &P::flow_map_feed_lower_2, &P::flow_map_feed_lower_3, &P::flow_map_feed_lower_4,
       &P::flow_map_feed_lower_5, &P::flow_map_feed_lower_6},
      {&P::flow_map_vent_lower_1, &P::flow_map_vent_lower_2, &P::flow_map_vent_lower_3, &P::flow_map_vent_lower_4,
       &P::flow_map_vent_lower_5, &P::flow_map_vent_lower_6},
      {&P::flow_map_feed_upper_1, &P::flow_map_feed_upper_2, &P::flow_map_feed_upper_3, &P::flow_map_feed_upper_4,
       &P::flow_map_feed_upper_5, &P::flow_map_feed_upper_6},
      {&P::flow_map_vent_upper_1, &P::flow_map_vent_upper_2, &P::flow_map_vent_upper_3, &P::flow_map_vent_upper_4,
       &P::flow_map_vent_upper_5, &P::flow_map_vent_upper_6}};
  return S(1) + map_error(p, error[int(edge)], place);
}

// ---- flow ----

// The air at the four ports.
template <typename S>
struct ValvePorts {
  Gas<S> supply;
  Gas<S> lower;
  Gas<S> upper;
  Gas<S> exhaust;
};

// Mass flow over the four edges, kg/s, positive from the first port named to the second.
template <typename S>
struct EdgeFlows {
  S supply_lower;
  S lower_exhaust;
  S supply_upper;
  S upper_exhaust;
};

template <typename S>
S edge_flow(const Params<S>& p, ValveLaw law, const IsoFlow<S>& iso, const S& area, const Gas<S>& from,
            const Gas<S>& to) {
  return law == ValveLaw::classic ? classic_mass_flow(p, area, from, to) : iso_mass_flow(p, iso, from, to);
}

// The gap past the lands, open at any command.
template <typename S>
IsoFlow<S> valve_gap(const Params<S>& p) {
  return {p.valve_leakage, p.leakage_critical_ratio, p.leakage_index};
}

template <typename S>
EdgeFlows<S> leakage_flows(const Params<S>& p, const ValvePorts<S>& ports) {
  if (is_absent(p.valve_leakage)) {
    return {S(0), S(0), S(0), S(0)};
  }
  const IsoFlow<S> gap = valve_gap(p);
  return {iso_mass_flow(p, gap, ports.supply, ports.lower), iso_mass_flow(p, gap, ports.lower, ports.exhaust),
          iso_mass_flow(p, gap, ports.supply, ports.upper), iso_mass_flow(p, gap, ports.upper, ports.exhaust)};
}

// The whole valve with its spool at `voltage`.
template <typename S>
EdgeFlows<S> valve_flows(const Params<S>& p, ValveLaw law, const HeatRatios<S>& ratios, const S& voltage,
                         const ValvePorts<S>& ports) {
  using std::abs;
  EdgeFlows<S> flow = leakage_flows(p, ports);
  const S opening = valve_opening(p, voltage);
  const OpenEdges<S> edges = open_edges(p, law, ratios, opening);
  const S gain = law == ValveLaw::classic ? S(1) : p.mass_flow_gain;
  const MapPlace<S> place = flow_map_place<S>(abs(opening));
  const S vent_gain = gain * (S(1) + p.exhaust_flow_change);
  if (opening >= S(0)) {
    flow.supply_lower += gain * flow_map(p, Edge::feed_lower, place) *
                         edge_flow(p, law, edges.feed, edges.area, ports.supply, ports.lower);
    flow.upper_exhaust += vent_gain * flow_map(p, Edge::vent_upper, place) *
                          edge_flow(p, law, edges.vent, edges.area, ports.upper, ports.exhaust);
  } else {
    flow.supply_upper += gain * flow_map(p, Edge::feed_upper, place) *
                         edge_flow(p, law, edges.feed, edges.area, ports.supply, ports.upper);
    flow.lower_exhaust += vent_gain * flow_map(p, Edge::vent_lower, place) *
                          edge_flow(p, law, edges.vent, edges.area, ports.lower, ports.exhaust);
  }
  return flow;
}

}  // namespace sms
