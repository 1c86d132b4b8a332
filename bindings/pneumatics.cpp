// Valve, chambers, tubes, vessels and the instruments of the flow test, over numpy arrays that broadcast. Air is at the
// parameters' air_temperature where no temperature is asked for.
#include "broadcast.hpp"
#include "choice.hpp"
#include "sms/thermocouple.hpp"
#include "sms/vessel.hpp"

namespace sms_python {
namespace {

using Gas = sms::Gas<double>;
using sms::ValveLaw;

enum class Chamber { lower, upper };

ValveLaw valve_law(const std::string& name) {
  return choice<ValveLaw>(
      "law", name,
      {{"iso_0_4_mpa", ValveLaw::iso_0_4_mpa}, {"iso_0_2_mpa", ValveLaw::iso_0_2_mpa}, {"classic", ValveLaw::classic}});
}

// A law that has a table.
ValveLaw table_law(const std::string& name) {
  return choice<ValveLaw>("law", name,
                          {{"iso_0_4_mpa", ValveLaw::iso_0_4_mpa}, {"iso_0_2_mpa", ValveLaw::iso_0_2_mpa}});
}

Chamber chamber_of(const std::string& name) {
  return choice<Chamber>("chamber", name, {{"lower", Chamber::lower}, {"upper", Chamber::upper}});
}

Gas at(const Params& p, double pressure) { return {pressure, p.air_temperature}; }

sms::ChamberSpace<double> space(const Params& p, Chamber chamber, double extension, double velocity) {
  return chamber == Chamber::lower ? sms::lower_space(p, extension, velocity)
                                   : sms::upper_space(p, extension, velocity);
}

// ---- valve ----

py::typing::Dict<py::str, Array> valve_table(const std::string& law) {
  using Table = sms::ValveTable<double>;
  const Table& table =
      table_law(law) == ValveLaw::iso_0_4_mpa ? sms::valve_table_0_4_mpa<double>() : sms::valve_table_0_2_mpa<double>();
  const char* const names[Table::columns] = {"charge_C",    "charge_b",    "charge_m",
                                             "discharge_C", "discharge_b", "discharge_m"};
  const auto rows = [](const auto& value) {
    Array array(sms::valve_row_count());
    for (int i = 0; i < sms::valve_row_count(); ++i) {
      array.mutable_data()[i] = value(i);
    }
    return array;
  };
  py::dict columns;
  columns["spool"] = rows([&table](int i) { return table.spool[i]; });
  columns["opening"] = rows([&table](int i) { return table.opening[i]; });
  for (int k = 0; k < Table::columns; ++k) {
    columns[names[k]] = rows([&table, k](int i) { return table.curve[k][i][0]; });
  }
  return columns;
}

Three open_edge(const Params& p, const std::string& law_name, const Array& opening, bool feed) {
  const ValveLaw law = table_law(law_name);
  const auto one = [&p, law, feed](double o) -> std::array<double, 3> {
    const auto edges = sms::open_edges(p, law, sms::polytropic_ratios(p), o);
    const sms::IsoFlow<double>& flow = feed ? edges.feed : edges.vent;
    return {flow.sonic_conductance, flow.critical_ratio, flow.subsonic_index};
  };
  return as_tuple(broadcast<3>(one, opening));
}

Four valve_mass_flow(const Params& p, const Array& voltage, const Array& supply, const Array& lower, const Array& upper,
                     const Array& exhaust, const std::string& law_name) {
  const ValveLaw law = valve_law(law_name);
  const auto one = [&p, law](double v, double s, double l, double u, double e) -> std::array<double, 4> {
    const auto flow = sms::valve_flows(p, law, sms::polytropic_ratios(p), v, {at(p, s), at(p, l), at(p, u), at(p, e)});
    return {flow.supply_lower, flow.lower_exhaust, flow.supply_upper, flow.upper_exhaust};
  };
  return as_tuple(broadcast<4>(one, voltage, supply, lower, upper, exhaust));
}

void bind_valve(py::module_& m) {
  const auto of_one = [&m](const char* name, double (*equation)(const Params&, const double&), const char* argument,
                           const char* doc) {
    m.def(
        name,
        [equation](const Params& p, const Array& x) {
          return each([&p, equation](double value) { return equation(p, value); }, x);
        },
        py::arg("params"), py::arg(argument), doc);
  };
  of_one("spool_cubic", &sms::spool_cubic<double>, "voltage", "Spool over command, m (eq. 4.1), not clamped.");
  of_one("spool_linear", &sms::spool_linear<double>, "voltage", "Spool over command, m (eq. 4.2), not clamped.");
  of_one("orifice_area", &sms::orifice_area<double>, "spool", "Area of one port, m^2 (eq. 4.4), spool in m.");
  of_one("sonic_conductance", &sms::sonic_conductance<double>, "area", "C of an orifice, m^3/(s Pa) (eq. 5.10).");
  m.def(
      "classic_mass_flow",
      [](const Params& p, const Array& area, const Array& from, const Array& to, const Array& temperature) {
        const auto one = [&p](double a, double p1, double p2, double T) {
          return sms::classic_mass_flow(p, a, {p1, T}, {p2, T});
        };
        return each(one, area, from, to, temperature);
      },
      py::arg("params"), py::arg("area"), py::arg("pressure_from"), py::arg("pressure_to"), py::arg("temperature"),
      "Mass flow through an orifice, kg/s (eq. 4.20 to 4.22); area m^2, pressures Pa absolute, temperature K.");
  m.def(
      "iso_mass_flow",
      [](const Params& p, const Array& C, const Array& b, const Array& index, const Array& from, const Array& to,
         const Array& temperature) {
        const auto one = [&p](double c, double r, double i, double p1, double p2, double T) {
          return sms::iso_mass_flow(p, {c, r, i}, {p1, T}, {p2, T});
        };
        return each(one, C, b, index, from, to, temperature);
      },
      py::arg("params"), py::arg("sonic_conductance"), py::arg("critical_ratio"), py::arg("subsonic_index"),
      py::arg("pressure_from"), py::arg("pressure_to"), py::arg("temperature"),
      "Mass flow through a component, kg/s (eq. 5.8, 5.9); C in m^3/(s Pa), pressures Pa absolute, temperature K.");
  m.def("valve_table", &valve_table, py::arg("law"),
        "The rows of a measured table, arrays (28,): spool [m], opening [V], charge_ and discharge_ C [m^3/(s Pa)], "
        "b, m.");
  m.def(
      "charge_flow",
      [](const Params& p, const Array& opening, const std::string& law) { return open_edge(p, law, opening, true); },
      py::arg("params"), py::arg("opening"), py::arg("law") = "iso_0_4_mpa",
      "(C, b, m) of the port that is fed at an opening of |command - centre|, V.");
  m.def(
      "discharge_flow",
      [](const Params& p, const Array& opening, const std::string& law) { return open_edge(p, law, opening, false); },
      py::arg("params"), py::arg("opening"), py::arg("law") = "iso_0_4_mpa",
      "(C, b, m) of the port that is vented at an opening of |command - centre|, V.");
  m.def("valve_mass_flow", &valve_mass_flow, py::arg("params"), py::arg("voltage"), py::arg("pressure_supply"),
        py::arg("pressure_lower"), py::arg("pressure_upper"), py::arg("pressure_exhaust"),
        py::arg("law") = "iso_0_4_mpa",
        "(supply to lower, lower to exhaust, supply to upper, upper to exhaust), kg/s, mass_flow_gain and leaks "
        "included; pressures Pa absolute.");
}

// ---- chambers ----

void bind_chamber(py::module_& m) {
  m.def(
      "chamber_volume",
      [](const Params& p, const std::string& chamber_name, const Array& extension) {
        const Chamber chamber = chamber_of(chamber_name);
        return each([&p, chamber](double x) { return space(p, chamber, x, 0.0).volume; }, extension);
      },
      py::arg("params"), py::arg("chamber"), py::arg("extension"), "Volume, m^3 (eq. 4.31), tube included.");
  m.def(
      "chamber_pressure_rate",
      [](const Params& p, const std::string& chamber_name, const Array& pressure, const Array& extension,
         const Array& velocity, const Array& inflow, const Array& outflow) {
        const Chamber chamber = chamber_of(chamber_name);
        const auto one = [&p, chamber](double gas, double x, double v, double in, double out) {
          return sms::polytropic_pressure_rate(p, sms::polytropic_ratios(p), at(p, gas), space(p, chamber, x, v),
                                               {in, in * p.air_temperature, out});
        };
        return each(one, pressure, extension, velocity, inflow, outflow);
      },
      py::arg("params"), py::arg("chamber"), py::arg("pressure"), py::arg("extension"), py::arg("velocity"),
      py::arg("inflow"), py::arg("outflow"), "Rate of pressure, Pa/s (eq. 4.30, 4.32); flows in kg/s.");
  m.def(
      "chamber_energy_rates",
      [](const Params& p, const std::string& chamber_name, const Array& pressure, const Array& temperature,
         const Array& extension, const Array& velocity, const Array& inflow, const Array& outflow,
         const Array& inflow_temperature) {
        const Chamber chamber = chamber_of(chamber_name);
        const auto one = [&p, chamber](double gas, double T, double x, double v, double in, double out,
                                       double T_in) -> std::array<double, 3> {
          const auto rate = sms::energy_rates(p, {gas, T}, space(p, chamber, x, v), {in, in * T_in, out});
          return {rate.pressure, rate.temperature, rate.mass};
        };
        return as_tuple(
            broadcast<3>(one, pressure, temperature, extension, velocity, inflow, outflow, inflow_temperature));
      },
      py::arg("params"), py::arg("chamber"), py::arg("pressure"), py::arg("temperature"), py::arg("extension"),
      py::arg("velocity"), py::arg("inflow"), py::arg("outflow"), py::arg("inflow_temperature"),
      "(Pa/s, K/s, kg/s) by the full energy equation with heat from the wall (eq. 4.27).");
  m.def(
      "tube_delay", [](const Params& p) { return sms::tube_delay(p); }, py::arg("params"), "s");
  m.def(
      "tube_transmission",
      [](const Params& p, const Array& mass_flow, const Array& pressure) {
        const auto one = [&p](double flow, double gas) { return sms::tube_transmission(p, flow, gas); };
        return each(one, mass_flow, pressure);
      },
      py::arg("params"), py::arg("mass_flow"), py::arg("pressure"), "Part of a mass flow that the tube lets through.");
}

// ---- vessels and instruments ----

void bind_vessels(py::module_& m) {
  m.def(
      "tank_pressure_rate",
      [](const Params& p, const Array& C, const Array& b, const Array& index, const Array& tank, const Array& outside) {
        const auto one = [&p](double c, double r, double i, double inner, double outer) {
          return sms::tank_pressure_rate(p, {c, r, i}, at(p, inner), at(p, outer));
        };
        return each(one, C, b, index, tank, outside);
      },
      py::arg("params"), py::arg("sonic_conductance"), py::arg("critical_ratio"), py::arg("subsonic_index"),
      py::arg("pressure"), py::arg("pressure_outside"), "Rate of pressure in the tank, Pa/s (eq. 5.5 with 5.8).");
  m.def(
      "reservoir_pressure_rate",
      [](const Params& p, const Array& pressure, const Array& drawn) {
        const auto one = [&p](double gas, double flow) { return sms::reservoir_pressure_rate(p, gas, flow); };
        return each(one, pressure, drawn);
      },
      py::arg("params"), py::arg("pressure"), py::arg("drawn"), "Rate of pressure in the reservoir, Pa/s; drawn kg/s.");
  m.def(
      "thermocouple_temperature",
      [](const Params& p, const Array& voltage, const Array& cold_junction) {
        const auto one = [&p](double v, double T) { return sms::thermocouple_temperature(p, v, T); };
        return each(one, voltage, cold_junction);
      },
      py::arg("params"), py::arg("voltage"), py::arg("cold_junction"),
      "Temperature, K (eq. 5.11, 5.12), from the amplified voltage and the cold junction's temperature, K.");
}

}  // namespace

void bind_pneumatics(py::module_& m) {
  bind_valve(m);
  bind_chamber(m);
  bind_vessels(m);
}

}  // namespace sms_python
