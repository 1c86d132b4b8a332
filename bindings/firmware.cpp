// The application of the firmware, tick by tick, and the codec of its bus: what the virtual rig and sms.link stand on.
#include <pybind11/stl.h>

#include <memory>

#include "application.hpp"
#include "bind.hpp"
#include "board_model.hpp"
#include "choice.hpp"
#include "sip_key.hpp"
#include "sms_firmware.h"

namespace sms_python {
namespace {

namespace fw = sms::firmware;
using FrameList = std::vector<std::pair<unsigned, py::bytes>>;

// ---- frames ----

sms::Frame frame_of(unsigned identifier, const py::bytes& data) {
  const auto text = static_cast<std::string>(data);
  sms::Frame f = {sms::Word(identifier), sms::Word(text.size()), {0, 0, 0, 0, 0, 0, 0, 0}};
  for (size_t i = 0; i < text.size() && i < sms::octets_per_frame; ++i) {
    f.octet[i] = sms::Word(static_cast<unsigned char>(text[i]));
  }
  return f;
}

py::bytes data_of(const sms::Frame& f) {
  std::string text(sms::octets_per_frame, '\0');
  for (size_t i = 0; i < text.size(); ++i) {
    text[i] = static_cast<char>(f.octet[i] & 0xFFu);
  }
  return py::bytes(text);
}

template <typename Number>
Number signal_of(const py::dict& values, const char* frame, const char* signal) {
  if (!values.contains(signal)) {
    throw py::key_error(std::string("the frame '") + frame + "' has a signal '" + signal + "', values has none");
  }
  return number_of<Number>(values[signal], signal);
}

// The codec by name, for the test that holds it against the DBC.
py::bytes pack_frame(const std::string& name, const py::dict& values) {
#define SMS_FRAME(frame_, identifier_) \
  if (name == #frame_) {               \
    const char* const frame = #frame_; \
    sms::frame::frame_ s;
#define SMS_RAW(signal, start, length) s.signal = signal_of<sms::Long>(values, frame, #signal);
#define SMS_UNSIGNED(signal, start, step, offset) s.signal = signal_of<float>(values, frame, #signal);
#define SMS_SIGNED(signal, start, step, offset) s.signal = signal_of<float>(values, frame, #signal);
#define SMS_REAL32(signal, start) s.signal = signal_of<float>(values, frame, #signal);
#define SMS_FRAME_END(frame_)   \
  return data_of(sms::pack(s)); \
  }
#include "sms/frames.def"
  throw py::key_error("there is no frame '" + name + "'");
}

py::object unpack_frame(const std::string& name, const py::bytes& data) {
  py::dict values;
#define SMS_FRAME(frame_, identifier_)                  \
  if (name == #frame_) {                                \
    sms::frame::frame_ s;                               \
    if (!sms::unpack(frame_of(identifier_, data), s)) { \
      return py::none();                                \
    }
#define SMS_RAW(signal, start, length) values[#signal] = s.signal;
#define SMS_UNSIGNED(signal, start, step, offset) values[#signal] = s.signal;
#define SMS_SIGNED(signal, start, step, offset) values[#signal] = s.signal;
#define SMS_REAL32(signal, start) values[#signal] = s.signal;
#define SMS_FRAME_END(frame_) \
  return std::move(values);   \
  }
#include "sms/frames.def"
  throw py::key_error("there is no frame '" + name + "'");
}

unsigned command_crc(unsigned identifier, unsigned challenge, const py::bytes& data) {
  return sms::command_crc(frame_of(identifier, data), sms::Word(challenge));
}

std::uint64_t command_mac(const py::bytes& key, std::uint64_t nonce, unsigned counter, unsigned identifier,
                          const py::bytes& data) {
  return fw::command_mac(fw::begin_mac(sip_key(key), nonce), counter, frame_of(identifier, data));
}

// ---- settings ----

struct Setting {
  int index;
  const char *name, *unit;
  double lower, value, upper;
  bool live;
  const char* doc;
};

std::vector<Setting> settings() {
  return {
#define SMS_SETTING(name, unit, lower, value, upper, live, doc) \
  {fw::index_of_##name, #name, unit, lower, value, upper, (live) != 0, doc},
#include "settings.def"
  };
}

// ---- the application ----

struct Outputs {
  std::vector<unsigned> pulse_width;
  std::vector<double> valve_command;  // V
  FrameList frames;
  py::bytes characters;
  bool feed_watchdog;
};

class Controller {
 public:
  Controller(const Params& params, const std::map<std::string, double>& settings, int reset_cause, unsigned seed,
             const py::bytes& key, std::uint64_t nonce) {
    fw::Parameters p;
    p.machine = sms::cast<float>(params);
    for (const auto& [name, value] : settings) {
      const int index = fw::parameter_index(name.c_str());
      if (index < fw::first_setting) {
        throw py::key_error("there is no setting '" + name + "'; sms._core.firmware_settings() lists them");
      }
      const fw::ParameterBounds& bounds = *fw::parameter_bounds(index);
      const float converted = float(value);
      if (!(converted >= bounds.lower && converted <= bounds.upper)) {
        throw py::value_error(name + " = " + std::to_string(value) + " is outside " + std::to_string(bounds.lower) +
                              " to " + std::to_string(bounds.upper));
      }
      *fw::parameter(p, index) = converted;
    }
    const auto cause = choice<sms::ResetCause>("reset_cause", reset_cause, 3);
    const sms_status status = fw::reset_with(*app_, p, cause, sms::Word(seed & 0xFFFFu));
    if (status != SMS_OK) {
      raise_status(status, "a machine with these parameters has no level pose within its stroke");
    }
    fw::set_key(*app_, sip_key(key), nonce);
  }

  Outputs tick(const std::vector<unsigned>& converted, const FrameList& frames, const std::string& characters,
               bool enabled, bool bus_off, unsigned missed_ticks, double load) {
    if (converted.size() != SMS_CONVERTED) {
      throw py::value_error("converted has to hold 10 counts: extensions, lower and upper chambers, supply");
    }
    if (frames.size() > SMS_FRAMES_IN || characters.size() > SMS_CHARACTERS_IN) {
      throw py::value_error("at most 8 frames and 16 characters arrive in one period");
    }
    for (size_t i = 0; i < converted.size(); ++i) {
      in_.converted[i] = sms::Word(converted[i] > 4095u ? 4095u : converted[i]);
    }
    in_.enabled = enabled ? 1 : 0;
    in_.bus_off = bus_off ? 1 : 0;
    in_.missed_ticks = sms::Word(missed_ticks);
    in_.load = sms::Word(load > 1.275 ? 255.0 : load > 0.0 ? 200.0 * load : 0.0);  // NaN: not measured
    in_.frame_count = sms::Word(frames.size());
    for (size_t i = 0; i < frames.size(); ++i) {
      in_.frames[i] = frame_of(frames[i].first, frames[i].second);
      in_.frames[i].length = sms::Word(py::len(frames[i].second));
    }
    in_.character_count = sms::Word(characters.size());
    for (size_t i = 0; i < characters.size(); ++i) {
      in_.characters[i] = sms::Word(static_cast<unsigned char>(characters[i]));
    }
    fw::tick(*app_, in_, out_);
    return outputs();
  }

  std::vector<unsigned> counts(const std::vector<double>& extension, const std::vector<double>& lower,
                               const std::vector<double>& upper, double supply) const {
    if (extension.size() != SMS_LEGS || lower.size() != SMS_LEGS || upper.size() != SMS_LEGS) {
      throw py::value_error("extension, lower and upper have to hold one value for each of the three actuators");
    }
    for (const std::vector<double>* const values : {&extension, &lower, &upper}) {
      for (const double value : *values) {
        need_finite(value, "extension, lower or upper");
      }
    }
    need_finite(supply, "supply");
    const fw::Parameters& p = app_->parameters.active;
    std::vector<unsigned> counts;
    for (int i = 0; i < SMS_LEGS; ++i) counts.push_back(fw::counts_of_extension(p, i, extension[size_t(i)]));
    for (const double pressure : lower) counts.push_back(fw::counts_of_pressure(p, pressure));
    for (const double pressure : upper) counts.push_back(fw::counts_of_pressure(p, pressure));
    counts.push_back(fw::counts_of_pressure(p, supply));
    return counts;
  }

  double parameter(const std::string& name) const {
    const int index = fw::parameter_index(name.c_str());
    if (index < 0) {
      throw py::key_error("there is no parameter or setting '" + name + "'");
    }
    return double(*fw::parameter(app_->parameters.active, index));
  }

  const fw::Application& app() const { return *app_; }

 private:
  Outputs outputs() const {
    Outputs o;
    for (int i = 0; i < SMS_LEGS; ++i) {
      o.pulse_width.push_back(out_.pulse_width[i]);
      o.valve_command.push_back(fw::voltage_of(app_->parameters.active, out_.pulse_width[i]));
    }
    for (int i = 0; i < int(out_.frame_count); ++i) {
      o.frames.emplace_back(out_.frames[i].identifier, data_of(out_.frames[i]));
    }
    std::string text;
    for (int i = 0; i < int(out_.character_count); ++i) text += static_cast<char>(out_.characters[i] & 0xFFu);
    o.characters = py::bytes(text);
    o.feed_watchdog = out_.feed_watchdog != 0;
    return o;
  }

  std::unique_ptr<fw::Application> app_ = std::make_unique<fw::Application>();
  sms_hardware_inputs in_ = {};
  sms_hardware_outputs out_ = {};
};

py::tuple three(float a, float b, float c) { return py::make_tuple(a, b, c); }

void bind_application(py::module_& m) {
  py::class_<Outputs>(m, "ControllerOutputs", "What the controller puts out in one period.")
      .def_readonly("pulse_width", &Outputs::pulse_width, "counts out of pwm_steps, one for each valve")
      .def_readonly("valve_command", &Outputs::valve_command, "mean voltage of those pulses, V")
      .def_readonly("frames", &Outputs::frames, "frames to be sent: (identifier, 8 octets), in this order")
      .def_readonly("characters", &Outputs::characters, "characters for the console, at most 11")
      .def_readonly("feed_watchdog", &Outputs::feed_watchdog, "whether the board is to restart its watchdog");
  py::class_<Controller>(m, "Controller",
                         "The application of the firmware (libsms/firmware), one call of tick() a control period.")
      .def(py::init<const Params&, const std::map<std::string, double>&, int, unsigned, const py::bytes&,
                    std::uint64_t>(),
           py::arg("params") = Params(), py::arg("settings") = std::map<std::string, double>(),
           py::arg("reset_cause") = 0, py::arg("seed") = 0, py::arg("key") = py::bytes(), py::arg("nonce") = 0,
           "As after a reset. settings: values by name (firmware_settings()); reset_cause: 0 power on, 1 watchdog, "
           "2 request; seed: of the first challenge, another one each time; key: 16 octets, then only authentic "
           "commands "
           "are obeyed; nonce: 64 bits that this key never had before.")
      .def("tick", &Controller::tick, py::arg("converted"), py::arg("frames") = FrameList(), py::arg("characters") = "",
           py::arg("enabled") = true, py::arg("bus_off") = false, py::arg("missed_ticks") = 0, py::arg("load") = 0.0,
           "One control period (1 ms). converted: 10 counts of 12 bits, see counts(); frames: at most 8 received ones, "
           "(identifier, octets); characters: at most 16 from the console; enabled: the enable switch is closed; "
           "missed_ticks: periods without a tick before this one; load: duration of the last tick over the period.")
      .def("counts", &Controller::counts, py::arg("extension"), py::arg("chamber_pressure_lower"),
           py::arg("chamber_pressure_upper"), py::arg("supply_pressure"),
           "The 10 counts that good sensors give: extension (3,), m; pressures (3,), Pa absolute; supply, Pa absolute.")
      .def("parameter", &Controller::parameter, py::arg("name"), "A parameter or setting that is in effect.")
      .def_property_readonly(
          "time", [](const Controller& c) { return 1e-3 * double(c.app().now); }, "s since reset")
      .def_property_readonly(
          "mode", [](const Controller& c) { return int(c.app().mode); }, "value table Mode")
      .def_property_readonly(
          "control_law", [](const Controller& c) { return int(c.app().law); }, "value table ControlLaw")
      .def_property_readonly(
          "faults", [](const Controller& c) { return fw::all(c.app().faults); },
          "bit n - 1 is fault n of the value table Fault")
      .def_property_readonly(
          "session", [](const Controller& c) { return unsigned(c.app().link.session); },
          "the session in control: 0 nobody, 15 the console")
      .def_property_readonly(
          "extension",
          [](const Controller& c) {
            const float* x = c.app().sensed.extension;
            return three(x[0], x[1], x[2]);
          },
          "as the controller measures it, m")
      .def_property_readonly(
          "extension_setpoint",
          [](const Controller& c) {
            const fw::Leg* leg = c.app().leg;
            return three(leg[0].setpoint.position, leg[1].setpoint.position, leg[2].setpoint.position);
          },
          "behind all limits, m");
}

}  // namespace

void bind_firmware(py::module_& m) {
  py::class_<Setting>(m, "FirmwareSetting", "What settings.def says of one setting of the firmware.")
      .def_readonly("index", &Setting::index, "parameter_index on the bus")
      .def_readonly("name", &Setting::name)
      .def_readonly("unit", &Setting::unit)
      .def_readonly("lower", &Setting::lower)
      .def_readonly("default", &Setting::value)
      .def_readonly("upper", &Setting::upper)
      .def_readonly("live", &Setting::live, "may be written while the platform is levelled")
      .def_readonly("doc", &Setting::doc);
  m.def("firmware_settings", &settings,
        "The list of settings.def; parameter_index on the bus is that of params.def below it.");
  m.def("firmware_hash", &sms_parameter_hash, "Hash over params.def and settings.def, params_hash of the bus.");
  m.def("command_crc", &command_crc, py::arg("identifier"), py::arg("challenge"), py::arg("data"),
        "The CRC of a command frame (docs/protocol.md): what its first octet has to be; data are its 8 octets.");
  m.def("command_mac", &command_mac, py::arg("key"), py::arg("nonce"), py::arg("counter"), py::arg("identifier"),
        py::arg("data"),
        "The MAC of a command frame (docs/protocol.md), 40 bits: SipHash-2-4 with a key of 16 octets over nonce, data, "
        "counter and identifier.");
  m.def("pack_frame", &pack_frame, py::arg("name"), py::arg("values"),
        "The firmware's codec: 8 octets of a frame from its signals; physical ones as float, others as int.");
  m.def("unpack_frame", &unpack_frame, py::arg("name"), py::arg("data"),
        "The firmware's codec: the signals of a frame; None when the frame is not whole.");
  bind_application(m);
}

}  // namespace sms_python
