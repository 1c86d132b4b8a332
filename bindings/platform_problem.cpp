// The rig "platform" held against records, and the parameters of a machine with three legs.
#include <pybind11/eigen.h>

#include <memory>
#include <optional>

#include "estimation/platform_loop.hpp"
#include "estimation/poses.hpp"
#include "shooting_problem.hpp"

namespace sms_python {
namespace {

namespace est = sms::estimation;
using LegParams = sms::LegParams<double>;
using PlatformProblem = est::ShootingProblem<est::PlatformPlant>;
using PlatformLoopProblem = est::ShootingProblem<est::PlatformLoopPlant>;
using Noise = std::map<std::string, double>;

// "chamber_leakage_lower" is that of all legs, "chamber_leakage_lower:2" what leg 2 has more.
int leg_param_index(const std::string& name) {
  const std::size_t colon = name.find(':');
  if (colon == std::string::npos) {
    return sms::leg_param_index(param_index(name), 0);
  }
  const std::string leg = name.substr(colon + 1);
  if (leg != "1" && leg != "2" && leg != "3") {
    throw py::key_error("'" + name + "' names no leg: there are :1, :2 and :3");
  }
  return sms::leg_param_index(param_index(name.substr(0, colon)), leg[0] - '0');
}

std::vector<Params> legs_of(const LegParams& params) {
  return {sms::params_of_leg(params, 0), sms::params_of_leg(params, 1), sms::params_of_leg(params, 2)};
}

void bind_leg_params(py::module_& m) {
  py::class_<LegParams, Params>(
      m, "LegParams",
      "Parameters of a machine with three legs: \"name\" is that of all legs, \"name:2\" by how much "
      "that of leg 2 is larger, zero unless it is set.")
      .def(py::init<const Params&>(), py::arg("common") = Params())
      .def("__getitem__",
           [](const LegParams& p, const std::string& name) {
             return sms::param(const_cast<LegParams&>(p), leg_param_index(name));
           })
      .def("__setitem__",
           [](LegParams& p, const std::string& name, double value) {
             const int index = leg_param_index(name);
             if (!std::isfinite(value)) {
               raise_status(SMS_NOT_A_NUMBER, name + " is not a finite number");
             }
             sms::param(p, index) = value;
           })
      .def("copy", [](const LegParams& p) { return LegParams(p); })
      .def_property_readonly("legs", &legs_of, "What each leg has, as simulate_platform takes it.");
}

// (n, 3), or (0, 3) for what was not recorded.
est::LegSignals columns(const Eigen::MatrixX3d& signals) { return {signals.col(0), signals.col(1), signals.col(2)}; }

est::PlatformRecord make_record(double step, const Eigen::MatrixX3d& command, const Eigen::MatrixX3d& extension,
                                const Eigen::MatrixX3d& pressure_lower, const Eigen::MatrixX3d& pressure_upper,
                                Eigen::VectorXd supply_pressure, Eigen::VectorXd roll, Eigen::VectorXd pitch,
                                const std::map<std::string, double>& conditions, const Eigen::MatrixX3d& setpoint,
                                const std::string& hold) {
  return {time_step("step", step),   columns(command),           columns(extension), columns(pressure_lower),
          columns(pressure_upper),   std::move(supply_pressure), std::move(roll),    std::move(pitch),
          conditions_of(conditions), columns(setpoint),          hold_of(hold)};
}

Eigen::Vector3d of_legs(const Noise& noise, const std::string& signal) {
  return {noise_of(noise, signal + "_1"), noise_of(noise, signal + "_2"), noise_of(noise, signal + "_3")};
}

est::PlatformNoise platform_noise(const Noise& noise) {
  return {of_legs(noise, "extension"),
          of_legs(noise, "chamber_pressure_lower"),
          of_legs(noise, "chamber_pressure_upper"),
          noise_of(noise, "supply_pressure"),
          {noise_of(noise, "roll"), noise_of(noise, "pitch")}};
}

std::unique_ptr<PlatformProblem> make_problem(std::vector<est::PlatformRecord> records, const Noise& noise,
                                              const std::string& friction, const std::string& valve,
                                              const std::string& chambers, int masses, double window,
                                              double longest_step, const std::optional<double>& elsewhere,
                                              int threads) {
  need_commands(records, [](const est::PlatformRecord& record) -> const Eigen::VectorXd& { return record.command[0]; });
  return std::make_unique<PlatformProblem>(
      est::PlatformPlant(std::move(records), platform_noise(noise), laws_of(friction, valve, chambers),
                         choice<sms::MassModel>("masses", masses, 4), longest_steps(longest_step, elsewhere)),
      options_of(window, threads));
}

std::unique_ptr<PlatformLoopProblem> make_loop_problem(std::vector<est::PlatformRecord> records, const Noise& noise,
                                                       const LegParams& said, const std::string& law, bool compensated,
                                                       bool electronics, const std::string& friction,
                                                       const std::string& valve, const std::string& chambers,
                                                       int masses, double window, double longest_step, int threads) {
  sms::ActuatorLaws laws = laws_of(friction, valve, chambers);
  laws.drive = electronics ? sms::DriveLaw::filtered : sms::DriveLaw::direct;
  return std::make_unique<PlatformLoopProblem>(
      est::PlatformLoopPlant(std::move(records), platform_noise(noise), of_legs(noise, "valve_command"), laws,
                             control_law(law, compensated, electronics), said,
                             choice<sms::MassModel>("masses", masses, 4), time_step("longest_step", longest_step)),
      options_of(window, threads));
}

// Residual and Jacobian, where a parameter may be that of one leg.
template <typename Problem, typename Class>
void bind_evaluate(Class& problem) {
  problem.def_property_readonly("rows", &Problem::rows)
      .def(
          "evaluate",
          [](const Problem& p, const LegParams& params, const std::vector<std::string>& free) {
            return evaluate_with_legs(p, params, free);
          },
          py::arg("params"), py::arg("free") = std::vector<std::string>(),
          "(residual (rows,), jacobian (rows, free)): predicted minus measured over the noise, and its derivatives.");
}

// ---- the mechanism as built ----

std::unique_ptr<est::PoseProblem> make_pose_problem(est::RowMatrix extension, est::RowMatrix pose,
                                                    Eigen::VectorXd extension_noise, Eigen::VectorXd pose_noise,
                                                    const LegParams& start, const est::RowMatrix& ground_marks,
                                                    const est::RowMatrix& platform_marks) {
  const Eigen::Index distances = ground_marks.rows();
  if (platform_marks.rows() != distances ||
      (distances > 0 && (ground_marks.cols() != 3 || platform_marks.cols() != 3))) {
    throw py::value_error("ground_marks and platform_marks are (distances, 3)");
  }
  std::vector<est::MarkedDistance> marks;
  for (Eigen::Index d = 0; d < distances; ++d) {
    marks.push_back({ground_marks.row(d).transpose(), platform_marks.row(d).transpose()});
  }
  return std::make_unique<est::PoseProblem>(
      est::MeasuredPoses{std::move(extension), std::move(pose), std::move(extension_noise), std::move(pose_noise),
                         std::move(marks)},
      start);
}

est::Calibration calibrate(const est::PoseProblem& problem, const LegParams& start,
                           const std::vector<std::string>& free, const Eigen::VectorXd& tolerance, double huber,
                           int max_iterations) {
  std::vector<int> indices;
  for (const std::string& name : free) {
    indices.push_back(leg_param_index(name));
  }
  py::gil_scoped_release unlocked;
  return est::calibrate(problem, start, indices, tolerance, huber, max_iterations);
}

void bind_poses(py::module_& m) {
  auto problem =
      py::class_<est::PoseProblem>(m, "PoseProblem",
                                   "Measured poses against the forward kinematics of the extensions read with them, "
                                   "whitened: extension (n, 3) m, "
                                   "pose (n, 6 + distances) roll, pitch, height, yaw, x, y in rad and m and distances "
                                   "between marks (distances, 3), which are given in world axes with the platform at "
                                   "rest; NaN where it was not measured; noises (3,) and (6 + distances,), "
                                   "standard deviations.")
          .def(py::init(&make_pose_problem), py::kw_only(), py::arg("extension"), py::arg("pose"),
               py::arg("extension_noise"), py::arg("pose_noise"), py::arg("start"),
               py::arg("ground_marks") = est::RowMatrix(0, 3), py::arg("platform_marks") = est::RowMatrix(0, 3))
          .def("predict", &est::PoseProblem::predict, py::arg("params"),
               "(n, 6 + distances): what the pose sensors should read; NaN where the parameters have no pose.")
          .def_property_readonly("first_row", &est::PoseProblem::first_row, "Of each pose, and the number of rows.");
  bind_evaluate<est::PoseProblem>(problem);
  py::class_<est::Calibration>(m, "Calibration", "The mechanism that comes closest to measured poses.")
      .def_readonly("params", &est::Calibration::params)
      .def_readonly("residual", &est::Calibration::residual, "(rows,), whitened, at params")
      .def_readonly("jacobian", &est::Calibration::jacobian, "(rows, free), whitened, at params")
      .def_readonly("iterations", &est::Calibration::iterations)
      .def_readonly("converged", &est::Calibration::converged)
      .def_readonly("message", &est::Calibration::message);
  m.def("calibrate", &calibrate, py::arg("problem"), py::arg("start"), py::arg("free"), py::arg("tolerance"),
        py::arg("huber") = 0.0, py::arg("max_iterations") = 100,
        "Least squares over the parameters `free`, each held to its start by a standard deviation `tolerance`, by "
        "Huber's loss on poses beyond `huber` standard deviations; ValueError for a bad start.");
}

}  // namespace

std::pair<Eigen::VectorXd, est::RowMatrix> evaluate_with_legs(const est::ProblemOf<LegParams>& problem,
                                                              const LegParams& params,
                                                              const std::vector<std::string>& names) {
  return evaluate_by_name(problem, params, names, &leg_param_index);
}

void bind_platform_problem(py::module_& m) {
  bind_leg_params(m);
  bind_poses(m);
  py::class_<est::PlatformRecord>(m, "PlatformRecord",
                                  "One evenly sampled record of the rig 'platform'; arrays (n, 3), a column a leg, SI.")
      .def(
          py::init(&make_record), py::kw_only(), py::arg("step"), py::arg("command"), py::arg("extension"),
          py::arg("pressure_lower"), py::arg("pressure_upper"), py::arg("supply_pressure") = Eigen::VectorXd(),
          py::arg("roll") = Eigen::VectorXd(), py::arg("pitch") = Eigen::VectorXd(),
          py::arg("conditions") = std::map<std::string, double>(), py::arg("setpoint") = Eigen::MatrixX3d(),
          py::arg("hold") = "linear",
          "setpoint: of a loop that is simulated, where command may be empty: not measured. hold: what the valves have "
          "between two samples of the commands, \"linear\" or the \"previous\" one.");
  auto problem = bind_shooting_problem<est::PlatformPlant>(m, "PlatformProblem");
  bind_evaluate<PlatformProblem>(problem);
  problem.def(
      py::init(&make_problem), py::kw_only(), py::arg("records"), py::arg("noise"),
      py::arg("friction") = "acceleration_dependent", py::arg("valve") = "iso_0_4_mpa",
      py::arg("chambers") = "polytropic", py::arg("masses") = 0, py::arg("window") = 1.0,
      py::arg("longest_step") = 2.5e-3, py::arg("longest_step_elsewhere") = py::none(), py::arg("threads") = 1,
      "noise: standard deviation of a sample of extension_1 .. 3, chamber_pressure_lower_1 .. 3, "
      "chamber_pressure_upper_1 .. 3, supply_pressure, roll and pitch. longest_step: of the integration, s; "
      "longest_step_elsewhere: where the recorded extensions say that all pistons are well on their way; None: the "
      "same. Hidden inputs: forces on the three pistons, "
      "N, and flows into the three lower and the three upper chambers, kg/s.");
  auto loop = bind_shooting_problem<est::PlatformLoopPlant>(m, "PlatformLoopProblem");
  bind_evaluate<PlatformLoopProblem>(loop);
  loop.def(py::init(&make_loop_problem), py::kw_only(), py::arg("records"), py::arg("noise"), py::arg("said"),
           py::arg("law") = "pid", py::arg("compensated") = true, py::arg("electronics") = false,
           py::arg("friction") = "acceleration_dependent", py::arg("valve") = "iso_0_4_mpa",
           py::arg("chambers") = "polytropic", py::arg("masses") = 0, py::arg("window") = 1.0,
           py::arg("longest_step") = 2.5e-3, py::arg("threads") = 1,
           "PlatformProblem with the controller of each leg simulated. noise: of valve_command_1 .. 3 too, which are "
           "the last outputs where they are recorded. said: the machine as declared. Three more hidden inputs: a "
           "voltage at each controller's output, V.");
}

}  // namespace sms_python
