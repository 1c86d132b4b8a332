// Problems and fits. The records come as numpy arrays; Ceres runs without Python's lock.
#include <pybind11/eigen.h>

#include "bind.hpp"
#include "choice.hpp"
#include "estimation/cylinder.hpp"
#include "estimation/fit.hpp"
#include "estimation/spool.hpp"
#include "estimation/tank.hpp"
#include "laws.hpp"
#include "shooting_problem.hpp"

namespace sms_python {
namespace {

namespace est = sms::estimation;

est::CylinderRecord make_cylinder_record(Eigen::VectorXd extension, Eigen::VectorXd velocity,
                                         Eigen::VectorXd acceleration, Eigen::VectorXd pressure_lower,
                                         Eigen::VectorXd rod_force, Eigen::VectorXd pressure_upper, bool gauge_lower,
                                         bool gauge_upper, Eigen::VectorXd time) {
  return {std::move(extension),
          std::move(velocity),
          std::move(acceleration),
          std::move(pressure_lower),
          std::move(pressure_upper),
          std::move(rod_force),
          std::move(time),
          gauge_lower,
          gauge_upper};
}

est::TankProblem make_tank_problem(Eigen::VectorXd time, Eigen::VectorXd pressure, bool charge,
                                   Eigen::VectorXd temperature, Eigen::VectorXd supply, const std::string& law,
                                   const std::string& heat) {
  sms::FlowTestKind kind;
  kind.law = choice<sms::FlowLaw>("law", law, {{"iso", sms::FlowLaw::iso}, {"classic", sms::FlowLaw::classic}});
  kind.heat = choice<sms::ChamberLaw>(
      "heat", heat, {{"polytropic", sms::ChamberLaw::polytropic}, {"energy", sms::ChamberLaw::energy}});
  return {{std::move(time), std::move(pressure), std::move(temperature), std::move(supply), charge}, kind};
}

using NamedBounds = std::tuple<std::string, double, double, double>;

est::Fit fit(const est::Problem& problem, const Params& start, const std::vector<NamedBounds>& free,
             const Eigen::VectorXd& weight, int max_iterations, double tolerance, double huber) {
  std::vector<est::FreeParam> bounds;
  for (const NamedBounds& f : free) {
    bounds.push_back({param_index(std::get<0>(f)), std::get<1>(f), std::get<2>(f), std::get<3>(f)});
  }
  est::FitOptions options;
  options.max_iterations = max_iterations;
  options.tolerance = tolerance;
  options.huber = huber;
  const Exclusive alone(&problem);
  return est::fit(problem, start, bounds, weight, options);
}

std::pair<Eigen::VectorXd, est::RowMatrix> evaluate(const est::Problem& problem, const Params& params,
                                                    const std::vector<std::string>& names) {
  return evaluate_by_name(problem, params, names, &param_index);
}

// ---- spool ----

est::SpoolRecord make_spool_record(double step, Eigen::VectorXd command, Eigen::VectorXd position) {
  return {time_step("step", step), std::move(command), std::move(position)};
}

void bind_spool(py::module_& m) {
  py::class_<est::SpoolRecord>(m, "SpoolRecord", "Command and measured spool position, evenly sampled; (n,), SI.")
      .def(py::init(&make_spool_record), py::kw_only(), py::arg("step"), py::arg("command"), py::arg("position"))
      .def_property_readonly("first_compared", &est::SpoolProblem::first_compared,
                             "Sample from which on positions are compared; before it the spool is run up.");
  py::class_<est::SpoolProblem, est::Problem>(m, "SpoolProblem", "Predicted less measured spool position, m.")
      .def(py::init([](std::vector<est::SpoolRecord> records, const std::string& law) {
             return est::SpoolProblem(std::move(records), choice<est::SpoolLaw>("law", law,
                                                                                {{"cubic", est::SpoolLaw::cubic},
                                                                                 {"linear", est::SpoolLaw::linear}}));
           }),
           py::arg("records"), py::arg("law") = "cubic", "law: cubic (eq. 4.1) or linear (eq. 4.2).");
}

}  // namespace

void bind_estimation(py::module_& m) {
  py::class_<est::CylinderRecord>(m, "CylinderRecord",
                                  "The compared samples of one record of the rig 'cylinder', as read; arrays (n,), SI.")
      .def(py::init(&make_cylinder_record), py::kw_only(), py::arg("extension"), py::arg("velocity"),
           py::arg("acceleration"), py::arg("pressure_lower"), py::arg("rod_force"),
           py::arg("pressure_upper") = Eigen::VectorXd(), py::arg("gauge_lower") = false,
           py::arg("gauge_upper") = false, py::arg("time") = Eigen::VectorXd());

  py::class_<est::Problem>(m, "Problem", "A model held against measured records.")
      .def_property_readonly("rows", &est::Problem::rows)
      .def("evaluate", &evaluate, py::arg("params"), py::arg("free") = std::vector<std::string>(),
           "(residual (rows,), jacobian (rows, free)): predicted minus measured, and its exact derivatives.");
  py::class_<est::CylinderProblem, est::Problem>(m, "CylinderProblem")
      .def(py::init([](std::vector<est::CylinderRecord> records, const std::string& law) {
             return est::CylinderProblem(std::move(records), friction_law(law));
           }),
           py::arg("records"), py::arg("law") = "acceleration_dependent",
           "law: acceleration_dependent, two_branch, stribeck; dahl and lugre need the records' time.");

  py::class_<est::TankProblem, est::Problem>(
      m, "TankProblem",
      "One charge or discharge of a tank: time s, pressure Pa absolute as read, temperature K of a thermocouple and "
      "supply Pa absolute where they were measured; arrays (n,). Residuals: pressures, then temperatures.")
      .def(py::init(&make_tank_problem), py::kw_only(), py::arg("time"), py::arg("pressure"), py::arg("charge"),
           py::arg("temperature") = Eigen::VectorXd(), py::arg("supply") = Eigen::VectorXd(), py::arg("law") = "iso",
           py::arg("heat") = "polytropic")
      .def_property_readonly("step", &est::TankProblem::step, "s, of the integration");

  bind_plant_problems(m);
  bind_spool(m);

  py::class_<est::Fit>(m, "Fit", "The result of a least-squares fit.")
      .def_readonly("params", &est::Fit::params)
      .def_readonly("residual", &est::Fit::residual, "(rows,), predicted minus measured at params, not weighted")
      .def_readonly("jacobian", &est::Fit::jacobian, "(rows, free), not weighted")
      .def_readonly("at_bound", &est::Fit::at_bound)
      .def_readonly("cost", &est::Fit::cost, "sum of the squared weighted residuals")
      .def_readonly("condition", &est::Fit::condition,
                    "condition number of the weighted jacobian with columns of length one")
      .def_readonly("iterations", &est::Fit::iterations)
      .def_readonly("converged", &est::Fit::converged)
      .def_readonly("message", &est::Fit::message);
  m.def("fit", &fit, py::arg("problem"), py::arg("start"), py::arg("free"), py::arg("weight") = Eigen::VectorXd(),
        py::arg("max_iterations") = 100, py::arg("tolerance") = 1e-12, py::arg("huber") = 0.0,
        "Least squares over the parameters free = [(name, lower, upper, pull), ...], by Huber's loss beyond `huber` "
        "weighted units; ValueError for a bad start and for a parameter to which the records are insensitive.");
}

}  // namespace sms_python
