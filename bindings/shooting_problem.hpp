// What every plant that is held against records window by window (estimation/shooting.hpp) shows to Python.
#pragma once

#include <pybind11/eigen.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bind.hpp"
#include "choice.hpp"
#include "estimation/actuator_controller.hpp"
#include "estimation/leg_params.hpp"
#include "estimation/sample_steps.hpp"
#include "estimation/shooting.hpp"
#include "exclusive.hpp"
#include "laws.hpp"
#include "sms/actuator.hpp"

namespace sms_python {

// Standard deviation of a sample of a signal.
inline double noise_of(const std::map<std::string, double>& noise, const std::string& signal) {
  const auto found = noise.find(signal);
  if (found == noise.end()) {
    throw py::key_error("noise has no standard deviation of '" + signal + "'");
  }
  if (!(found->second > 0.0)) {
    throw py::value_error("noise of " + signal + " is " + number(found->second) +
                          "; a standard deviation is above zero");
  }
  return found->second;
}

// window: length, s
inline sms::estimation::WindowOptions options_of(double window, int threads) {
  if (threads < 1) {
    throw py::value_error("threads = " + std::to_string(threads) + "; at least one is needed");
  }
  sms::estimation::WindowOptions options;
  options.length = window;
  options.threads = threads;
  return options;
}

// Of the integration, s, and where the record says that nothing asks for short ones; none: the same.
inline sms::estimation::LongestSteps longest_steps(double everywhere, const std::optional<double>& elsewhere) {
  return {time_step("longest_step", everywhere), time_step("longest_step_elsewhere", elsewhere.value_or(everywhere))};
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
  return {valve_law_of(valve), friction_law(friction, "friction"),
          choice<ChamberLaw>("chambers", chambers,
                             {{"polytropic", ChamberLaw::polytropic}, {"energy", ChamberLaw::energy}}),
          sms::DriveLaw::direct};
}

inline sms::estimation::Hold hold_of(const std::string& hold) {
  using sms::estimation::Hold;
  return choice<Hold>("hold", hold,
                      {{"linear", Hold::linear}, {"previous", Hold::previous}, {"stepped", Hold::stepped}});
}

inline sms::estimation::ControlLaw control_law(const std::string& law, bool compensated, bool electronics) {
  using sms::PositionControl;
  return {choice<PositionControl>("law", law,
                                  {{"pid", PositionControl::pid}, {"state_feedback", PositionControl::state_feedback}}),
          compensated, electronics};
}

// A record may lack its command, for a problem that simulates the controller; for others ValueError.
template <typename Record, typename Command>
void need_commands(const std::vector<Record>& records, const Command& command_of) {
  for (std::size_t i = 0; i < records.size(); ++i) {
    if (command_of(records[i]).size() == 0) {
      throw py::value_error("record " + std::to_string(i) +
                            " has no command, which a problem without a simulated "
                            "controller needs");
    }
  }
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
  const Exclusive alone(&problem);
  problem.evaluate(params, free, &residual, free.empty() ? nullptr : &jacobian);
  if (free.empty()) {
    jacobian.resize(problem.rows(), 0);
  }
  return {residual, jacobian};
}

template <typename Problem>
std::vector<sms::estimation::Window> windows_of(const Problem& problem) {
  const Exclusive alone(&problem);
  return problem.windows();
}

// Base: what Python knows it derives from, if anything.
template <typename Plant, typename... Base>
auto bind_shooting_problem(py::module_& m, const char* name) {
  using Problem = sms::estimation::ShootingProblem<Plant>;
  py::class_<Problem, Base...> problem(
      m, name, "Prediction errors over windows, in units of the noise: for each sample of a window, each output.");
  problem.def_property_readonly("windows", &windows_of<Problem>)
      .def(
          "settle",
          [](Problem& p, const typename Problem::template Machine<double>& params) {
            const Exclusive alone(&p);
            p.settle(params);
          },
          py::arg("params"), "Let later searches for initial states begin at the best ones of these parameters.")
      .def(
          "errors",
          [](const Problem& p, const typename Problem::template Machine<double>& params) {
            const Exclusive alone(&p);
            return p.errors(params);
          },
          py::arg("params"), "(rows,): predicted less measured over the noise, at the best initial states.")
      .def(
          "hidden",
          [](const Problem& p, const typename Problem::template Machine<double>& params, int knots) {
            int most = 2;
            for (const sms::estimation::Window& window : windows_of(p)) {
              most = std::max(most, window.samples);
            }
            if (knots < 2 || knots > most) {
              throw py::value_error("knots = " + std::to_string(knots) + "; from 2 to " + std::to_string(most) +
                                    ", as many as a window has samples, are possible");
            }
            const Exclusive alone(&p);
            return p.hidden(params, knots);
          },
          py::arg("params"), py::arg("knots"),
          "(rows, inputs x knots): derivatives against inputs that are hidden in the equations, in each window.")
      .def(
          "jumps",
          [](const Problem& p, const typename Problem::template Machine<double>& params) {
            const Exclusive alone(&p);
            return p.jumps(params);
          },
          py::arg("params"),
          "(rows, commands x 8): derivatives against the time, s, by which the largest jumps of each window's command "
          "come further ahead of the sample that shows them; zeros where there are fewer.")
      .def(
          "jump_samples",
          [](const Problem& p) {
            const Exclusive alone(&p);
            return p.jump_samples();
          },
          "(windows, commands x 8): the samples of the record that show them; -1 where there are fewer.")
      .def(
          "set_ahead",
          [](Problem& p, int record, int command, const Eigen::VectorXd& ahead) {
            const Exclusive alone(&p);
            if (record < 0 || record >= p.plant().records() || command < 0 || command >= Plant::kCommands) {
              throw py::index_error("there is no command " + std::to_string(command) + " of a record " +
                                    std::to_string(record));
            }
            if (ahead.size() != p.plant().samples(record)) {
              throw py::value_error("ahead has " + std::to_string(ahead.size()) + " values; the record has " +
                                    std::to_string(p.plant().samples(record)) + " samples");
            }
            const double step = p.plant().step(record);
            if (!(ahead.array() >= 0.0 && ahead.array() <= step).all()) {
              throw py::value_error("ahead: a jump comes from 0 to " + std::to_string(step) +
                                    " s, a sampling period, ahead of the sample that shows it");
            }
            p.set_ahead(record, command, ahead);
          },
          py::arg("record"), py::arg("command"), py::arg("ahead"),
          "ahead (samples,), s: by how much the jump that a sample shows came ahead of it. From now on that is known.");
  return problem;
}

// shooting_problem.cpp
void bind_plant_problems(py::module_& m);

// platform_problem.cpp: residual and Jacobian where a parameter may be that of one leg, "name:2".
std::pair<Eigen::VectorXd, sms::estimation::RowMatrix> evaluate_with_legs(
    const sms::estimation::ProblemOf<sms::LegParams<double>>& problem, const sms::LegParams<double>& params,
    const std::vector<std::string>& names);

}  // namespace sms_python
