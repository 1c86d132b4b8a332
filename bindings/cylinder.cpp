// Friction and force balance of one cylinder, over numpy arrays that broadcast.
#include <limits>

#include "broadcast.hpp"
#include "sms/force_balance.hpp"

namespace sms_python {
namespace {

using Samples = py::array_t<double, kAnyOrder>;
using Equation = double (*)(const Params&, const sms::Piston<double>&);

void def_of_piston(py::module_& m, const char* name, Equation equation, const char* doc) {
  m.def(
      name,
      [equation](const Params& params, const Samples& extension, const Samples& velocity, const Samples& acceleration,
                 const Samples& pressure_lower, const Samples& pressure_upper) {
        const auto one = [&params, equation](double x, double v, double a, double lower, double upper) {
          const sms::Piston<double> piston = {x, v, a, lower, upper};
          return sms::is_finite(piston) ? equation(params, piston) : std::numeric_limits<double>::quiet_NaN();
        };
        return each(one, extension, velocity, acceleration, pressure_lower, pressure_upper);
      },
      py::arg("params"), py::arg("extension"), py::arg("velocity"), py::arg("acceleration"), py::arg("pressure_lower"),
      py::arg("pressure_upper"), doc);
}

}  // namespace

void bind_cylinder(py::module_& m) {
  def_of_piston(m, "friction", &sms::friction<double>, "Friction force, N (eq. 6.5 to 6.7 with its effects).");
  def_of_piston(m, "rod_force", &sms::rod_force<double>, "Force of the rod on its load, N (eq. 6.4).");
  m.def(
      "friction_stribeck",
      [](const Params& params, const Samples& velocity) {
        const auto one = [&params](double v) {
          return sms::is_finite(v) ? sms::friction_stribeck(params, v) : std::numeric_limits<double>::quiet_NaN();
        };
        return each(one, velocity);
      },
      py::arg("params"), py::arg("velocity"), "The simple friction law, N (eq. 4.33).");
}

}  // namespace sms_python
