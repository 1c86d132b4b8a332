// The bench as it is held against records: its derivative (bench.hpp), with what lies between two laws of it: air that is
// partly warm, seals that partly deform, friction that is late (actuator_step.hpp).
#pragma once

#include "estimation/actuator_step.hpp"

namespace sms {
namespace estimation {

template <typename S>
class BenchRates {
 public:
  BenchRates(const Params<S>& p, const ActuatorLaws& laws)
      : bench_{p, laws},
        partly_warm_(detail::is_partly_warm(p, laws)),
        warm_{partly_warm_ ? detail::partly_warm(p) : p, laws} {}

  const Bench<S>& bench() const { return bench_; }
  const Params<S>& params() const { return bench_.params; }
  const ActuatorLaws& laws() const { return bench_.laws; }
  // Whether temperatures are states.
  bool is_warm() const { return partly_warm_ || bench_.laws.chamber == ChamberLaw::energy; }

  // film: speed of the lubricant's film, the piston's own where it is not late.
  sms_status operator()(const BenchState<S>& y, const S& command, const S& film, BenchTerms<S>& t,
                        BenchState<S>& rate) const {
    const Params<S>& p = bench_.params;
    const BenchInput<S> input{command, S(0)};
    sms_status status;
    if (partly_warm_) {
      BenchState<S> seen = y;
      seen.actuator = detail::partly_warm(p, y.actuator);
      status = derivative(warm_, seen, input, t, rate);
      detail::add_heat(p, y.actuator.lower, t.actuator.lower, t.actuator.flow.lower, rate.actuator.lower);
      detail::add_heat(p, y.actuator.upper, t.actuator.upper, t.actuator.flow.upper, rate.actuator.upper);
    } else {
      status = derivative(bench_, y, input, t, rate);
    }
    rate.velocity -= detail::seal_deviation(p, t.actuator.piston, t.balance.friction, y.actuator.deflection, film,
                                            &rate.actuator.deflection) /
                     p.moving_mass;
    return status;
  }

 private:
  Bench<S> bench_;
  bool partly_warm_;
  Bench<S> warm_;  // the flows see
};

}  // namespace estimation
}  // namespace sms
