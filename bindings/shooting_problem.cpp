// Bench and tank as problems of windows.
#include "shooting_problem.hpp"

#include <memory>
#include <optional>

#include "estimation/bench_loop.hpp"
#include "estimation/tank_plant.hpp"

namespace sms_python {
namespace {

namespace est = sms::estimation;

using BenchProblem = est::ShootingProblem<est::BenchPlant>;
using BenchLoopProblem = est::ShootingProblem<est::BenchLoopPlant>;
using TankPlantProblem = est::ShootingProblem<est::TankPlant>;
using Noise = std::map<std::string, double>;

est::BenchRecord make_bench_record(double step, Eigen::VectorXd command, Eigen::VectorXd extension,
                                   Eigen::VectorXd pressure_lower, Eigen::VectorXd pressure_upper,
                                   Eigen::VectorXd supply_pressure, const std::map<std::string, double>& conditions,
                                   Eigen::VectorXd setpoint, const std::string& hold) {
  return {time_step("step", step),   std::move(command),        std::move(extension),
          std::move(pressure_lower), std::move(pressure_upper), std::move(supply_pressure),
          conditions_of(conditions), std::move(setpoint),       hold_of(hold)};
}

est::BenchNoise bench_noise(const Noise& noise) {
  return {noise_of(noise, "extension"), noise_of(noise, "chamber_pressure_lower"),
          noise_of(noise, "chamber_pressure_upper"), noise_of(noise, "supply_pressure")};
}

std::unique_ptr<BenchProblem> make_bench_problem(std::vector<est::BenchRecord> records, const Noise& noise,
                                                 const std::string& friction, const std::string& valve,
                                                 const std::string& chambers, double window, double longest_step,
                                                 const std::optional<double>& elsewhere, int threads) {
  need_commands(records, [](const est::BenchRecord& record) -> const Eigen::VectorXd& { return record.command; });
  return std::make_unique<BenchProblem>(
      est::BenchPlant(std::move(records), bench_noise(noise), laws_of(friction, valve, chambers),
                      longest_steps(longest_step, elsewhere)),
      options_of(window, threads));
}

std::unique_ptr<BenchLoopProblem> make_bench_loop_problem(std::vector<est::BenchRecord> records, const Noise& noise,
                                                          const Params& said, const std::string& law, bool compensated,
                                                          bool electronics, const std::string& friction,
                                                          const std::string& valve, const std::string& chambers,
                                                          double window, double longest_step, int threads) {
  sms::ActuatorLaws laws = laws_of(friction, valve, chambers);
  laws.drive = electronics ? sms::DriveLaw::filtered : sms::DriveLaw::direct;
  return std::make_unique<BenchLoopProblem>(
      est::BenchLoopPlant(std::move(records), bench_noise(noise), noise_of(noise, "valve_command"), laws,
                          control_law(law, compensated, electronics), said, time_step("longest_step", longest_step)),
      options_of(window, threads));
}

est::TankPlantRecord make_tank_record(double step, Eigen::VectorXd command, Eigen::VectorXd pressure,
                                      Eigen::VectorXd temperature, Eigen::VectorXd supply_pressure,
                                      const std::map<std::string, double>& conditions, const std::string& hold,
                                      const std::string& valve) {
  return {time_step("step", step),    std::move(command),        std::move(pressure), std::move(temperature),
          std::move(supply_pressure), conditions_of(conditions), hold_of(hold),       valve_law_of(valve)};
}

std::unique_ptr<TankPlantProblem> make_tank_plant_problem(std::vector<est::TankPlantRecord> records, const Noise& noise,
                                                          const std::string& chambers, double window,
                                                          double longest_step, const std::optional<double>& elsewhere,
                                                          int threads) {
  const est::TankNoise sizes{noise_of(noise, "tank_pressure"), noise_of(noise, "tank_temperature"),
                             noise_of(noise, "supply_pressure")};
  return std::make_unique<TankPlantProblem>(
      est::TankPlant(std::move(records), sizes, laws_of("acceleration_dependent", "iso_0_4_mpa", chambers),
                     longest_steps(longest_step, elsewhere)),
      options_of(window, threads));
}

// The plant where a window begins, as a simulation takes it (plant.cpp).
template <typename Problem>
void bind_state(py::class_<Problem, est::Problem>& problem) {
  problem.def(
      "state",
      [](const Problem& p, const Params& params, std::size_t window) {
        if (window >= p.windows().size()) {
          throw py::index_error("window " + std::to_string(window) + " of " + std::to_string(p.windows().size()) +
                                ", which count from 0");
        }
        const Exclusive alone(&p);
        return p.plant().state(params, p.windows()[window], p.found(window));
      },
      py::arg("params"), py::arg("window"),
      "State of the plant where a window begins, at the initial state found last; simulate_bench and simulate_tank go "
      "on "
      "from it.");
}

void bind_bench(py::module_& m) {
  py::class_<est::BenchRecord>(m, "BenchRecord", "One evenly sampled record of the rig 'bench'; arrays (n,), SI.")
      .def(py::init(&make_bench_record), py::kw_only(), py::arg("step"), py::arg("command"), py::arg("extension"),
           py::arg("pressure_lower"), py::arg("pressure_upper"), py::arg("supply_pressure") = Eigen::VectorXd(),
           py::arg("conditions") = std::map<std::string, double>(), py::arg("setpoint") = Eigen::VectorXd(),
           py::arg("hold") = "linear",
           "setpoint: of a loop that is simulated, where command may be empty: not measured. hold: what the valve has "
           "between two samples of the command, \"linear\" or the \"previous\" one.");
  auto bench = bind_shooting_problem<est::BenchPlant, est::Problem>(m, "BenchProblem");
  bind_state(bench);
  bench.def(
      py::init(&make_bench_problem), py::kw_only(), py::arg("records"), py::arg("noise"),
      py::arg("friction") = "acceleration_dependent", py::arg("valve") = "iso_0_4_mpa",
      py::arg("chambers") = "polytropic", py::arg("window") = 1.0, py::arg("longest_step") = 1e-3,
      py::arg("longest_step_elsewhere") = py::none(), py::arg("threads") = 1,
      "noise: standard deviation of a sample of extension, chamber_pressure_lower, chamber_pressure_upper and "
      "supply_pressure. longest_step: of the integration, s; longest_step_elsewhere: where the recorded extension "
      "says that the piston is well on its way; None: the same. Hidden inputs: a force, N, and flows into either "
      "chamber, kg/s.");
  bind_shooting_problem<est::BenchLoopPlant, est::Problem>(m, "BenchLoopProblem")
      .def(py::init(&make_bench_loop_problem), py::kw_only(), py::arg("records"), py::arg("noise"), py::arg("said"),
           py::arg("law") = "pid", py::arg("compensated") = true, py::arg("electronics") = false,
           py::arg("friction") = "acceleration_dependent", py::arg("valve") = "iso_0_4_mpa",
           py::arg("chambers") = "polytropic", py::arg("window") = 1.0, py::arg("longest_step") = 1e-3,
           py::arg("threads") = 1,
           "BenchProblem with the controller simulated. noise: of valve_command too, which is the last output where it "
           "is recorded. said: the controller as declared. A fourth hidden input: a voltage at the controller's "
           "output, V.");
}

void bind_tank(py::module_& m) {
  py::class_<est::TankPlantRecord>(m, "TankPlantRecord",
                                   "One evenly sampled record of the rig 'tank'; arrays (n,), SI, empty where there "
                                   "is no sensor.")
      .def(py::init(&make_tank_record), py::kw_only(), py::arg("step"), py::arg("command"), py::arg("pressure"),
           py::arg("temperature") = Eigen::VectorXd(), py::arg("supply_pressure") = Eigen::VectorXd(),
           py::arg("conditions") = std::map<std::string, double>(), py::arg("hold") = "linear",
           py::arg("valve") = "iso_0_4_mpa");
  auto tank = bind_shooting_problem<est::TankPlant, est::Problem>(m, "TankPlantProblem");
  bind_state(tank);
  tank.def(
      py::init(&make_tank_plant_problem), py::kw_only(), py::arg("records"), py::arg("noise"),
      py::arg("chambers") = "polytropic", py::arg("window") = 1.0, py::arg("longest_step") = 1e-3,
      py::arg("longest_step_elsewhere") = py::none(), py::arg("threads") = 1,
      "noise: standard deviation of a sample of tank_pressure, tank_temperature and supply_pressure. longest_step: "
      "of the integration, s; longest_step_elsewhere: where the command has rested for long; None: the same. Hidden "
      "inputs: a flow into the tank, kg/s, and a pressure at the head of the supply line, Pa.");
}

}  // namespace

void bind_plant_problems(py::module_& m) {
  py::class_<est::Window>(m, "Window", "A stretch of a record that is simulated from an initial state of its own.")
      .def_readonly("record", &est::Window::record)
      .def_readonly("first", &est::Window::first)
      .def_readonly("samples", &est::Window::samples)
      .def_readonly("row", &est::Window::row)
      .def_readonly("rows", &est::Window::rows)
      .def_readonly("start", &est::Window::start, "Where the search for its initial state begins.");
  bind_bench(m);
  bind_tank(m);
}

}  // namespace sms_python
