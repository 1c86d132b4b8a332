// What every plant that is held against records window by window (estimation/shooting.hpp) shows to Python.
#pragma once

#include <pybind11/eigen.h>

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "bind.hpp"
#include "choice.hpp"
#include "estimation/actuator_controller.hpp"
#include "estimation/leg_params.hpp"
#include "estimation/shooting.hpp"
#include "laws.hpp"
#include "sms/actuator.hpp"

namespace sms_python {

// window: length, s
inline sms::estimation::WindowOptions options_of(double window, int threads) {
  sms::estimation::WindowOptions options;
  options.length = window;
  options.threads = threads;
  return options;
}

// (ParamIndex, by how much it is larger) from names.
inline std::vector<std::pair<int, double>> conditions_of(const std::map<std::string, double>& by_name) {
  std::vector<std::pair<int, double>> conditions;
  for (const auto& condition : by_name) {
    conditions.emplace_back(param_index(condition.first), condition.second);
  }
  return conditions;
}

inline sms::ValveLaw valve_law_of(const std::string& valve) {
  using sms::ValveLaw;
  return choice<ValveLaw>(
      "valve", valve,
      {{"iso_0_4_mpa", ValveLaw::iso_0_4_mpa}, {"iso_0_2_mpa", ValveLaw::iso_0_2_mpa}, {"classic", ValveLaw::classic}});
}

inline sms::ActuatorLaws laws_of(const std::string& friction, const std::string& valve, const std::string& chambers) {
  using sms::ChamberLaw;
  return {valve_law_of(valve), friction_law(friction),
          choice<ChamberLaw>("chambers", chambers,
                             {{"polytropic", ChamberLaw::polytropic}, {"energy", ChamberLaw::energy}}),
          sms::DriveLaw::direct};
}

inline sms::estimation::Hold hold_of(const std::string& hold) {
  using sms::estimation::Hold;
  return choice<Hold>("hold", hold, {{"linear", Hold::linear}, {"previous", Hold::previous}});
}

inline sms::estimation::ControlLaw control_law(const std::string& law, bool compensated, bool electronics) {
  using sms::PositionControl;
  return {choice<PositionControl>("law", law,
                                  {{"pid", PositionControl::pid}, {"state_feedback", PositionControl::state_feedback}}),
          compensated, electronics};
}

// Residual and Jacobian against parameters by name; `index` gives the ParamIndex of one.
template <typename Machine>
std::pair<Eigen::VectorXd, sms::estimation::RowMatrix> evaluate_by_name(
    const sms::estimation::ProblemOf<Machine>& problem, const Machine& params, const std::vector<std::string>& names,
    int (*index)(const std::string&)) {
  std::vector<int> free;
  for (const std::string& name : names) {
    free.push_back(index(name));
  }
  Eigen::VectorXd residual;
  sms::estimation::RowMatrix jacobian;
  py::gil_scoped_release unlocked;
  problem.evaluate(params, free, &residual, free.empty() ? nullptr : &jacobian);
  if (free.empty()) {
    jacobian.resize(problem.rows(), 0);
  }
  return {residual, jacobian};
}

// Base: what Python knows it derives from, if anything.
template <typename Plant, typename... Base>
auto bind_shooting_problem(py::module_& m, const char* name) {
  using Problem = sms::estimation::ShootingProblem<Plant>;
  py::class_<Problem, Base...> problem(
      m, name, "Prediction errors over windows, in units of the noise: for each sample of a window, each output.");
  problem.def_property_readonly("windows", &Problem::windows)
      .def("settle", &Problem::settle, py::arg("params"), py::call_guard<py::gil_scoped_release>(),
           "Let later searches for initial states begin at the best ones of these parameters.")
      .def("errors", &Problem::errors, py::arg("params"), py::call_guard<py::gil_scoped_release>(),
           "(rows,): predicted less measured over the noise, at the best initial states.")
      .def("hidden", &Problem::hidden, py::arg("params"), py::arg("knots"), py::call_guard<py::gil_scoped_release>(),
           "(rows, inputs x knots): derivatives against inputs that are hidden in the equations, in each window.");
  return problem;
}

// shooting_problem.cpp
void bind_plant_problems(py::module_& m);

// platform_problem.cpp: residual and Jacobian where a parameter may be that of one leg, "name:2".
std::pair<Eigen::VectorXd, sms::estimation::RowMatrix> evaluate_with_legs(
    const sms::estimation::ProblemOf<sms::LegParams<double>>& problem, const sms::LegParams<double>& params,
    const std::vector<std::string>& names);

}  // namespace sms_python
