// The rig "bench" as a plant of shooting.hpp: one actuator, its command, extension and chamber pressures measured.
//
// A window starts with what is free: extension, velocity, both pressures, the reservoir's pressure and the deflection of
// the seals. The spool needs none of it: it follows the command alone, and is run up over the 50 ms before the window.
//
// The step. Friction inside its ramp is stiff (38 N over 5 mm/s on 3.6 kg: 0.3 ms), and so are a chamber that is nearly
// closed and the contact at an end. A Rosenbrock method of second order with an approximate Jacobian A (ROS2; Verwer,
// Spee, Blom and Hundsdorfer 1999) stays stable there and keeps its order whatever A is:
//
//   (I - gamma h A) k1 = f(t, y)
//   (I - gamma h A) k2 = f(t + h, y + h k1) - 2 k1,      y + h (3 k1 + k2) / 2,      gamma = 1 - 1/sqrt(2)
//
// A has the slope of friction and contact for (x, v), and a chamber's flow over its pressure difference for each pressure.
#pragma once

#include "estimation/recorded.hpp"
#include "estimation/shooting.hpp"
#include "sms/bench.hpp"
#include "sms/integrate.hpp"
#include "sms/sensor.hpp"

namespace sms {
namespace estimation {

// One record, evenly sampled. Readings as they stand in the record; arrays of one length.
struct BenchRecord {
  double step = 0.0;  // s
  Eigen::VectorXd command;
  Eigen::VectorXd extension;
  Eigen::VectorXd pressure_lower;
  Eigen::VectorXd pressure_upper;
  Eigen::VectorXd supply_pressure;                 // empty: not measured
  std::vector<std::pair<int, double>> conditions;  // ParamIndex, and by how much it is larger in this run
};

// Standard deviation of one sample.
struct BenchNoise {
  double extension = 1e-4;
  double pressure_lower = 1e3;
  double pressure_upper = 1e3;
  double supply_pressure = 1e3;
};

class BenchPlant {
 public:
  static constexpr int kStart = 6;   // x, v, p_a, p_b, p_R, z
  static constexpr int kHidden = 3;  // force, N; mass flow into the lower and into the upper chamber, kg/s

  // std::invalid_argument for arrays of different lengths or numbers that are not finite.
  BenchPlant(std::vector<BenchRecord> records, const BenchNoise& noise, const ActuatorLaws& laws, double longest_step);

  static double start_scale(int k) {
    constexpr double scale[kStart] = {5e-3, 0.3, 2e4, 2e4, 2e4, 1e-3};
    return scale[k];
  }
  int records() const { return static_cast<int>(records_.size()); }
  int samples(int record) const { return static_cast<int>(of(record).command.size()); }
  double step(int record) const { return of(record).step; }
  int channels(int record) const { return of(record).supply_pressure.size() > 0 ? 4 : 3; }
  Eigen::VectorXd guess(int record, int first) const;

  // Writes the whitened errors of one sample and returns where the next begin.
  template <typename S>
  S* readings(const Params<S>& p, const BenchRecord& record, int sample, const BenchState<S>& state,
              const BenchState<S>& rate, const S& force, S* out) const;

  // residual: for each sample of the window, each channel. hidden: kHidden times knots values, or nullptr.
  template <typename S>
  void simulate(const Params<S>& params, const Window& window, const S* start, S* residual, const S* hidden = nullptr,
                int knots = 0) const;

 private:
  const BenchRecord& of(int record) const { return records_[static_cast<std::size_t>(record)]; }

  std::vector<BenchRecord> records_;
  BenchNoise noise_;
  ActuatorLaws laws_;
  double longest_step_;
};

namespace detail {

// A quantity that follows `now` with a lag of first order, a time h later; in between `now` runs straight to `then`.
template <typename S>
S lagging(const S& late, const S& now, const S& then, const S& lag, const S& h) {
  using std::exp;
  const S behind = lag * (then - now) / h;
  return lag > S(0) ? S(then - behind + (late - now + behind) * exp(-h / lag)) : S(then - behind);
}

// Friction that deviates from its law, by the difference of force it makes. Presliding: the seals carry a share by
// their deformation. friction_lag: viscous friction follows the speed of the lubricant's film, which is late.
template <typename S>
void add_seal_effects(const Bench<S>& bench, const BenchState<S>& state, const BenchTerms<S>& t, const S& film,
                      BenchState<S>& rate) {
  const Params<S>& p = bench.params;
  if (!is_absent(p.presliding_share)) {
    const BristleFriction<S> bristle = lugre_friction(p, t.actuator.piston, state.actuator.deflection);
    rate.velocity -= p.presliding_share * (bristle.force - t.balance.friction) / p.moving_mass;
    rate.actuator.deflection = bristle.deflection_rate;
  }
  if (!is_absent(p.friction_lag)) {
    rate.velocity += p.viscous_friction * (state.velocity - film) / p.moving_mass;
  }
}

// A of the step.
template <typename S>
struct BenchStiffness {
  S motion_position;  // d v'/d x
  S motion_velocity;  // d v'/d v
  S lower;            // d p_a'/d p_a
  S upper;
  S reservoir;
  S deflection;
};

template <typename S>
BenchStiffness<S> bench_stiffness(const Bench<S>& bench, const BenchState<S>& state, const BenchTerms<S>& t) {
  using std::abs;
  using std::cos;
  const Params<S>& p = bench.params;
  const ActuatorTerms<S>& a = t.actuator;
  const S speed = abs(state.velocity);
  S damping = p.viscous_friction;
  if (bench.laws.friction != FrictionLaw::dahl && bench.laws.friction != FrictionLaw::lugre &&
      speed < p.stiction_velocity) {
    const S steep = S(1.5707963267948966) / p.stiction_velocity;
    damping += p.coulomb_force * steep * cos(steep * speed);
  } else if (bench.laws.friction == FrictionLaw::lugre) {
    damping += p.bristle_damping;
  }
  const bool contact = state.extension < S(0) || state.extension > p.stroke;
  if (contact) {
    damping += p.end_stop_stiffness * p.end_stop_damping * S(1e-4);
  }
  const S air = p.compression_heat_ratio * p.gas_constant * p.air_temperature;
  const Gas<S>&lower = a.ports.lower, &upper = a.ports.upper, &outside = a.ports.exhaust, &supply = a.ports.supply;
  const S feed_lower = secant(a.edge.supply_lower, supply.pressure, lower.pressure);
  const S feed_upper = secant(a.edge.supply_upper, supply.pressure, upper.pressure);
  const S vent_lower = secant(a.edge.lower_exhaust, lower.pressure, outside.pressure);
  const S vent_upper = secant(a.edge.upper_exhaust, upper.pressure, outside.pressure);
  BenchStiffness<S> s;
  s.motion_position = contact ? S(-(p.end_stop_stiffness / p.moving_mass)) : S(0);
  s.motion_velocity = -(damping / p.moving_mass);
  s.lower = -(air / a.lower.volume * (feed_lower + vent_lower));
  s.upper = -(air / a.upper.volume * (feed_upper + vent_upper));
  s.reservoir = p.supply_line_resistance > S(0)
                    ? S(-(air / p.reservoir_volume * (S(1) / p.supply_line_resistance + feed_lower + feed_upper)))
                    : S(0);
  s.deflection =
      bench.laws.friction == FrictionLaw::lugre || bench.laws.friction == FrictionLaw::dahl || p.presliding_share > S(0)
          ? S(-(speed * p.bristle_stiffness / p.coulomb_force))
          : S(0);
  return s;
}

// k with (I - g A) k = rate
template <typename S>
void solve_stiff(const BenchStiffness<S>& s, const S& g, BenchState<S>& rate) {
  rate.velocity = (rate.velocity + g * s.motion_position * rate.extension) /
                  (S(1) - g * s.motion_velocity - g * g * s.motion_position);
  rate.extension = rate.extension + (s.motion_position < S(0) ? S(g * rate.velocity) : S(0));
  rate.actuator.lower.pressure /= S(1) - g * s.lower;
  rate.actuator.upper.pressure /= S(1) - g * s.upper;
  rate.actuator.supply_pressure /= S(1) - g * s.reservoir;
  rate.actuator.deflection /= S(1) - g * s.deflection;
}

}  // namespace detail

template <typename S>
S* BenchPlant::readings(const Params<S>& p, const BenchRecord& record, int sample, const BenchState<S>& state,
                        const BenchState<S>& rate, const S& force, S* out) const {
  const auto error = [sample](const S& predicted, const Eigen::VectorXd& measured, int samples, double noise) {
    return detail::reading_error(predicted, measured, sample + samples, noise);
  };
  S rest;
  const int late = detail::whole_samples(record.step, p.clock_skew_extension, &rest);
  const S x = seen_extension(p, state.extension, state.velocity, force);
  const S x_late = late_reading<S>(x, state.velocity, rest + p.sensor_lag_extension);
  *out++ = error(sensor_reading(x_late, p.sensor_gain_extension, p.sensor_offset_extension), record.extension, late,
                 noise_.extension);
  const int late_p = detail::whole_samples(record.step, p.clock_skew_chamber_pressure, &rest);
  const S lower = late_reading<S>(state.actuator.lower.pressure, rate.actuator.lower.pressure,
                                  rest + p.sensor_lag_chamber_pressure_lower);
  *out++ = error(sensor_reading(lower, p.sensor_gain_chamber_pressure_lower, p.sensor_offset_chamber_pressure_lower),
                 record.pressure_lower, late_p, noise_.pressure_lower);
  const S upper = late_reading<S>(state.actuator.upper.pressure, rate.actuator.upper.pressure,
                                  rest + p.sensor_lag_chamber_pressure_upper);
  *out++ = error(sensor_reading(upper, p.sensor_gain_chamber_pressure_upper, p.sensor_offset_chamber_pressure_upper),
                 record.pressure_upper, late_p, noise_.pressure_upper);
  if (record.supply_pressure.size() > 0) {
    *out++ = error(
        sensor_reading(state.actuator.supply_pressure, p.sensor_gain_supply_pressure, p.sensor_offset_supply_pressure),
        record.supply_pressure, 0, noise_.supply_pressure);
  }
  return out;
}

template <typename S>
void BenchPlant::simulate(const Params<S>& params, const Window& window, const S* start, S* residual, const S* hidden,
                          int knots) const {
  const BenchRecord& record = of(window.record);
  Bench<S> bench{params, laws_};
  for (const auto& condition : record.conditions) {
    param(bench.params, condition.first) += S(condition.second);
  }
  const Params<S>& p = bench.params;
  const bool droops = p.supply_line_resistance > S(0);
  const double sample = record.step;
  const int steps = std::max(1, static_cast<int>(std::ceil(sample / longest_step_ - 1e-9)));
  const S h(sample / steps);
  const S late = p.command_delay / S(sample);

  BenchState<S> state = bench_at_rest(bench, start[0], S(0), S(2e5));
  state.velocity = start[1];
  state.actuator.lower = {start[2], p.air_temperature};
  state.actuator.upper = {start[3], p.air_temperature};
  state.actuator.supply_pressure = droops ? start[4] : p.supply_pressure;
  state.actuator.deflection = start[5];

  // The spool: 50 ms of the command before the window.
  const int run_up = static_cast<int>(0.05 / value_of(h)) + 1;
  Lag<S> spool{detail::command_at<S>(record.command, S(window.first - double(run_up) / steps) - late), S(0)};
  for (int i = -run_up; i < 0; ++i) {
    const S at = S(window.first + double(i) / steps) - late;
    const Lag<S> k1 = spool_rate(p, spool, detail::command_at<S>(record.command, at));
    const Lag<S> moved{spool.value + h * k1.value, spool.rate + h * k1.rate};
    const Lag<S> k2 = spool_rate(p, moved, detail::command_at<S>(record.command, at + S(1.0 / steps)));
    spool = {spool.value + S(0.5) * h * (k1.value + k2.value), spool.rate + S(0.5) * h * (k1.rate + k2.rate)};
  }
  state.actuator.spool = spool;

  BenchTerms<S> t;
  BenchState<S> k1, k2, moved;
  // Hidden inputs at `at`, counted in samples from the window's first.
  const auto push = [&](double at, BenchState<S>& rate) {
    if (hidden == nullptr) {
      return;
    }
    const auto value = [&](int input) { return detail::hidden_at(hidden + input * knots, knots, window.samples, at); };
    rate.velocity += value(0) / p.moving_mass;
    rate.actuator.lower.pressure += value(1) * p.gas_constant * p.air_temperature / t.actuator.lower.volume;
    rate.actuator.upper.pressure += value(2) * p.gas_constant * p.air_temperature / t.actuator.upper.volume;
  };
  const auto rates = [&](double at, const BenchState<S>& y, const S& film, BenchState<S>& rate) {
    const BenchInput<S> input{detail::command_at<S>(record.command, S(window.first + at) - late), S(0)};
    derivative(bench, y, input, t, rate);
    detail::add_seal_effects(bench, y, t, film, rate);
    push(at, rate);
  };
  const bool film_is_late = !is_absent(p.friction_lag);
  S film = state.velocity;
  const auto film_at = [&](const S& speed) {
    return film_is_late ? detail::lagging(film, state.velocity, speed, p.friction_lag, h) : speed;
  };
  const S g = S(0.29289321881345254) * h;
  const auto x = vector_of(state);
  for (int k = 0;; ++k) {
    rates(k, state, film, k1);
    residual = readings<S>(p, record, window.first + k, state, k1, t.actuator.force - t.balance.friction, residual);
    if (k == window.samples - 1) {
      return;
    }
    for (int i = 0; i < steps; ++i) {
      if (i > 0) {
        rates(k + double(i) / steps, state, film, k1);
      }
      const detail::BenchStiffness<S> stiff = detail::bench_stiffness(bench, state, t);
      detail::solve_stiff(stiff, g, k1);
      vector_of(moved) = x + h * vector_of(k1);
      rates(k + double(i + 1) / steps, moved, film_at(moved.velocity), k2);
      vector_of(k2) -= S(2) * vector_of(k1);
      detail::solve_stiff(stiff, g, k2);
      const S speed = state.velocity + (S(0.5) * h) * (S(3) * k1.velocity + k2.velocity);
      film = film_at(speed);
      vector_of(state) += (S(0.5) * h) * (S(3) * vector_of(k1) + vector_of(k2));
    }
  }
}

}  // namespace estimation
}  // namespace sms
