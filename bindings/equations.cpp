// The equations of bench, platform and tank, each fed with measured signals.
#include <pybind11/eigen.h>

#include <memory>

#include "estimation/bench_equations.hpp"
#include "estimation/platform_equations.hpp"
#include "estimation/tank_equations.hpp"
#include "shooting_problem.hpp"

namespace sms_python {
namespace {

namespace est = sms::estimation;
using Columns = Eigen::MatrixXd;
using Conditions = std::map<std::string, double>;

// Columns: value, rate, second derivative, as many as there are.
est::MeasuredSignal signal_of(const Columns& columns) {
  const auto column = [&columns](Eigen::Index k) {
    return k < columns.cols() ? Eigen::VectorXd(columns.col(k)) : Eigen::VectorXd();
  };
  return {column(0), column(1), column(2)};
}

std::unique_ptr<est::BenchEquations> make_bench_equations(double step, Eigen::VectorXd command,
                                                          const Columns& extension, const Columns& pressure_lower,
                                                          const Columns& pressure_upper, const Columns& supply_pressure,
                                                          const Conditions& conditions, const std::string& friction,
                                                          const std::string& valve, const std::string& chambers) {
  return std::make_unique<est::BenchEquations>(est::BenchSignals{time_step("step", step),
                                                                 {std::move(command), signal_of(extension),
                                                                  signal_of(pressure_lower), signal_of(pressure_upper)},
                                                                 signal_of(supply_pressure),
                                                                 conditions_of(conditions)},
                                               laws_of(friction, valve, chambers));
}

std::unique_ptr<est::TankEquations> make_tank_equations(double step, Eigen::VectorXd command, const Columns& pressure,
                                                        const Columns& temperature, const Columns& supply_pressure,
                                                        const Conditions& conditions, const std::string& valve,
                                                        const std::string& chambers) {
  return std::make_unique<est::TankEquations>(
      est::TankSignals{time_step("step", step), std::move(command), signal_of(pressure), signal_of(temperature),
                       signal_of(supply_pressure), conditions_of(conditions)},
      laws_of("acceleration_dependent", valve, chambers));
}

std::unique_ptr<est::PlatformEquations> make_platform_equations(
    double step, const std::array<Eigen::VectorXd, 3>& command, const std::array<Columns, 3>& extension,
    const std::array<Columns, 3>& pressure_lower, const std::array<Columns, 3>& pressure_upper,
    const Columns& supply_pressure, const Columns& roll, const Columns& pitch, const Conditions& conditions,
    const std::string& friction, const std::string& valve, const std::string& chambers, int masses) {
  est::PlatformSignals signals;
  signals.step = time_step("step", step);
  for (std::size_t i = 0; i < 3; ++i) {
    signals.leg[i] = {command[i], signal_of(extension[i]), signal_of(pressure_lower[i]), signal_of(pressure_upper[i])};
  }
  signals.supply_pressure = signal_of(supply_pressure);
  signals.roll = signal_of(roll);
  signals.pitch = signal_of(pitch);
  signals.conditions = conditions_of(conditions);
  return std::make_unique<est::PlatformEquations>(std::move(signals), laws_of(friction, valve, chambers),
                                                  choice<sms::MassModel>("masses", masses, 4));
}

}  // namespace

void bind_equations(py::module_& m) {
  py::class_<est::BenchEquations, est::Problem>(
      m, "BenchEquations",
      "The force balance, N, the air in lower and upper chamber, kg/s, and the supply, Pa, where it is read: each fed "
      "with measured signals, model less measured, sample by sample. Arrays (n, k): value, rate, second derivative.")
      .def(py::init(&make_bench_equations), py::kw_only(), py::arg("step"), py::arg("command"), py::arg("extension"),
           py::arg("pressure_lower"), py::arg("pressure_upper"), py::arg("supply_pressure") = Columns(),
           py::arg("conditions") = Conditions(), py::arg("friction") = "acceleration_dependent",
           py::arg("valve") = "iso_0_4_mpa", py::arg("chambers") = "polytropic");
  py::class_<est::TankEquations, est::Problem>(
      m, "TankEquations",
      "The air in the tank, kg/s, thermometer, K, and supply, Pa, where they are read: each fed with measured signals, "
      "model less measured, sample by sample. Arrays (n, k): value, rate.")
      .def(py::init(&make_tank_equations), py::kw_only(), py::arg("step"), py::arg("command"), py::arg("pressure"),
           py::arg("temperature") = Columns(), py::arg("supply_pressure") = Columns(),
           py::arg("conditions") = Conditions(), py::arg("valve") = "iso_0_4_mpa", py::arg("chambers") = "polytropic");
  py::class_<est::PlatformEquations>(
      m, "PlatformEquations",
      "Three forces, N, flows into three lower and three upper chambers, kg/s, then supply, Pa, roll and pitch, rad, "
      "where they are read: each fed with measured signals, model less measured, sample by sample. A list of three has "
      "one array a leg, (n, k): value, rate, second derivative.")
      .def(py::init(&make_platform_equations), py::kw_only(), py::arg("step"), py::arg("command"), py::arg("extension"),
           py::arg("pressure_lower"), py::arg("pressure_upper"), py::arg("supply_pressure") = Columns(),
           py::arg("roll") = Columns(), py::arg("pitch") = Columns(), py::arg("conditions") = Conditions(),
           py::arg("friction") = "acceleration_dependent", py::arg("valve") = "iso_0_4_mpa",
           py::arg("chambers") = "polytropic", py::arg("masses") = 0)
      .def_property_readonly("rows", &est::PlatformEquations::rows)
      .def(
          "evaluate",
          [](const est::PlatformEquations& equations, const sms::LegParams<double>& params,
             const std::vector<std::string>& free) { return evaluate_with_legs(equations, params, free); },
          py::arg("params"), py::arg("free") = std::vector<std::string>(),
          "(residual (rows,), jacobian (rows, free)): model less measured, and its derivatives.");
}

}  // namespace sms_python
