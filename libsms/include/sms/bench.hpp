// One actuator on the test bench (dissertation, chapters 4 and 6, section 7.2): it moves its own mass and what is fixed
// to the rod.
//
//   x' = v,    (M_p + M_L) v' = p_a A_a - p_b A_b - p_A A_r + F_end - F_f(v, v') - F_L
//
// The friction depends on the acceleration it changes; force_balance.hpp solves that loop. F_L is what a load other than
// inertia puts on the rod, its weight where the cylinder stands upright.
#pragma once

#include "sms/actuator.hpp"

namespace sms {

template <typename S>
struct BenchState {
  using Scalar = S;
  S extension;  // m, 0 retracted
  S velocity;   // m/s
  ActuatorState<S> actuator;
};

template <typename S>
struct BenchInput {
  S command;     // V, to the valve or, with DriveLaw::filtered, to the filter in front of it
  S load_force;  // F_L, N, against extension
};

template <typename S>
struct BenchTerms {
  ActuatorTerms<S> actuator;  // fill_chambers()
  ForceBalance<S> balance;    // force_balance()
};

template <typename S>
struct Bench {
  using Scalar = S;
  using State = BenchState<S>;
  using Input = BenchInput<S>;
  using Terms = BenchTerms<S>;
  static constexpr int legs = 1;
  Params<S> params;
  ActuatorLaws laws;
};

template <typename S>
Bench<S> make_bench(const Params<S>& p, const ActuatorLaws& laws) {
  Bench<S> bench;
  bench.params = p;
  bench.laws = laws;
  return bench;
}

template <typename S>
void prepare(const Bench<S>&, BenchTerms<S>&) {}

template <typename S>
sms_status derivative(const Bench<S>& bench, const BenchState<S>& state, const BenchInput<S>& input, BenchTerms<S>& t,
                      BenchState<S>& rate) {
  const Params<S>& p = bench.params;
  fill_chambers(p, bench.laws, state.actuator, state.extension, state.velocity, t.actuator);
  if (!has_room(t.actuator)) {
    return SMS_OUT_OF_RANGE;
  }
  const S drive = t.actuator.force - input.load_force;
  t.balance =
      seal_balance<S>(p, bench.laws.friction, t.actuator.piston, seals_of(state.actuator), p.moving_mass, drive);
  rate.extension = state.velocity;
  rate.velocity = t.balance.acceleration;
  actuator_rates(p, bench.laws, state.actuator, input.command, t.actuator, rate.actuator);
  seal_rates(t.balance, rate.actuator);
  return is_finite(rate.velocity) && is_finite(rate.actuator.lower.pressure) && is_finite(rate.actuator.upper.pressure)
             ? SMS_OK
             : SMS_NOT_A_NUMBER;
}

// What of the rates depends on the input alone, for a command that has jumped.
template <typename S>
void renew_command(const Bench<S>& bench, const BenchState<S>& state, const BenchInput<S>& input, BenchState<S>& rate) {
  drive_rates(bench.params, bench.laws, state.actuator, input.command, rate.actuator);
}

// At rest with the valve closed: the load is carried and the mean of the two chamber pressures is as given, Pa.
template <typename S>
BenchState<S> bench_at_rest(const Bench<S>& bench, const S& extension, const S& load_force, const S& mean_pressure) {
  const Params<S>& p = bench.params;
  const PistonAreas<S> area = piston_areas(p);
  const S force = load_force + p.ambient_pressure * area.rod;  // p_a A_a - p_b A_b
  const S lower = (force + S(2) * mean_pressure * area.upper) / (area.lower + area.upper);
  return {extension, S(0), actuator_at_rest<S>(p, lower, S(2) * mean_pressure - lower)};
}

template <typename S>
BenchState<S> state_scale(const Bench<S>&) {
  return {S(0.4), S(0.5), actuator_scale<S>()};
}

template <typename S>
void switches(const Bench<S>& bench, const BenchState<S>& state, const BenchTerms<S>& t,
              S (&value)[actuator_switch_count()]) {
  actuator_switches(bench.params, bench.laws, state.actuator, t.actuator.piston, t.balance.acceleration,
                    t.balance.friction, value);
}

// What a plant is asked by whoever closes a loop around it.
template <typename S>
const S& extension_of(const BenchState<S>& state, const BenchTerms<S>&, int) {
  return state.extension;
}

template <typename S>
void set_command(BenchInput<S>& input, int, const S& command) {
  input.command = command;
}

}  // namespace sms
