// The friction laws beyond the source's own, and the force balance solved for the acceleration, over numpy arrays that
// broadcast.
#include "broadcast.hpp"
#include "laws.hpp"

namespace sms_python {

using sms::FrictionLaw;

void bind_friction(py::module_& m) {
  m.def(
      "force_balance",
      [](const Params& p, const Array& extension, const Array& velocity, const Array& pressure_lower,
         const Array& pressure_upper, const Array& mass, const Array& drive, const Array& deflection,
         const std::string& law_name) {
        const FrictionLaw law = friction_law(law_name);
        const auto one = [&p, law](double x, double v, double lower, double upper, double kg, double force,
                                   double z) -> std::array<double, 3> {
          const auto b = sms::force_balance(p, law, {x, v, 0.0, lower, upper}, z, kg, force);
          return {b.acceleration, b.friction, b.deflection_rate};
        };
        return as_tuple(
            broadcast<3>(one, extension, velocity, pressure_lower, pressure_upper, mass, drive, deflection));
      },
      py::arg("params"), py::arg("extension"), py::arg("velocity"), py::arg("pressure_lower"),
      py::arg("pressure_upper"), py::arg("mass"), py::arg("drive"), py::arg("deflection") = 0.0,
      py::arg("law") = "acceleration_dependent",
      "(acceleration, m/s^2; friction, N; rate of the seals' deflection, m/s) of mass a = drive - friction, solved for "
      "a where friction depends on it; drive, N, is all other force, deflection, m, that of the seals. law: "
      "acceleration_dependent, two_branch, stribeck, dahl, lugre.");
}

}  // namespace sms_python
