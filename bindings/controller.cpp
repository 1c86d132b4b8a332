// Controllers over records, excitations, electronics, and the designs on the simplified plant: the code of the
// firmware, sample by sample.
#include "sms/controller.hpp"

#include <pybind11/complex.h>

#include "broadcast.hpp"
#include "sms/electronics.hpp"
#include "sms/signal.hpp"
#include "sms/simplified_plant.hpp"

namespace sms_python {
namespace {

// step(sample) over a record, in order; a record is one-dimensional.
template <typename Step>
Array over_record(const Array& record, const char* name, const Step& step) {
  if (record.ndim() != 1) {
    throw py::value_error(std::string(name) + " has to be a record, an array of shape (n,)");
  }
  Array out(record.size());
  for (py::ssize_t i = 0; i < record.size(); ++i) {
    out.mutable_data()[i] = step(i, record.data()[i]);
  }
  return out;
}

// ---- controllers ----

Array pid(const Params& p, const Array& error, double limit, bool anti_windup) {
  sms::PidSettings<double> settings = sms::pid_settings(p);
  settings.limit = limit;
  settings.anti_windup = anti_windup ? sms::AntiWindup::conditional_integration : sms::AntiWindup::none;
  sms::Pid<double> state{};
  return over_record(error, "error",
                     [&settings, &state](py::ssize_t, double e) { return sms::pid_step(settings, state, e); });
}

Array state_feedback(const Params& p, const Array& setpoint, const Array& extension) {
  if (setpoint.ndim() != 1 || setpoint.size() != extension.size()) {
    throw py::value_error("setpoint and extension have to be records of one length, arrays of shape (n,)");
  }
  const auto settings = sms::state_feedback_settings(p);
  auto state = sms::state_feedback_at(extension.size() > 0 ? extension.data()[0] : 0.0);
  return over_record(extension, "extension", [&](py::ssize_t i, double x) {
    return sms::state_feedback_step(settings, state, setpoint.data()[i], x);
  });
}

sms::DeadBand<double> dead_band(const Params& p) {
  return sms::make_dead_band(p.dead_band_step, p.dead_band_sharpness);
}

void bind_control(py::module_& m) {
  m.def("pid", &pid, py::arg("params"), py::arg("error"), py::arg("limit") = sms::command_limit<double>(),
        py::arg("anti_windup") = false,
        "Output of the PID controller from rest, V (eq. 7.4); error (n,), m, one sample a control_period.");
  m.def("state_feedback", &state_feedback, py::arg("params"), py::arg("setpoint"), py::arg("extension"),
        "Output of the state feedback from rest, V (Figure 8.3); records (n,), m, one sample a control_period.");
  m.def(
      "dead_band_coefficient", [](const Params& p) { return dead_band(p).gain; }, py::arg("params"), "a (eq. 7.6)");
  m.def(
      "over_dead_band",
      [](const Params& p, const Array& voltage) {
        return each([d = dead_band(p)](double v) { return sms::over_dead_band(d, v); }, voltage);
      },
      py::arg("params"), py::arg("voltage"), "Dead-band compensation, V (eq. 7.5).");
  m.def(
      "dead_band_gain",
      [](const Params& p, const Array& voltage) {
        return each([d = dead_band(p)](double v) { return sms::dead_band_gain(d, v); }, voltage);
      },
      py::arg("params"), py::arg("voltage"), "Slope of the dead-band compensation (eq. 7.7).");
  m.def(
      "valve_command",
      [](const Params& p, const Array& voltage) {
        const auto one = [d = dead_band(p), offset = p.command_offset](double v) {
          return sms::valve_command(d, offset, v);
        };
        return each(one, voltage);
      },
      py::arg("params"), py::arg("voltage"), "Command at the valve, V, from the controller's output, compensated.");
}

// ---- signals and electronics ----

Two alpha_beta(const Array& measured, double dt, double alpha, double beta, double value, double rate) {
  sms::AlphaBeta<double> state = {value, rate};
  Array rates(measured.size());
  const Array values = over_record(measured, "measured", [&](py::ssize_t i, double y) {
    state = sms::alpha_beta_step(alpha, beta, dt, state, y);
    rates.mutable_data()[i] = state.rate;
    return state.value;
  });
  return py::make_tuple(values, rates);
}

Array dac_filter(const Params& p, const Array& voltage, double dt) {
  const auto step = sms::dac_filter(p, dt);
  sms::Lag<double> lag = {voltage.size() > 0 ? *voltage.data() : 0.0, 0.0};
  return over_record(voltage, "voltage", [&](py::ssize_t, double v) {
    lag = sms::lag_step(step, lag, v);
    return lag.value;
  });
}

void bind_signals(py::module_& m) {
  m.def("alpha_beta", &alpha_beta, py::arg("measured"), py::arg("dt"), py::arg("alpha"), py::arg("beta"),
        py::arg("value"), py::arg("rate") = 0.0,
        "(values, rates), each (n,), of the alpha-beta filter that starts at value and rate.");
  m.def(
      "chirp",
      [](const Array& time, double amplitude, double first, double last, double duration) {
        const sms::Chirp<double> c = {amplitude, first, last, duration};
        return each([&c](double t) { return sms::chirp(c, t); }, time);
      },
      py::arg("time"), py::arg("amplitude"), py::arg("first"), py::arg("last"), py::arg("duration"),
      "The chirp of eq. 7.3, in the unit of the amplitude; frequencies in Hz, times in s.");
  m.def(
      "chirp_frequency",
      [](const Array& time, double first, double last, double duration) {
        const sms::Chirp<double> c = {1.0, first, last, duration};
        return each([&c](double t) { return sms::chirp_frequency(c, t); }, time);
      },
      py::arg("time"), py::arg("first"), py::arg("last"), py::arg("duration"), "Its frequency, Hz.");
  m.def(
      "sampled_extension",
      [](const Params& p, const Array& extension) {
        const auto one = [&p, c = sms::position_converter(p)](double x) { return sms::sampled_extension(p, c, x); };
        return each(one, extension);
      },
      py::arg("params"), py::arg("extension"), "What the controller takes for the extension, m: potentiometer, ADC.");
  m.def(
      "pulse_width_voltage",
      [](const Params& p, const Array& command) {
        const auto one = [c = sms::command_converter(p)](double v) { return sms::pulse_width_voltage(c, v); };
        return each(one, command);
      },
      py::arg("params"), py::arg("command"), "The mean voltage of the pulses for a command, V.");
  m.def("dac_filter", &dac_filter, py::arg("params"), py::arg("voltage"), py::arg("dt"),
        "What the filter behind the pulse width makes of a record (n,), V, each sample held for dt.");
}

// ---- simplified plant ----

sms::SimplifiedPlant<double> plant(double velocity_gain, double natural_frequency, double damping_ratio) {
  return {velocity_gain, natural_frequency, damping_ratio};
}

using Numbers = py::typing::Tuple<double, double, double>;

Numbers numbers(const sms::StateFeedbackGains<double>& k) {
  return py::make_tuple(k.position, k.velocity, k.acceleration);
}

py::typing::List<std::complex<double>> poles(double square, double linear, double constant) {
  const sms::Poles<double> s = sms::poles<double>({square, linear, constant});
  const std::complex<double> spread = s.is_pair ? std::complex<double>(0.0, s.spread) : s.spread;
  py::list list;
  list.append(std::complex<double>(s.real));
  list.append(s.middle - spread);
  list.append(s.middle + spread);
  return list;
}

void bind_simplified(py::module_& m) {
  m.def(
      "air_spring", [](const Params& p, double mean_pressure) { return sms::air_spring(p, mean_pressure); },
      py::arg("params"), py::arg("mean_pressure"), "Spring constant of both chambers, N/m (eq. 8.2); Pa absolute.");
  m.def(
      "simplified_plant",
      [](const Params& p, double mean_pressure, double mass) {
        const auto g = sms::simplified_plant(p, mean_pressure, mass, 1.0);
        return py::typing::Tuple<double, double>(py::make_tuple(g.natural_frequency, g.damping_ratio));
      },
      py::arg("params"), py::arg("mean_pressure"), py::arg("mass"),
      "(natural frequency, rad/s; damping ratio), eq. 8.2 and 8.3; Pa absolute, kg.");
  m.def(
      "gains_situm",
      [](double velocity_gain, double natural_frequency, double damping_ratio, double alpha, bool as_printed) {
        return numbers(sms::gains_situm(plant(velocity_gain, natural_frequency, damping_ratio), alpha, as_printed));
      },
      py::arg("velocity_gain"), py::arg("natural_frequency"), py::arg("damping_ratio"), py::arg("alpha"),
      py::arg("as_printed") = false, "(K_p, K_v, K_a), eq. 8.8 to 8.10; as_printed keeps the misprint of eq. 8.9.");
  m.def(
      "gains_specification_based",
      [](double velocity_gain, double natural_frequency, double damping_ratio, double alpha) {
        return numbers(sms::gains_specification_based(plant(velocity_gain, natural_frequency, damping_ratio), alpha));
      },
      py::arg("velocity_gain"), py::arg("natural_frequency"), py::arg("damping_ratio"), py::arg("alpha"),
      "(K_p, K_v, K_a), eq. 8.13 to 8.15.");
  m.def(
      "closed_loop",
      [](double velocity_gain, double natural_frequency, double damping_ratio, double position, double velocity,
         double acceleration) {
        const auto t = sms::closed_loop(plant(velocity_gain, natural_frequency, damping_ratio),
                                        {position, velocity, acceleration});
        return Numbers(py::make_tuple(t.square, t.linear, t.constant));
      },
      py::arg("velocity_gain"), py::arg("natural_frequency"), py::arg("damping_ratio"), py::arg("position"),
      py::arg("velocity") = 0.0, py::arg("acceleration") = 0.0,
      "(square, linear, constant) of the denominator s^3 + square s^2 + linear s + constant under the gains given "
      "(eq. 8.4, 8.5); the numerator is the constant.");
  m.def(
      "largest_stable_gain",
      [](double velocity_gain, double natural_frequency, double damping_ratio) {
        return sms::largest_stable_gain(plant(velocity_gain, natural_frequency, damping_ratio));
      },
      py::arg("velocity_gain"), py::arg("natural_frequency"), py::arg("damping_ratio"),
      "Largest K_p of a stable loop, V/m.");
  m.def(
      "is_stable",
      [](double square, double linear, double constant) {
        return sms::is_stable<double>({square, linear, constant});
      },
      py::arg("square"), py::arg("linear"), py::arg("constant"), "Routh and Hurwitz.");
  m.def("poles", &poles, py::arg("square"), py::arg("linear"), py::arg("constant"), "The three poles, rad/s.");
  m.def(
      "frequency_response",
      [](double square, double linear, double constant, const Array& frequency) {
        const auto one = [=](double f) -> std::array<double, 2> {
          const auto r = sms::frequency_response<double>({square, linear, constant}, sms::angular_frequency(f));
          return {r.amplitude, r.phase};
        };
        return as_tuple(broadcast<2>(one, frequency));
      },
      py::arg("square"), py::arg("linear"), py::arg("constant"), py::arg("frequency"),
      "(amplitude ratio, phase in rad) of the closed loop over frequencies in Hz.");
}

}  // namespace

void bind_controller(py::module_& m) {
  bind_control(m);
  bind_signals(m);
  bind_simplified(m);
}

}  // namespace sms_python
