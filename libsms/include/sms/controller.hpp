// The position controllers of one actuator, as the firmware runs them (dissertation, sections 7.3.5 and 8.2).
//
// Called once a period T_s with what was sampled, they return a voltage around the valve's centre. P and PID, parallel
// branches, trapezoidal integral, filtered derivative:
//
//   C(z) = G_P + G_I T_s/2 (z+1)/(z-1) + G_D N / (1 + N T_s/2 (z+1)/(z-1))                                  (eq. 7.4)
//
// State feedback acts on the error of position, on velocity and acceleration, both from that same filtered derivative:
//
//   u = K_c (K_p (r - x) - K_v x' - K_a x'')                                          (Figure 8.3; K_a > 0 damps)
//
// The valve passes next to nothing around its centre. The dead-band compensation steps over that range,
//
//   V_o = a V_i + (2 b / pi) atan(c V_i),   a such that 5 V stay 5 V,   dV_o/dV_i = a + 2 b c / (pi (c^2 V_i^2 + 1))
//                                                                                                     (eq. 7.5 to 7.7)
//
// Settings and state are plain structs of the caller; a state of zeros is at rest. Any sampling rate: the bilinear
// transform is stable for every N T_s, though beyond N T_s = 2 the derivative alternates.
//
// Two options the source does not have. Anti-windup by conditional integration: the integral stands still while the output is at a limit and the
// error would push it further. Bumpless transfer: pid_follow() before the loop is closed, pid_change_gains() while it
// is.
#pragma once

#include <cmath>

#include "sms/limit.hpp"
#include "sms/params.hpp"

namespace sms {

// Half the supply of the valve's electronics: commands run from 0 to 10 V, controllers from -5 to 5 V around the
// centre.
template <typename S>
constexpr S command_limit() {
  return S(5);
}

// ---- filtered derivative ----

// N / (1 + N T_s/2 (z+1)/(z-1)): s / (1 + s/N) by the bilinear transform.
template <typename S>
struct Differentiator {
  S input;   // of the last sample
  S output;  // per second
};

template <typename S>
S differentiate(const S& corner, const S& period, Differentiator<S>& state, const S& input) {
  const S half = S(0.5) * corner * period;
  state.output = ((S(1) - half) * state.output + corner * (input - state.input)) / (S(1) + half);
  state.input = input;
  return state.output;
}

// ---- PID ----

// What the integral does while the output is at its limit.
enum class AntiWindup : int {
  none,                    // goes on: eq. 7.4 as it stands, clipped
  conditional_integration  // stands still where the error would push it further
};

template <typename S>
struct PidSettings {
  S proportional;  // G_P, V/m
  S integral;      // G_I, V/(m s)
  S derivative;    // G_D, V s/m
  S corner;        // N, rad/s
  S period;        // T_s, s
  S limit;         // the output stays within +- limit, V
  AntiWindup anti_windup;
};

template <typename S>
PidSettings<S> pid_settings(const Params<S>& p) {
  return {p.proportional_gain, p.integral_gain,    p.derivative_gain, p.differentiator_corner,
          p.control_period,    command_limit<S>(), AntiWindup::none};
}

template <typename S>
struct Pid {
  S integral;                // V, gain included
  Differentiator<S> change;  // of the error
};

// u, V; the error in m.
template <typename S>
S pid_step(const PidSettings<S>& settings, Pid<S>& state, const S& error) {
  const S growth = S(0.5) * settings.integral * settings.period * (error + state.change.input);
  const S rest = settings.proportional * error +
                 settings.derivative * differentiate(settings.corner, settings.period, state.change, error) +
                 state.integral;
  const S output = rest + growth;
  const bool winding = (output > settings.limit && growth > S(0)) || (output < -settings.limit && growth < S(0));
  if (settings.anti_windup == AntiWindup::conditional_integration && winding) {
    return limited<S>(rest, -settings.limit, settings.limit);
  }
  state.integral += growth;
  return limited<S>(output, -settings.limit, settings.limit);
}

// While something else drives the valve: with the same error the next step will give `output`.
template <typename S>
void pid_follow(const PidSettings<S>& settings, Pid<S>& state, const S& error, const S& output) {
  state.change = {error, S(0)};
  state.integral = output - (settings.proportional + settings.integral * settings.period) * error;
}

// Other gains without a jump of the output.
template <typename S>
void pid_change_gains(PidSettings<S>& settings, Pid<S>& state, const PidSettings<S>& wanted) {
  state.integral += (settings.proportional - wanted.proportional) * state.change.input +
                    (settings.derivative - wanted.derivative) * state.change.output;
  settings = wanted;
}

// ---- state feedback ----

template <typename S>
struct StateFeedbackSettings {
  S position;      // K_p, V/m
  S velocity;      // K_v, V s/m
  S acceleration;  // K_a, V s^2/m
  S loop;          // K_c
  S corner;        // N of both differentiators, rad/s
  S period;        // T_s, s
};

template <typename S>
StateFeedbackSettings<S> state_feedback_settings(const Params<S>& p) {
  return {p.position_gain, p.velocity_gain,         p.acceleration_gain,
          p.loop_gain,     p.differentiator_corner, p.control_period};
}

template <typename S>
struct StateFeedback {
  Differentiator<S> position;  // gives the velocity
  Differentiator<S> velocity;  // gives the acceleration
};

// A controller that starts at rest at `extension`: the first step sees no jump.
template <typename S>
StateFeedback<S> state_feedback_at(const S& extension) {
  return {{extension, S(0)}, {S(0), S(0)}};
}

// u, V
template <typename S>
S state_feedback_step(const StateFeedbackSettings<S>& settings, StateFeedback<S>& state, const S& setpoint,
                      const S& extension) {
  const S velocity = differentiate(settings.corner, settings.period, state.position, extension);
  const S acceleration = differentiate(settings.corner, settings.period, state.velocity, velocity);
  const S u = settings.loop * (settings.position * (setpoint - extension) - settings.velocity * velocity -
                               settings.acceleration * acceleration);
  return limited<S>(u, -command_limit<S>(), command_limit<S>());
}

// ---- dead-band compensation ----

template <typename S>
struct DeadBand {
  S gain;       // a
  S step;       // b, V
  S sharpness;  // c, 1/V
};

// a of eq. 7.6 from b and c
template <typename S>
DeadBand<S> make_dead_band(const S& step, const S& sharpness) {
  using std::atan;
  const S limit = command_limit<S>();
  return {(limit - S(0.63661977236758134) * step * atan(sharpness * limit)) / limit, step, sharpness};
}

// V_o, V, eq. 7.5
template <typename S>
S over_dead_band(const DeadBand<S>& d, const S& voltage) {
  using std::atan;
  return d.gain * voltage + S(0.63661977236758134) * d.step * atan(d.sharpness * voltage);
}

// dV_o/dV_i, eq. 7.7
template <typename S>
S dead_band_gain(const DeadBand<S>& d, const S& voltage) {
  const S x = d.sharpness * voltage;
  return d.gain + S(0.63661977236758134) * d.step * d.sharpness / (x * x + S(1));
}

// The command at the valve, V: the compensated controller output around the offset, within 0 to 10 V.
template <typename S>
S valve_command(const DeadBand<S>& d, const S& offset, const S& voltage) {
  return limited<S>(offset + over_dead_band(d, voltage), S(0), S(2) * command_limit<S>());
}

}  // namespace sms
