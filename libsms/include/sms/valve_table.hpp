// The measured flow of the valve: C, b and m of ISO 6358 over the distance of the command from the valve's centre
// (dissertation, section 5.3.3, Tables 5.1 and 5.2).
//
// Charging was read from port 1 to 2 below 5 V, discharging from port 4 to 5 above it, each at the same distances from
// 5 V. As printed, and as used: the voltages at 0.85 and 0.90 mm break the trend (about 2.86 and 2.75 V were to be
// expected), b of the discharge rows was set to zero, some m and b lie beyond the limits the text gives, and the first
// rows, at 0.2 mm, are leakage past the closed land.
//
// Between the rows runs Steffen's cubic (M. Steffen, Astron. Astrophys. 239, 1990): its slope at a row is
//
//   (sgn s_1 + sgn s_2) min(|s_1|, |s_2|, |s_1 h_2 + s_2 h_1| / (2 (h_1 + h_2)))
//
// from the secants s and widths h on either side, zero where they differ in sign. So every curve is continuous in value
// and slope, and between two rows it never leaves their values: no maximum appears that was not measured. Below the
// first row C falls linearly to zero at the centre, b and m stay; beyond the last row all stay.
//
// The tanks' pressures were turned into C with a heat ratio of 1.4 while charging and 1.0 while discharging. Where a
// chamber is computed with other ratios, C has to follow, or the pressure would no longer be the measured one:
// HeatRatios carries them, and C is scaled by table ratio over ratio.
#pragma once

#include "sms/mass_flow.hpp"
#include "sms/scalar.hpp"

namespace sms {

// alpha_i, alpha_o, alpha of eq. 4.30: for air that enters, air that leaves, and the piston's work.
template <typename S>
struct HeatRatios {
  S in;
  S out;
  S work;
};

constexpr int valve_row_count() { return 28; }

// One table as curves over the opening, kept in flash: from row i on, column k is
// ((curve[k][i][3] x + curve[k][i][2]) x + curve[k][i][1]) x + curve[k][i][0], with x the opening beyond that row.
template <typename V>
struct ValveTable {
  enum Column : int { charge_c, charge_b, charge_m, discharge_c, discharge_b, discharge_m, columns };
  V spool[valve_row_count()];    // m
  V opening[valve_row_count()];  // V, distance of the command from the centre
  V curve[columns][valve_row_count()][4];
};

namespace detail {

struct ValveRow {
  double spool;
  double charge_voltage, charge_b, charge_c, charge_m;
  double discharge_voltage, discharge_b, discharge_c, discharge_m;
};

constexpr double absolute(double x) { return x < 0.0 ? -x : x; }
constexpr double lesser(double a, double b) { return a < b ? a : b; }

// Steffen's slope at a row from the secants and widths before and after it.
constexpr double monotone_slope(double s1, double h1, double s2, double h2) {
  return s1 * s2 <= 0.0 ? 0.0
                        : (s1 < 0.0 ? -2.0 : 2.0) * lesser(lesser(absolute(s1), absolute(s2)),
                                                           absolute(s1 * h2 + s2 * h1) / (2.0 * (h1 + h2)));
}

template <typename V>
constexpr ValveTable<V> make_valve_table(const ValveRow (&rows)[valve_row_count()]) {
  using Table = ValveTable<V>;
  ValveTable<V> table{};
  double x[valve_row_count()] = {};
  double y[Table::columns][valve_row_count()] = {};
  for (int i = 0; i < valve_row_count(); ++i) {
    const ValveRow& row = rows[i];
    x[i] = 0.5 * (row.discharge_voltage - row.charge_voltage);
    y[Table::charge_c][i] = row.charge_c;
    y[Table::charge_b][i] = row.charge_b;
    y[Table::charge_m][i] = row.charge_m;
    y[Table::discharge_c][i] = row.discharge_c;
    y[Table::discharge_b][i] = row.discharge_b;
    y[Table::discharge_m][i] = row.discharge_m;
    table.spool[i] = V(1e-3 * row.spool);
    table.opening[i] = V(x[i]);
  }
  for (int k = 0; k < Table::columns; ++k) {
    double slope[valve_row_count()] = {};  // zero at the last row, and at the first for b and m: beyond it they stay
    slope[0] = k == Table::charge_c || k == Table::discharge_c ? y[k][0] / x[0] : 0.0;
    for (int i = 1; i < valve_row_count() - 1; ++i) {
      const double h1 = x[i] - x[i - 1], h2 = x[i + 1] - x[i];
      slope[i] = monotone_slope((y[k][i] - y[k][i - 1]) / h1, h1, (y[k][i + 1] - y[k][i]) / h2, h2);
    }
    for (int i = 0; i < valve_row_count(); ++i) {
      table.curve[k][i][0] = V(y[k][i]);
      if (i < valve_row_count() - 1) {
        const double h = x[i + 1] - x[i], secant = (y[k][i + 1] - y[k][i]) / h;
        table.curve[k][i][1] = V(slope[i]);
        table.curve[k][i][2] = V((3.0 * secant - 2.0 * slope[i] - slope[i + 1]) / h);
        table.curve[k][i][3] = V((slope[i] + slope[i + 1] - 2.0 * secant) / (h * h));
      }
    }
  }
  return table;
}

#define SMS_VALVE_ROW(spool, vc, bc, cc, mc, vd, bd, cd, md) {spool, vc, bc, cc, mc, vd, bd, cd, md},
constexpr ValveRow valve_rows_0_4_mpa[valve_row_count()] = {
#include "sms/valve_table_0_4_mpa.def"
};
#define SMS_VALVE_ROW(spool, vc, bc, cc, mc, vd, bd, cd, md) {spool, vc, bc, cc, mc, vd, bd, cd, md},
constexpr ValveRow valve_rows_0_2_mpa[valve_row_count()] = {
#include "sms/valve_table_0_2_mpa.def"
};

}  // namespace detail

template <typename V>
const ValveTable<V>& valve_table_0_4_mpa() {
  static constexpr ValveTable<V> table = detail::make_valve_table<V>(detail::valve_rows_0_4_mpa);
  return table;
}

template <typename V>
const ValveTable<V>& valve_table_0_2_mpa() {
  static constexpr ValveTable<V> table = detail::make_valve_table<V>(detail::valve_rows_0_2_mpa);
  return table;
}

// Where an opening lies in a table: `beyond` row number `row`.
template <typename S>
struct ValveTablePlace {
  int row;        // 0 .. valve_row_count() - 1
  S beyond;       // V
  S below_first;  // the opening over the first row's, 1 from there on: a factor of C
};

template <typename S>
ValveTablePlace<S> valve_table_place(const ValveTable<ValueOf<S>>& table, const S& opening) {
  constexpr int last = valve_row_count() - 1;
  if (opening < S(table.opening[0])) {
    return {0, S(0), opening / S(table.opening[0])};
  }
  if (!(opening < S(table.opening[last]))) {
    return {last, S(0), S(1)};
  }
  int row = 0, above = last;
  while (above - row > 1) {
    const int middle = (row + above) / 2;
    (opening < S(table.opening[middle]) ? above : row) = middle;
  }
  return {row, opening - S(table.opening[row]), S(1)};
}

template <typename S>
S valve_table_value(const ValveTable<ValueOf<S>>& table, int column, const ValveTablePlace<S>& place) {
  const ValueOf<S>* curve = table.curve[column][place.row];
  const S& x = place.beyond;
  return S(curve[0]) + x * (S(curve[1]) + x * (S(curve[2]) + x * S(curve[3])));
}

// The port that is fed.
template <typename S>
IsoFlow<S> charge_flow(const ValveTable<ValueOf<S>>& table, const HeatRatios<S>& ratios,
                       const ValveTablePlace<S>& place) {
  using Table = ValveTable<ValueOf<S>>;
  const S scale = place.below_first * (S(1.4) / ratios.in);
  return {scale * valve_table_value<S>(table, Table::charge_c, place),
          valve_table_value<S>(table, Table::charge_b, place), valve_table_value<S>(table, Table::charge_m, place)};
}

// The port that is vented.
template <typename S>
IsoFlow<S> discharge_flow(const ValveTable<ValueOf<S>>& table, const HeatRatios<S>& ratios,
                          const ValveTablePlace<S>& place) {
  using Table = ValveTable<ValueOf<S>>;
  const S scale = place.below_first * (S(1.0) / ratios.out);
  return {scale * valve_table_value<S>(table, Table::discharge_c, place),
          valve_table_value<S>(table, Table::discharge_b, place),
          valve_table_value<S>(table, Table::discharge_m, place)};
}

// The same at an opening of |V - centre|, V.
template <typename S>
IsoFlow<S> charge_flow(const ValveTable<ValueOf<S>>& table, const HeatRatios<S>& ratios, const S& opening) {
  return charge_flow(table, ratios, valve_table_place<S>(table, opening));
}

template <typename S>
IsoFlow<S> discharge_flow(const ValveTable<ValueOf<S>>& table, const HeatRatios<S>& ratios, const S& opening) {
  return discharge_flow(table, ratios, valve_table_place<S>(table, opening));
}

}  // namespace sms
