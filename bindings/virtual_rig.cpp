// The virtual rig: the firmware's application over a simulated platform, some periods at a time.
#include "virtual_rig.hpp"

#include <array>
#include <memory>
#include <string>

#include "bind.hpp"
#include "choice.hpp"
#include "sip_key.hpp"
#include "sms/compiled_mechanism.hpp"

namespace sms_python {
namespace {

using sms::firmware::RigFault;

RigFault fault_of(const std::string& name) {
  return choice<RigFault>("fault", name,
                          {{"sensor_broken", RigFault::sensor_broken},
                           {"sensor_stuck", RigFault::sensor_stuck},
                           {"sensor_jump", RigFault::sensor_jump},
                           {"valve_stuck", RigFault::valve_stuck},
                           {"supply_lost", RigFault::supply_lost},
                           {"enable_open", RigFault::enable_open},
                           {"bus_off", RigFault::bus_off},
                           {"loop_overrun", RigFault::loop_overrun},
                           {"hang", RigFault::hang}});
}

class VirtualRig {
 public:
  VirtualRig(const std::array<Params, 3>& params, double height, double mean_pressure, double step,
             double position_noise, double pressure_noise, unsigned seed, const py::bytes& key, std::uint64_t nonce)
      : rig_(platform(params), {position_noise, pressure_noise}, seed) {
    need_finite(position_noise, "position_noise");
    need_finite(pressure_noise, "pressure_noise");
    rig_.set_key(sip_key(key), nonce);
    const sms_status status = rig_.begin(height, mean_pressure, time_step("step", step));
    if (status != SMS_OK) {
      raise_status(status, "the virtual rig cannot begin: " + std::string(sms_status_string(status)));
    }
  }

  bool receive(unsigned identifier, const py::bytes& data) {
    const std::string octets = data;
    sms_frame frame{};
    frame.identifier = uint_least16_t(identifier);
    frame.length = uint_least16_t(octets.size());
    for (std::size_t i = 0; i < std::min<std::size_t>(octets.size(), 8); ++i) {
      frame.octet[i] = uint_least16_t(static_cast<unsigned char>(octets[i]));
    }
    return rig_.receive(frame);
  }

  // Frames of so many periods: (time, identifier, data), time at the end of the period that sent it, s.
  py::list step(int periods) {
    if (periods < 0 || periods > kMostPeriods) {
      throw py::value_error("periods = " + std::to_string(periods) + "; from 0 to " + std::to_string(kMostPeriods) +
                            " are run in one call");
    }
    py::list frames;
    for (int i = 0; i < periods; ++i) {
      if (PyErr_CheckSignals() != 0) {  // Ctrl-C
        throw py::error_already_set();
      }
      const sms_status status = rig_.step();
      if (status != SMS_OK) {
        raise_status(status, "the simulated plant stops after " + std::to_string(rig_.time()) +
                                 " s: " + sms_status_string(status));
      }
      for (int k = 0; k < rig_.frames_out(); ++k) {
        const sms_frame& frame = rig_.frame_out(k);
        char octets[8];
        for (int j = 0; j < 8; ++j) {
          octets[j] = static_cast<char>(frame.octet[j] & 0xFFu);
        }
        frames.append(py::make_tuple(rig_.time(), int(frame.identifier), py::bytes(octets, frame.length)));
      }
    }
    return frames;
  }

  void set_fault(const std::string& name, int leg, double amount) {
    if (leg < 0 || leg >= SMS_LEGS) {
      throw py::value_error("leg is 0, 1 or 2");
    }
    rig_.set_fault(fault_of(name), leg, amount);
  }
  void clear_fault(const std::string& name) { rig_.clear_fault(fault_of(name)); }

  const sms::firmware::Application& application() const { return rig_.application(); }
  double time() const { return rig_.time(); }
  unsigned long evaluations() const { return rig_.evaluations(); }
  std::array<double, 3> pose() const {
    const auto& q = rig_.state().q;
    return {q(0), q(1), q(2)};
  }
  std::array<double, 3> extension() const {
    const auto& e = rig_.terms().extension;
    return {e(0), e(1), e(2)};
  }
  std::array<double, 3> extension_rate() const {
    const auto& v = rig_.terms().velocity;
    return {v(0), v(1), v(2)};
  }
  std::array<double, 3> pressures(bool lower) const {
    std::array<double, 3> found{};
    for (int i = 0; i < 3; ++i) {
      const auto& a = rig_.state().actuator[i];
      found[std::size_t(i)] = lower ? a.lower.pressure : a.upper.pressure;
    }
    return found;
  }

 private:
  static constexpr int kMostPeriods = 60000;

  static sms::Platform<double> platform(const std::array<Params, 3>& params) {
    sms::ActuatorLaws laws = sms::published_laws();
    laws.drive = sms::DriveLaw::filtered;
    auto plant = sms::make_platform(params[0], laws, sms::MassModel::corrected);
    for (int i = 0; i < 3; ++i) {
      plant.params[i] = params[std::size_t(i)];
    }
    return plant;
  }

  sms::firmware::VirtualRig rig_;
};

}  // namespace

void bind_virtual_rig(py::module_& m) {
  py::class_<VirtualRig>(m, "VirtualRig",
                         "The firmware's application over a simulated platform (libsms/firmware/virtual_rig.hpp).")
      .def(py::init<const std::array<Params, 3>&, double, double, double, double, double, unsigned, const py::bytes&,
                    std::uint64_t>(),
           py::kw_only(), py::arg("params"), py::arg("height"), py::arg("mean_pressure"), py::arg("step"),
           py::arg("position_noise"), py::arg("pressure_noise"), py::arg("seed"), py::arg("key") = py::bytes(),
           py::arg("nonce") = 0,
           "params of the plant, one set a leg; height m, mean_pressure Pa, step of the integrator s, noise in counts; "
           "key: 16 octets, then only authentic commands are obeyed; nonce: 64 bits, others in each run.")
      .def("receive", &VirtualRig::receive, py::arg("identifier"), py::arg("data"),
           "Hand a frame to the controller; False: too many are waiting, it is lost.")
      .def("step", &VirtualRig::step, py::arg("periods"),
           "Run so many control periods; the frames sent: (time s, identifier, data).")
      .def("set_fault", &VirtualRig::set_fault, py::arg("name"), py::arg("leg"), py::arg("amount"))
      .def("clear_fault", &VirtualRig::clear_fault, py::arg("name"))
      .def_property_readonly("time", &VirtualRig::time, "s")
      .def_property_readonly("evaluations", &VirtualRig::evaluations, "Of the plant's derivative, so far.")
      .def_property_readonly("pose", &VirtualRig::pose, "The truth: roll, pitch, rad; height, m.")
      .def_property_readonly("extension", &VirtualRig::extension, "The truth, m.")
      .def_property_readonly("extension_rate", &VirtualRig::extension_rate, "The truth, m/s.")
      .def_property_readonly(
          "mode", [](const VirtualRig& r) { return int(r.application().mode); }, "Of the controller, value table Mode.")
      .def_property_readonly(
          "faults", [](const VirtualRig& r) { return sms::firmware::all(r.application().faults); },
          "Bit n - 1 is fault n of the value table Fault.")
      .def_property_readonly(
          "session", [](const VirtualRig& r) { return unsigned(r.application().link.session); },
          "The session in control, 0: nobody.")
      .def_property_readonly(
          "chamber_pressure_lower", [](const VirtualRig& r) { return r.pressures(true); }, "The truth, Pa.")
      .def_property_readonly(
          "chamber_pressure_upper", [](const VirtualRig& r) { return r.pressures(false); }, "The truth, Pa.");
}

}  // namespace sms_python
