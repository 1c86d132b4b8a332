// Dynamics of the mechanism, a row at a time through the C ABI.
#include <iterator>

#include "choice.hpp"
#include "rows.hpp"

namespace sms_python {
namespace {

// In the order of sms_mass_model.
const char* const mass_models[] = {"corrected", "table", "platform", "lumped"};

sms_mechanism mechanism_of(const Params& params, int masses) {
  sms_mechanism mechanism;
  const auto model = choice<sms_mass_model>("masses", masses, int(std::size(mass_models)));
  const sms_status status = sms_mechanism_from_params(&params, model, &mechanism);
  if (status != SMS_OK) {
    raise_status(status, std::string("the mechanism of these parameters: ") + sms_status_string(status));
  }
  return mechanism;
}

sms_wrench wrench_of(const double* force, const double* moment) {
  return {{force[0], force[1], force[2]}, {moment[0], moment[1], moment[2]}};
}

Answer forward_dynamics(const Params& params, int masses, const Rows& q, const Rows& qdot, const Rows& force,
                        const Rows& external_force, const Rows& external_moment) {
  const py::ssize_t n = common_row_count({&q, &qdot, &force, &external_force, &external_moment}, 3);
  const sms_mechanism mechanism = mechanism_of(params, masses);
  const double *const at = q.data(), *const rate = qdot.data(), *const push = force.data();
  const double *const pull = external_force.data(), *const turn = external_moment.data();
  const Output qddot(n, 3);
  return answer(qddot, each_row(n, {&qddot}, [&](py::ssize_t i) {
                  const sms_wrench wrench = wrench_of(pull + 3 * i, turn + 3 * i);
                  return sms_forward_dynamics(&mechanism, at + 3 * i, rate + 3 * i, push + 3 * i, &wrench, nullptr,
                                              qddot.row(i));
                }));
}

Answer inverse_dynamics(const Params& params, int masses, const Rows& q, const Rows& qdot, const Rows& qddot,
                        const Rows& external_force, const Rows& external_moment) {
  const py::ssize_t n = common_row_count({&q, &qdot, &qddot, &external_force, &external_moment}, 3);
  const sms_mechanism mechanism = mechanism_of(params, masses);
  const double *const at = q.data(), *const rate = qdot.data(), *const acceleration = qddot.data();
  const double *const pull = external_force.data(), *const turn = external_moment.data();
  const Output force(n, 3);
  return answer(force, each_row(n, {&force}, [&](py::ssize_t i) {
                  const sms_wrench wrench = wrench_of(pull + 3 * i, turn + 3 * i);
                  return sms_inverse_dynamics(&mechanism, at + 3 * i, rate + 3 * i, acceleration + 3 * i, &wrench,
                                              nullptr, force.row(i));
                }));
}

Answer dynamics_terms(const Params& params, int masses, const Rows& q, const Rows& qdot) {
  const py::ssize_t n = common_row_count({&q, &qdot}, 3);
  const sms_mechanism mechanism = mechanism_of(params, masses);
  const double *const at = q.data(), *const rate = qdot.data();
  static_assert(sizeof(sms_dynamics) == 32 * sizeof(double), "");
  const Output terms(n, 32);
  return answer(terms, each_row(n, {&terms}, [&](py::ssize_t i) {
                  return sms_dynamics_at(&mechanism, at + 3 * i, rate + 3 * i, nullptr, terms.row_as<sms_dynamics>(i));
                }));
}

Answer linearise(const Params& params, int masses, const Rows& q, const Rows& force, const Rows& stiffness,
                 const Rows& damping) {
  const py::ssize_t n = common_row_count({&q, &force, &stiffness, &damping}, 3);
  const sms_mechanism mechanism = mechanism_of(params, masses);
  const double *const at = q.data(), *const f = force.data(), *const k = stiffness.data(), *const d = damping.data();
  static_assert(sizeof(sms_linear_model) == 96 * sizeof(double), "");
  const Output model(n, 96);
  return answer(model, each_row(n, {&model}, [&](py::ssize_t i) {
                  sms_actuator_law law;
                  std::copy_n(f + 3 * i, 3, law.force);
                  std::copy_n(k + 3 * i, 3, law.stiffness);
                  std::copy_n(d + 3 * i, 3, law.damping);
                  return sms_linearise(&mechanism, at + 3 * i, &law, nullptr, model.row_as<sms_linear_model>(i));
                }));
}

Rows force_share(const Params& params, const Rows& force) {
  const py::ssize_t n = row_count(force, 3);
  const Output share(n, 1);
  for (py::ssize_t i = 0; i < n; ++i) {
    *share.row(i) = sms_force_share(&params, force.data() + 3 * i);
  }
  return share.array();
}

}  // namespace

void bind_dynamics(py::module_& m) {
  m.def(
      "mass_models", [] { return std::vector<std::string>(std::begin(mass_models), std::end(mass_models)); },
      "The names of sms_mass_model, in its order.");
  m.def("forward_dynamics", &forward_dynamics, py::arg("params"), py::arg("masses"), py::arg("q"), py::arg("qdot"),
        py::arg("force"), py::arg("external_force"), py::arg("external_moment"), "(n, 3) each -> (n, 3) q'', status.");
  m.def("inverse_dynamics", &inverse_dynamics, py::arg("params"), py::arg("masses"), py::arg("q"), py::arg("qdot"),
        py::arg("qddot"), py::arg("external_force"), py::arg("external_moment"),
        "(n, 3) each -> (n, 3) actuator forces, status.");
  m.def("dynamics_terms", &dynamics_terms, py::arg("params"), py::arg("masses"), py::arg("q"), py::arg("qdot"),
        "(n, 3) each -> (n, 32) sms_dynamics, status.");
  m.def("linearise", &linearise, py::arg("params"), py::arg("masses"), py::arg("q"), py::arg("force"),
        py::arg("stiffness"), py::arg("damping"), "(n, 3) each -> (n, 96) sms_linear_model, status.");
  m.def("force_share", &force_share, py::arg("params"), py::arg("force"),
        "(n, 3) actuator forces -> (n, 1) largest share of what the supply pressure gives.");
  m.def(
      "force_range",
      [](const Params& params) {
        double push = 0.0, pull = 0.0;
        sms_force_range(&params, &push, &pull);
        return py::typing::Tuple<double, double>(py::make_tuple(push, pull));
      },
      py::arg("params"), "What a cylinder can push and pull with, N.");
}

}  // namespace sms_python
